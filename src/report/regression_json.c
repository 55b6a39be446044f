/* SPDX-License-Identifier: GPL-3.0-or-later */
/* results.json; also embedded in report.html for its script. */
#include "common/json_write.h"
#include "report/regression_parts.h"
#include "report/regression_report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void write_file(JsonWriter *json, const char *key, const char *name, const RegressionFile *data) {
    if (name == NULL) {
        json_put_text(json, key, NULL);
        return;
    }
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

static void write_box(JsonWriter *json, const ImageDifference *difference) {
    if (difference->pixels == 0) {
        json_put_text(json, "box", NULL);
        return;
    }
    write_sides(json, difference->left, difference->top, difference->right, difference->bottom);
}

/* Four digits: the last bits of pow() depend on the machine. */
static double rounded(double flip) {
    char text[32];
    snprintf(text, sizeof text, "%.4g", flip);
    return isfinite(flip) ? strtod(text, NULL) : NAN;
}

/* At most IMAGE_REGIONS_MAX; a frame must stay one line below the limit of json_read.h. */
static void write_regions(JsonWriter *json, const RegressionFrame *frame) {
    const FrameChanges *changes = frame->changes;
    json_put_int(json, "region_count", changes == NULL ? 0 : changes->regions.count);
    json_begin_array(json, "regions", JSON_ONE_LINE);
    for (int i = 0; changes != NULL && i < changes->regions.kept; i++) {
        const ImageRegion *region = &changes->regions.list[i];
        ChangeText name = region_name(changes, i);
        json_begin_object(json, NULL, JSON_ONE_LINE);
        write_sides(json, region->left, region->top, region->right, region->bottom);
        json_put_int(json, "pixels", region->pixels);
        json_put_text(json, "name", name.text[0] != '\0' ? name.text : NULL);
        json_end(json);
    }
    json_end(json);
}

static void write_frame(JsonWriter *json, const RegressionFrame *frame) {
    const char *names[SIDES];
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        names[side] = frame->at[side] != NULL ? frame->at[side]->name : NULL;
    json_begin_object(json, NULL, JSON_ONE_LINE);
    json_put_text(json, "name", frame_name(frame));
    json_put_text(json, "verdict", frame_verdict(frame));
    json_put_bool(json, "failed", frame_failed(frame));
    json_put_bool(json, "shown", frame->shown);
    json_put_text(json, "words", frame_words(frame).text);
    json_put_int(json, "differing", frame->difference.pixels);
    json_put_int(json, "beyond", frame->difference.beyond);
    json_put_int(json, "edges", frame->difference.moved);
    json_put_int(json, "counted", frame->difference.counted);
    json_put_int(json, "largest", frame->difference.largest);
    write_box(json, &frame->difference);
    write_regions(json, frame);
    json_put_number(json, "flip", rounded(frame->flip));
    json_put_number(json, "flip_p99", rounded(frame->flip_p99));
    json_put_text(json, "metadata", frame->metadata.text[0] != '\0' ? frame->metadata.text : NULL);
    write_file(json, "expected", names[EXPECTED], &frame->files[EXPECTED]);
    write_file(json, "actual", names[ACTUAL], &frame->files[ACTUAL]);
    json_end(json);
}

static void write_run(JsonWriter *json, const RegressionRun *run) {
    json_begin_object(json, NULL, JSON_ONE_LINE);
    json_put_text(json, "name", run->name);
    json_put_text(json, "verdict", run->difference.equal ? "equal" : "physics changed");
    json_put_bool(json, "failed", !run->difference.equal);
    json_put_bool(json, "shown", true);
    json_put_text(json, "words", run_words(run).text);
    write_file(json, "expected", run->name, &run->files[EXPECTED]);
    write_file(json, "actual", run->name, &run->files[ACTUAL]);
    json_end(json);
}

static void write_limits(JsonWriter *json, const Regression *regression) {
    json_put_text(json, "tolerance", tolerance_words(&regression->options.tolerance).text);
    json_put_text(json, "rules", regression->rules == NULL ? NULL : rules_path(regression->rules));
}

static void write_counts(JsonWriter *json, const Regression *regression) {
    static const char *const keys[] = {
        [PIXELS_EQUAL] = "equal",     [PIXELS_WITHIN] = "within_tolerance", [PIXELS_DIFFER] = "different",
        [PIXELS_RESIZED] = "resized", [PIXELS_MISSING] = "missing",         [PIXELS_EXTRA] = "extra"};
    json_begin_object(json, "counts", JSON_ONE_LINE);
    json_put_int(json, "frames", regression->count);
    for (int i = 0; i <= PIXELS_EXTRA; i++) json_put_int(json, keys[i], regression->by_verdict[i]);
    json_put_int(json, "trajectories", regression->run_count);
    json_put_int(json, "trajectories_different", regression->run_failed);
    json_end(json);
}

void regression_write_json(JsonWriter *json, const Regression *regression) {
    json_put_text(json, "expected", regression->sequences[EXPECTED]->folder);
    json_put_text(json, "actual", regression->sequences[ACTUAL]->folder);
    json_put_bool(json, "passed", regression_passed(regression));
    json_put_text(json, "verdict", regression_verdict(regression).text);
    json_put_text(json, "notes", regression_notes(regression).text);
    write_counts(json, regression);
    write_limits(json, regression);
    json_put_int(json, "masks", regression->options.mask == NULL ? 0 : regression->options.mask->count);
    json_begin_array(json, "causes", JSON_LINES);
    for (int i = 0; i < regression->cause_count; i++)
        json_put_text(json, NULL, cause_words(&regression->causes[i]).text);
    json_end(json);
    json_begin_array(json, "frames", JSON_LINES);
    for (int i = 0; i < regression->count; i++) write_frame(json, &regression->frames[i]);
    json_end(json);
    json_begin_array(json, "trajectories", JSON_LINES);
    for (int i = 0; i < regression->run_count; i++) write_run(json, &regression->runs[i]);
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
