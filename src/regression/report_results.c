/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The results of a comparison for other programs: junit.xml and results.json. */
#include "base/file.h"
#include "base/json.h"
#include "pictures/page.h"
#include "regression/naming.h"
#include "regression/regression.h"
#include "regression/regression_internal.h"
#include "regression/report.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The frames, then the trajectories. */
ReportCase report_case(const void *report, int i) {
    const Regression *regression = ((const Report *)report)->regression;
    ReportCase made = {.kind = "frames"};
    if (i < regression->count) {
        const RegressionFrame *frame = made.frame = &regression->frames[i];
        made.name = frame_name(frame);
        made.verdict = frame_verdict(frame);
        made.failed = frame_failed(frame);
        made.words = frame->alone ? case_words(frame) : frame_words(frame);
        made.seconds = frame->seconds;
        for (RegressionSide side = EXPECTED; side < SIDES; side++)
            made.paths[side] = frame->at[side] != NULL ? frame->at[side]->path : NULL;
    } else {
        const RegressionRun *run = &regression->runs[i - regression->count];
        made.kind = "trajectories";
        made.name = run->name;
        made.verdict = run_verdict(run);
        made.failed = run_failed(run);
        made.words = run_words(run);
        made.seconds = run->seconds;
        for (RegressionSide side = EXPECTED; side < SIDES; side++)
            made.paths[side] = run->alone[1 - side] ? NULL : run->paths[side];
    }
    return made;
}

/* junit.xml for CI systems: a test case per frame and trajectory, with the time of its comparison. The times make it
   the one file of a report that differs from run to run. html_put() also escapes for XML. */

static void write_junit(FILE *file, const void *context) {
    static const char *const titles[SIDES] = {"expected: ", "actual: "};
    const ReportResults *results = context;
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n", file);
    fprintf(file,
            "<testsuite name=\"twinbox compare\" tests=\"%d\" failures=\"%d\" errors=\"0\" skipped=\"0\" "
            "time=\"%.6f\">\n",
            results->count, results->failed, results->seconds);
    for (int k = 0; k < results->count; k++) {
        const ReportCase made = results->at(results->comparison, k);
        const FrameChanges *changes = made.frame != NULL ? made.frame->changes : NULL;
        html_print(file, "  <testcase classname=\"%s\" name=\"%s\" file=\"%s\"", made.kind, made.name,
                   made.paths[made.paths[EXPECTED] != NULL ? EXPECTED : ACTUAL]);
        fprintf(file, " time=\"%.6f\"%s\n", made.seconds, made.failed ? ">" : "/>");
        if (!made.failed) continue;
        html_print(file, "    <failure type=\"%s\" message=\"%s: %s\">", made.verdict, made.verdict, made.words.text);
        for (RegressionSide side = EXPECTED; side < SIDES; side++)
            if (made.paths[side] != NULL) html_print(file, "%s%s\n", titles[side], made.paths[side]);
        for (int i = 0; changes != NULL && i < changes->regions.kept; i++)
            html_print(file, "%s\n", region_words(changes, i).text);
        fputs("</failure>\n    <system-out>", file);
        for (int i = 0; i < SIDES; i++) { /* the first one, the actual picture, is what GitLab shows */
            const char *path = made.paths[i == 0 ? ACTUAL : EXPECTED];
            if (path != NULL && strstr(path, "]]") == NULL) /* which would end the form of GitLab and Jenkins */
                html_print(file, "[[ATTACHMENT|%s]]\n", path);
        }
        fputs("</system-out>\n  </testcase>\n", file);
    }
    if (results->notes[0] != '\0') html_print(file, "  <system-out>%s</system-out>\n", results->notes);
    fputs("</testsuite>\n", file);
}

/* results.json; also embedded in report.html for its script. */

static void write_file(JsonWriter *json, const char *key, const char *name, const RegressionFile *data) {
    if (json_put_absent(json, key, name == NULL)) return;
    json_begin_object(json, key, JSON_ONE_LINE);
    json_put_text(json, "name", name);
    json_put_int(json, "size", (int64_t)data->size);
    json_put_hash(json, "xxh3", data->hash);
    json_end(json);
}

static void write_sides(JsonWriter *json, int left, int top, int right, int bottom) {
    const int sides[] = {left, top, right, bottom};
    json_begin_array(json, "box", JSON_ONE_LINE);
    for (int i = 0; i < 4; i++) json_put_int(json, NULL, sides[i]);
    json_end(json);
}

/* At most IMAGE_REGIONS_MAX; a frame must stay one line below the limit of json_read_value(). */
static void write_regions(JsonWriter *json, const FrameChanges *changes) {
    json_put_int(json, "region_count", changes == NULL ? 0 : changes->regions.count);
    json_begin_array(json, "regions", JSON_ONE_LINE);
    for (int i = 0; changes != NULL && i < changes->regions.kept; i++) {
        const ImageRegion *region = &changes->regions.list[i];
        const ChangeText name = region_name(changes, i);
        json_begin_object(json, NULL, JSON_ONE_LINE);
        write_sides(json, region->left, region->top, region->right, region->bottom);
        json_put_int(json, "pixels", region->pixels);
        json_put_int(json, "largest", region->largest);
        json_put_text(json, "name", name.text[0] != '\0' ? name.text : NULL);
        json_end(json);
    }
    json_end(json);
}

static void write_frame(JsonWriter *json, const RegressionFrame *frame) {
    const char *names[SIDES];
    const ImageDifference *difference = &frame->difference;
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        names[side] = frame->at[side] != NULL ? frame->at[side]->name : NULL;
    json_begin_object(json, NULL, JSON_ONE_LINE);
    json_put_text(json, "name", frame_name(frame));
    json_put_text(json, "verdict", frame_verdict(frame));
    json_put_bool(json, "failed", frame_failed(frame));
    json_put_bool(json, "shown", frame->shown);
    json_put_number(json, "severity", frame_severity(frame));
    json_put_text(json, "words", frame_words(frame).text);
    json_put_int(json, "differing", difference->pixels);
    json_put_int(json, "beyond", difference->beyond);
    json_put_int(json, "edges", difference->moved);
    json_put_int(json, "counted", difference->counted);
    json_put_int(json, "largest", difference->largest);
    if (!json_put_absent(json, "box", difference->pixels == 0))
        write_sides(json, difference->left, difference->top, difference->right, difference->bottom);
    write_regions(json, frame->changes);
    json_put_text(json, "metadata", frame->metadata.text[0] != '\0' ? frame->metadata.text : NULL);
    write_file(json, "expected", names[EXPECTED], &frame->files[EXPECTED]);
    write_file(json, "actual", names[ACTUAL], &frame->files[ACTUAL]);
    json_end(json);
}

void regression_write_json(JsonWriter *json, const Regression *regression) {
    static const char *const counts[] = {
        [PIXELS_EQUAL] = "equal",          [PIXELS_WITHIN] = "within_tolerance", [PIXELS_DIFFER] = "different",
        [PIXELS_RESIZED] = "resized",      [PIXELS_MISSING] = "missing",         [PIXELS_EXTRA] = "extra",
        [PIXELS_UNREAD] = "not_comparable"};
    json_put_text(json, "expected", regression->sequences[EXPECTED]->folder);
    json_put_text(json, "actual", regression->sequences[ACTUAL]->folder);
    json_put_bool(json, "passed", regression_passed(regression));
    json_put_text(json, "verdict", regression_verdict(regression).text);
    json_put_text(json, "notes", regression_notes(regression).text);
    json_begin_object(json, "counts", JSON_ONE_LINE);
    json_put_int(json, "frames", regression->count);
    for (int i = 0; i < PIXEL_VERDICTS; i++) json_put_int(json, counts[i], regression->by_verdict[i]);
    json_put_int(json, "trajectories", regression->run_count);
    json_put_int(json, "trajectories_within_tolerance", regression->run_within);
    json_put_int(json, "trajectories_different", regression->run_failed - regression->runs_unread);
    json_put_int(json, "trajectories_not_comparable", regression->runs_unread);
    json_end(json);
    json_put_text(json, "tolerance", regression_limits(regression).text);
    json_put_text(json, "rules", regression->rules == NULL ? NULL : rules_path(regression->rules));
    json_put_int(json, "masks", regression->options.mask == NULL ? 0 : regression->options.mask->count);
    json_put_bool(json, "film", regression->film);
    json_begin_array(json, "causes", JSON_LINES);
    for (int i = 0; i < regression->cause_count; i++)
        json_put_text(json, NULL, cause_words(&regression->causes[i]).text);
    json_end(json);
    json_begin_array(json, "frames", JSON_LINES);
    for (int i = 0; i < regression->count; i++) write_frame(json, &regression->frames[i]);
    json_end(json);
    json_begin_array(json, "trajectories", JSON_LINES);
    for (int i = 0; i < regression->run_count; i++) {
        const RegressionRun *run = &regression->runs[i];
        json_begin_object(json, NULL, JSON_ONE_LINE);
        json_put_text(json, "name", run->name);
        json_put_text(json, "verdict", run_verdict(run));
        json_put_bool(json, "failed", run_failed(run));
        json_put_bool(json, "shown", run->read_error == NULL);
        json_put_text(json, "words", run_words(run).text);
        const RegressionText verdicts = run_verdicts(run);
        json_put_text(json, "verdicts", verdicts.text[0] != '\0' ? verdicts.text : NULL);
        write_file(json, "expected", run->alone[ACTUAL] ? NULL : run->name, &run->files[EXPECTED]);
        write_file(json, "actual", run->alone[EXPECTED] ? NULL : run->name, &run->files[ACTUAL]);
        json_end(json);
    }
    json_end(json);
}

void report_write_json(FILE *file, const void *context) {
    const Report *report = context;
    JsonWriter json = {.out = file};
    json_begin_object(&json, NULL, JSON_LINES);
    json_put_text(&json, "format", "twinbox compare 1");
    regression_write_json(&json, report->regression);
    json_end(&json);
}

/* The files of a report; the last is there if it is complete. */
static const char *const names[] = {"report.html", "junit.xml", "results.json"};
enum { FILES = sizeof names / sizeof *names };

bool report_begin(const char *folder, Error *error) {
    char path[PATH_MAX];
    if (!folder_reserve(folder, error)) return false;
    for (int i = FILES - 1; i >= 0; i--)
        if (!file_path(path, sizeof path, error, "%s/%s", folder, names[i]) || !file_remove(path, error)) return false;
    return true;
}

bool report_write(const ReportResults *results, const char *folder, Error *error) {
    const struct {
        void (*write)(FILE *file, const void *context);
        const void *context;
    } parts[FILES] = {
        {results->write_page, results->comparison}, {write_junit, results}, {results->write_json, results->comparison}};
    char path[PATH_MAX];
    for (int i = 0; i < FILES; i++)
        if (!file_path(path, sizeof path, error, "%s/%s", folder, names[i]) ||
            !file_write_text(path, parts[i].write, parts[i].context, error))
            return false;
    return true;
}
