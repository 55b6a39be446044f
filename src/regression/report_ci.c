/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The results of a comparison for other programs: annotations and summary of GitHub Actions, junit.xml, results.tap,
   results.json. */
#include "base/file.h"
#include "base/json.h"
#include "pictures/page.h"
#include "regression/compare.h"
#include "regression/regression_internal.h"
#include "regression/naming.h"
#include "regression/regression.h"
#include "regression/report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static int regression_case_count(const Regression *regression) { return regression->count + regression->run_count; }

/* The frames, then the trajectories. */
static ReportCase regression_case(const Regression *regression, int i) {
    const bool framed = i < regression->count;
    const RegressionFrame *frame = framed ? &regression->frames[i] : NULL;
    const RegressionRun *run = framed ? NULL : &regression->runs[i - regression->count];
    ReportCase made = {.kind = framed ? "frames" : "trajectories",
                       .name = framed ? frame_name(frame) : run->name,
                       .verdict = framed ? frame_verdict(frame) : run_verdict(run),
                       .failed = framed ? frame_failed(frame) : run_failed(run),
                       .words = !framed        ? run_words(run)
                                : frame->alone ? case_words(frame)
                                               : frame_words(frame),
                       .seconds = framed ? frame->seconds : run->seconds,
                       .frame = frame};
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (framed)
            made.paths[side] = frame->at[side] != NULL ? frame->at[side]->path : NULL;
        else
            made.paths[side] = run->alone[1 - side] ? NULL : run->paths[side];
    return made;
}

ReportCase report_case(const void *report, int i) { return regression_case(((const Report *)report)->regression, i); }

static const char *path_of(const ReportCase *made) {
    return made->paths[made->paths[EXPECTED] != NULL ? EXPECTED : ACTUAL];
}

/* In a property, ':' and ',' end the value; in both, a line break ends the command. */
static void put_escaped(FILE *out, const char *text, const char *special) {
    for (; *text != '\0'; text++) {
        if ((unsigned char)*text < ' ' || *text == '%' || strchr(special, *text) != NULL)
            fprintf(out, "%%%02X", (unsigned)(unsigned char)*text);
        else
            fputc(*text, out);
    }
}

static void put_property(FILE *out, const char *text) { put_escaped(out, text, ":,"); }
static void put_message(FILE *out, const char *text) { put_escaped(out, text, ""); }

void github_annotate_message(FILE *out, const char *message) {
    fputs("::error title=twinbox compare::", out);
    put_message(out, message);
    fputc('\n', out);
}

/* Whether two neighbours of the list belong to one annotation: frames of one sequence that failed alike. */
static bool is_same_failure(const Regression *regression, int i, int next) {
    if (next >= regression->count) return false;
    const RegressionFrame *a = &regression->frames[i], *b = &regression->frames[next];
    const SequenceFrame *x = a->base, *y = b->base;
    return frame_failed(a) && frame_failed(b) && x->number >= 0 && y->number >= 0 &&
           sequence_compare_stems(x, y) == 0 && strcmp(frame_verdict(a), frame_verdict(b)) == 0;
}

typedef struct Failures {
    int begin, end; /* cases; end is exclusive */
} Failures;

static void report_ci_annotate(FILE *out, const Regression *regression, Failures failures) {
    const ReportCase made = regression_case(regression, failures.begin);
    fputs("::error file=", out);
    put_property(out, path_of(&made));
    fputs(",title=", out);
    put_property(out, made.verdict);
    fputs("::", out);
    put_message(out, made.name);
    if (failures.end - failures.begin > 1) {
        fputs(" to ", out);
        put_message(out, frame_name(&regression->frames[failures.end - 1]));
        fprintf(out, ", %d frames; the first", failures.end - failures.begin);
    }
    fputs(": ", out);
    put_message(out, made.words.text);
    fputc('\n', out);
}

void github_annotate(FILE *out, const Regression *regression) {
    Failures found[GITHUB_ANNOTATIONS_MAX];
    const int count = regression_case_count(regression);
    int groups = 0, left_out = 0;
    for (int k = 0; k < count; k++) {
        int begin = (k + regression->count) % count, end = begin + 1; /* trajectories first: they are the cause */
        if (!regression_case(regression, begin).failed) continue;
        while (is_same_failure(regression, end - 1, end)) end++;
        if (groups < GITHUB_ANNOTATIONS_MAX)
            found[groups] = (Failures){begin, end};
        else
            left_out += end - begin;
        groups++;
        k += end - begin - 1;
    }
    if (groups > GITHUB_ANNOTATIONS_MAX) {
        groups = GITHUB_ANNOTATIONS_MAX - 1;
        left_out += found[groups].end - found[groups].begin;
    }
    for (int i = 0; i < groups; i++) report_ci_annotate(out, regression, found[i]);
    if (left_out == 0) return;
    char message[128];
    snprintf(message, sizeof message, "%d more failures; the step summary and the report list them", left_out);
    github_annotate_message(out, message);
}

/* The step summary of GitHub Actions, in Markdown. */

/* More rows would not be read, and GitHub would take seconds to show them. */
enum { MAX_ROWS = 1000, LAST_LINE = 128 };

typedef struct Summary {
    const Regression *regression;
    long limit; /* bytes */
} Summary;

/* Text in a paragraph or a cell: all that Markdown may read as markup has a backslash. */
static void put_text(FILE *out, const char *text) {
    for (; *text != '\0'; text++) {
        if (strchr("\\`*_[]<>!|~&$#@:", *text) != NULL) fputc('\\', out);
        fputc((unsigned char)*text < ' ' ? ' ' : *text, out);
    }
}

static size_t longest_run(const char *text, char of) {
    size_t longest = 0;
    for (size_t run; *text != '\0'; text += run > 0 ? run : 1) {
        run = strspn(text, (const char[]){of, '\0'});
        if (run > longest) longest = run;
    }
    return longest;
}

/* A code span, in which only more backticks than any in the text end it. '|' would end a cell. */
static void put_code(FILE *out, const char *text) {
    size_t fence = longest_run(text, '`') + 1;
    for (size_t i = 0; i < fence; i++) fputc('`', out);
    fputc(' ', out);
    for (; *text != '\0'; text++) {
        if (*text == '|') fputc('\\', out);
        fputc((unsigned char)*text < ' ' ? ' ' : *text, out);
    }
    fputc(' ', out);
    for (size_t i = 0; i < fence; i++) fputc('`', out);
}

/* Each line is an item of a list. */
static void write_items(FILE *out, const char *lines) {
    char item[sizeof((RegressionText *)NULL)->text];
    for (size_t length; *lines != '\0'; lines += length + (lines[length] == '\n')) {
        length = strcspn(lines, "\n");
        snprintf(item, sizeof item, "%.*s", (int)length, lines);
        fputs("- ", out);
        put_text(out, item);
        fputc('\n', out);
    }
}

static void write_head(FILE *out, const Regression *regression) {
    fputs("### twinbox compare: ", out);
    put_text(out, regression_verdict(regression).text);
    fputs("\n\nExpected ", out);
    put_code(out, regression->sequences[EXPECTED]->folder);
    fputs(", actual ", out);
    put_code(out, regression->sequences[ACTUAL]->folder);
    fprintf(out, ": %d of %d frames failed.\n\n", regression->failed, regression->count);
    write_items(out, regression_begin(regression).text);
    for (int i = 0; i < regression->cause_count; i++) write_items(out, cause_words(&regression->causes[i]).text);
    write_items(out, regression_notes(regression).text);
    fputc('\n', out);
}

static void write_figures(FILE *out, const RegressionFrame *frame) {
    bool measured = frame != NULL && frame->pixels <= PIXELS_DIFFER;
    if (measured && isfinite(frame->flip))
        fprintf(out, " | %.4g", frame->flip);
    else
        fputs(" |", out);
    if (measured)
        fprintf(out, " | %d |\n", frame->difference.largest);
    else
        fputs(" | |\n", out);
}

static void write_row(FILE *out, const ReportCase *made) {
    fputs("| ", out);
    put_code(out, made->name);
    fputs(" | ", out);
    put_text(out, made->verdict);
    fputs(" | ", out);
    put_text(out, made->words.text);
    write_figures(out, made->frame);
}

/* The length of a row, to know whether it fits before it is written. */
static size_t row_length(const ReportCase *made) {
    return 16 + 4 * strlen(made->name) + 2 * (strlen(made->verdict) + strlen(made->words.text)) + 64;
}

static void write_summary(FILE *out, const void *context) {
    const Summary *summary = context;
    const Regression *regression = summary->regression;
    const int failures = regression->failed + regression->run_failed, count = regression_case_count(regression);
    int rows = 0;
    write_head(out, regression);
    if (failures > 0) fputs("| name | verdict | difference | FLIP | largest |\n|---|---|---|---:|---:|\n", out);
    for (int i = 0; i < count && rows < MAX_ROWS; i++) {
        const ReportCase made = regression_case(regression, i);
        if (!made.failed) continue;
        if (ftell(out) + (long)row_length(&made) + LAST_LINE > summary->limit) break;
        write_row(out, &made);
        rows++;
    }
    if (rows < failures) fprintf(out, "\n%d more failures are in the report.\n", failures - rows);
    fputc('\n', out);
}

bool github_summary_append(const Regression *regression, const char *path, Error *error) {
    struct stat status;
    off_t used = stat(path, &status) == 0 ? status.st_size : 0;
    if (used >= GITHUB_SUMMARY_MAX) return true;
    const Summary summary = {regression, (long)(GITHUB_SUMMARY_MAX - 1 - used)};
    size_t size;
    char *text = file_print(write_summary, &summary, &size);
    if (text == NULL) return error_memory(error, path);
    bool ok = (long)size > summary.limit || file_append(path, text, size, error);
    free(text);
    return ok;
}

/* junit.xml for CI systems: a test case per frame and trajectory, with the time of its comparison. The times make it
   the one file of a report that differs from run to run. html_put() also escapes for XML. */

static void write_attribute(FILE *file, const char *key, const char *value) {
    fprintf(file, " %s=\"", key);
    html_put(file, value);
    fputc('"', file);
}

/* The form in which GitLab and Jenkins link files; "]]" would end it. */
static void write_attachment(FILE *file, const char *path) {
    if (path == NULL || strstr(path, "]]") != NULL) return;
    fputs("[[ATTACHMENT|", file);
    html_put(file, path);
    fputs("]]\n", file);
}

static void write_words_of_regions(FILE *file, const RegressionFrame *frame) {
    const FrameChanges *changes = frame != NULL ? frame->changes : NULL;
    for (int i = 0; changes != NULL && i < changes->regions.kept; i++) {
        html_put(file, region_words(changes, i).text);
        fputc('\n', file);
    }
}

static void write_failure(FILE *file, const ReportCase *made) {
    static const char *const titles[SIDES] = {"expected: ", "actual: "};
    char message[sizeof made->words.text + 64];
    snprintf(message, sizeof message, "%s: %s", made->verdict, made->words.text);
    fputs("    <failure", file);
    write_attribute(file, "type", made->verdict);
    write_attribute(file, "message", message);
    fputc('>', file);
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        if (made->paths[side] == NULL) continue;
        fputs(titles[side], file);
        html_put(file, made->paths[side]);
        fputc('\n', file);
    }
    write_words_of_regions(file, made->frame);
    fputs("</failure>\n    <system-out>", file);
    write_attachment(file, made->paths[ACTUAL]); /* the first one is what GitLab shows */
    write_attachment(file, made->paths[EXPECTED]);
    fputs("</system-out>\n", file);
}

static void write_case(FILE *file, const ReportCase *made) {
    fprintf(file, "  <testcase classname=\"%s\"", made->kind);
    write_attribute(file, "name", made->name);
    write_attribute(file, "file", path_of(made));
    fprintf(file, " time=\"%.6f\"", made->seconds);
    if (!made->failed) {
        fputs("/>\n", file);
        return;
    }
    fputs(">\n", file);
    write_failure(file, made);
    fputs("  </testcase>\n", file);
}

static void write_junit(FILE *file, const void *context) {
    const ReportResults *results = context;
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n", file);
    fprintf(file,
            "<testsuite name=\"twinbox compare\" tests=\"%d\" failures=\"%d\" errors=\"0\" skipped=\"0\" "
            "time=\"%.6f\">\n",
            results->count, results->failed, results->seconds);
    for (int i = 0; i < results->count; i++) {
        const ReportCase made = results->at(results->comparison, i);
        write_case(file, &made);
    }
    if (results->notes[0] != '\0') {
        fputs("  <system-out>", file);
        html_put(file, results->notes);
        fputs("</system-out>\n", file);
    }
    fputs("</testsuite>\n", file);
}

/* results.tap, in version 14 of the Test Anything Protocol (testanything.org): a test per frame and trajectory. What
   follows a failure is YAML; JSON is YAML, and keeps any name in its quotes. */

/* '#' would begin a directive: "# TODO" turns a failure into a success. */
static void put_description(FILE *file, const char *text) {
    for (; *text != '\0'; text++) {
        if (*text == '#' || *text == '\\') fputc('\\', file);
        fputc((unsigned char)*text < ' ' ? ' ' : *text, file);
    }
}

static void write_details(FILE *file, const ReportCase *made) {
    JsonWriter json = {.out = file};
    fputs("  ---\n  ", file);
    json_begin_object(&json, NULL, JSON_ONE_LINE);
    json_put_text(&json, "verdict", made->verdict);
    json_put_text(&json, "words", made->words.text);
    json_put_text(&json, "expected", made->paths[EXPECTED]);
    json_put_text(&json, "actual", made->paths[ACTUAL]);
    json_end(&json);
    fputs("  ...\n", file);
}

/* A comment for each line. */
static void write_notes(FILE *file, const char *notes) {
    for (size_t length; *notes != '\0'; notes += length + (notes[length] == '\n')) {
        length = strcspn(notes, "\n");
        fputs("# ", file);
        fwrite(notes, 1, length, file);
        fputc('\n', file);
    }
}

static void write_tap(FILE *file, const void *context) {
    const ReportResults *results = context;
    fprintf(file, "TAP version 14\n1..%d\n", results->count);
    write_notes(file, results->notes);
    for (int i = 0; i < results->count; i++) {
        const ReportCase made = results->at(results->comparison, i);
        fprintf(file, "%s %d - ", made.failed ? "not ok" : "ok", i + 1);
        put_description(file, made.name);
        if (made.failed) {
            fputs(": ", file);
            put_description(file, made.verdict);
        }
        fputc('\n', file);
        if (made.failed) write_details(file, &made);
    }
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

/* Four digits: the last bits of pow() depend on the machine. */
static double rounded(double flip) {
    char text[32];
    snprintf(text, sizeof text, "%.4g", flip);
    return isfinite(flip) ? strtod(text, NULL) : NAN;
}

/* Of a region that has a name. */
static void write_change(JsonWriter *json, const FrameChanges *changes, int region) {
    static const char *const kinds[] = {
        [CHANGE_OTHER] = "other",    [CHANGE_MOVED] = "moved",         [CHANGE_COLOUR] = "recoloured",
        [CHANGE_APPEARED] = "added", [CHANGE_DISAPPEARED] = "removed", [CHANGE_REPLACED] = "replaced",
        [CHANGE_NOISE] = "noise",    [CHANGE_UNSURE] = "unsure"};
    if (changes->region_change[region] < 0) return;
    const Change *change = &changes->list[changes->region_change[region]];
    json_put_text(json, "kind", kinds[change->kind]);
    if (change->kind != CHANGE_MOVED) return;
    json_put_number(json, "right", rounded(change->right));
    json_put_number(json, "up", rounded(change->up));
}

/* At most IMAGE_REGIONS_MAX; a frame must stay one line below the limit of json_read_value(). */
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
        write_change(json, changes, i);
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
    json_put_text(json, "verdict", run_verdict(run));
    json_put_bool(json, "failed", run_failed(run));
    json_put_bool(json, "shown", true);
    json_put_text(json, "words", run_words(run).text);
    write_file(json, "expected", run->alone[ACTUAL] ? NULL : run->name, &run->files[EXPECTED]);
    write_file(json, "actual", run->alone[EXPECTED] ? NULL : run->name, &run->files[ACTUAL]);
    json_end(json);
}

static void write_limits(JsonWriter *json, const Regression *regression) {
    json_put_text(json, "tolerance", regression_limits(regression).text);
    json_put_text(json, "rules", regression->rules == NULL ? NULL : rules_path(regression->rules));
}

static void write_counts(JsonWriter *json, const Regression *regression) {
    static const char *const keys[] = {
        [PIXELS_EQUAL] = "equal",          [PIXELS_WITHIN] = "within_tolerance", [PIXELS_DIFFER] = "different",
        [PIXELS_RESIZED] = "resized",      [PIXELS_MISSING] = "missing",         [PIXELS_EXTRA] = "extra",
        [PIXELS_UNREAD] = "not_comparable"};
    json_begin_object(json, "counts", JSON_ONE_LINE);
    json_put_int(json, "frames", regression->count);
    for (int i = 0; i < PIXEL_VERDICTS; i++) json_put_int(json, keys[i], regression->by_verdict[i]);
    json_put_int(json, "trajectories", regression->run_count);
    json_put_int(json, "trajectories_within_tolerance", regression->run_within);
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
    json_put_bool(json, "film", regression->film);
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

bool report_write(const ReportResults *results, const char *folder, Error *error) {
    const struct {
        const char *name;
        void (*write)(FILE *file, const void *context);
        const void *context;
    } parts[] = {{"report.html", results->write_page, results->comparison},
                 {"junit.xml", write_junit, results},
                 {"results.tap", write_tap, results},
                 {"results.json", results->write_json, results->comparison}};
    char path[PATH_MAX];
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
        if (!file_path(path, sizeof path, error, "%s/%s", folder, parts[i].name) ||
            !file_write_text(path, parts[i].write, parts[i].context, error))
            return false;
    return true;
}
