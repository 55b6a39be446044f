/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How twinbox compare compares one run, or a folder of runs, with many: each as two runs are compared, and all as one
   line, a table, JSON and a report. */
#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "base/machine.h"
#include "base/numbers.h"
#include "cli/json_output.h"
#include "cli/larger_commands.h"
#include "pictures/page.h"
#include "regression/report.h"
#include "runs/trajectory.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* A run of an input, compared with the expected one. */
typedef struct Row {
    int input; /* of the command line, from 1 */
    char *paths[SIDES];
    ReportCase judged; /* its texts but the words are of the program, or of `paths` */
    PartedBody parted; /* what fails; frame -1: nothing, or no frame */
    char cause[200];   /* "roundings: at most 1 unit in the last place", */
    const char *known; /* and ", first in the solver" if that is known, else "" */
} Row;

typedef struct Many {
    const CompareOptions *options;
    int count, inputs_equal;
    size_t capacity;
    Row *rows;
    int first; /* the row that parts first; -1: none */
    RegressionText summary;
    Error refused; /* why the first that cannot be compared cannot */
    ReportLink link;
    double seconds;
} Many;

static bool is_run_file(const char *name) { return file_name_ends_with(name, ".npz") || is_trace(name); }

static bool is_folder(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

static bool add_row(Many *many, int input, const char *expected, const char *actual, Error *error) {
    void *rows = many->rows;
    if (!array_reserve(&rows, &many->capacity, (size_t)many->count + 1, sizeof *many->rows))
        return error_memory(error, "compare");
    many->rows = rows;
    Row *row = &many->rows[many->count++];
    *row = (Row){.input = input, .parted = {.frame = -1, .body = -1}};
    return ((row->paths[EXPECTED] = strdup(expected)) != NULL && (row->paths[ACTUAL] = strdup(actual)) != NULL) ||
           error_memory(error, "compare");
}

static bool list_has(const FolderList *list, const char *name) {
    for (size_t i = 0; i < list->count; i++)
        if (strcmp(list->names[i], name) == 0) return true;
    return false;
}

/* Of two folders: the runs of both, by name. */
static bool list_rows(Many *many, int input, Error *error) {
    const char *expected = many->options->paths[0], *actual = many->options->paths[input];
    char paths[SIDES][PATH_MAX];
    for (int i = 0; i <= input; i += input)
        if (!is_folder(many->options->paths[i]) && !is_run_file(many->options->paths[i]))
            return error_input(
                error, many->options->paths[i],
                "of three inputs or more, each is a run (.npz or .csv) or a folder of runs; only 2 can be "
                "pictures");
    if (!is_folder(expected) && !is_folder(actual)) return add_row(many, input, expected, actual, error);
    FolderList lists[SIDES] = {{0}};
    bool ok = folder_list(&lists[EXPECTED], expected, is_run_file, true, error) &&
              folder_list(&lists[ACTUAL], actual, is_run_file, true, error);
    if (ok && lists[EXPECTED].count == 0) ok = error_input(error, expected, "has no runs (.npz or .csv)");
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        for (size_t i = 0; ok && i < lists[side].count; i++) {
            const char *name = lists[side].names[i];
            const bool both = list_has(&lists[1 - side], name);
            if (side == ACTUAL && both) continue;
            ok = file_path(paths[EXPECTED], PATH_MAX, error, "%s/%s", expected, name) &&
                 file_path(paths[ACTUAL], PATH_MAX, error, "%s/%s", actual, name) &&
                 add_row(many, input, paths[EXPECTED], paths[ACTUAL], error);
            if (ok && !both)
                many->rows[many->count - 1].judged =
                    (ReportCase){.verdict = side == EXPECTED ? "missing" : "extra", .failed = true};
        }
    for (RegressionSide side = EXPECTED; side < SIDES; side++) folder_list_free(&lists[side]);
    return ok;
}

static bool compare_row(const Many *many, const Row *row, CompareOptions *options, RunComparison *c, Error *error) {
    *options = *many->options;
    for (RegressionSide side = EXPECTED; side < SIDES; side++) options->paths[side] = row->paths[side];
    *c = (RunComparison){.options = options};
    return compare_runs_make(c, error);
}

/* False with error set if memory or the system fails. A file that is missing or damaged is a row that fails. */
static bool judge(Many *many, Row *row, Error *error) {
    const bool alone = row->judged.verdict != NULL; /* of one folder only */
    RunComparison c;
    CompareOptions options;
    Error why = {0};
    const bool made = !alone && compare_row(many, row, &options, &c, &why);
    if (made) {
        row->judged = compare_runs_case(&c, 0);
        row->parted = c.parting.beyond;
        if (row->parted.frame >= 0) row->known = compare_runs_cause(&c, row->cause, sizeof row->cause);
    } else if (!alone)
        row->judged = (ReportCase){.verdict = "not comparable", .failed = true};
    row->judged.kind = "trajectories";
    row->judged.name = row->paths[ACTUAL];
    for (RegressionSide side = EXPECTED; side < SIDES; side++) row->judged.paths[side] = row->paths[side];
    if (!alone) compare_runs_free(&c);
    if (made || alone) return true;
    text_add(row->judged.words.text, sizeof row->judged.words.text, "%s", why.message);
    if (why.kind != ERROR_INPUT) return *error = why, false;
    if (many->refused.kind == ERROR_NONE) many->refused = why;
    return true;
}

/* "15 of 17 equal; arm32.npz parts in frame 138 at body 1 (roundings), first in the solver; wasm.csv in ..." */
static void summarise(Many *many) {
    const int inputs = many->options->count - 1;
    char parts[sizeof many->summary.text] = "";
    many->first = -1;
    bool equal = true;
    for (int input = 1; input <= inputs; input++) {
        const Row *first = NULL;
        for (int i = 0; i < many->count; i++) {
            Row *row = &many->rows[i];
            if (row->input != input) continue;
            equal = equal && strcmp(row->judged.verdict, "within tolerance") != 0;
            if (!row->judged.failed) continue;
            if (row->parted.frame >= 0 && (many->first < 0 || row->parted.frame < many->rows[many->first].parted.frame))
                many->first = i;
            if (first == NULL || (unsigned)row->parted.frame < (unsigned)first->parted.frame) first = row;
        }
        many->inputs_equal += first == NULL;
        if (first == NULL) continue;
        if (first->parted.frame >= 0)
            text_add(parts, sizeof parts, "; %s %sin frame %d at body %d (%.*s)%s", first->paths[ACTUAL],
                     strstr(parts, " parts ") == NULL ? "parts " : "", first->parted.frame, first->parted.body,
                     (int)strcspn(first->cause, ":"), first->cause, first->known);
        else
            text_add(parts, sizeof parts, "; %s: %s", first->paths[ACTUAL],
                     first->judged.words.text[0] != '\0' ? first->judged.words.text : first->judged.verdict);
    }
    text_add(many->summary.text, sizeof many->summary.text, "%d of %d %s%s", many->inputs_equal, inputs,
             equal ? "equal" : "pass", parts);
}

static void print_table(const Many *many) {
    int width = 0;
    for (int i = 0; i < many->count; i++) width = int_max(width, (int)strlen(many->rows[i].paths[ACTUAL]));
    for (int i = 0; i < many->count; i++) {
        const Row *row = &many->rows[i];
        printf("%-*s  %-16s", width, row->paths[ACTUAL], row->judged.verdict);
        if (row->parted.frame >= 0)
            printf("  frame %d, body %d: %s%s", row->parted.frame, row->parted.body, row->cause, row->known);
        else if (row->judged.failed)
            printf("  %s", row->judged.words.text);
        printf("\n");
    }
    printf("%s\n", many->summary.text);
}

static void write_json(JsonWriter *json, const void *context) {
    const Many *many = context;
    json_put_text(json, "expected", many->options->paths[0]);
    json_put_int(json, "inputs", many->options->count - 1);
    json_put_int(json, "passed", many->inputs_equal);
    json_put_text(json, "words", many->summary.text);
    json_begin_array(json, "runs", JSON_LINES);
    for (int i = 0; i < many->count; i++) {
        const Row *row = &many->rows[i];
        json_begin_object(json, NULL, JSON_ONE_LINE);
        json_put_text(json, "input", many->options->paths[row->input]);
        json_put_text(json, "path", row->paths[ACTUAL]);
        json_put_bool(json, "passed", !row->judged.failed);
        json_put_text(json, "verdict", row->judged.verdict);
        if (!json_put_absent(json, "frame", row->parted.frame < 0)) json_put_int(json, "frame", row->parted.frame);
        if (!json_put_absent(json, "body", row->parted.body < 0)) json_put_int(json, "body", row->parted.body);
        json_put_text(json, "words", row->judged.words.text);
        json_end(json);
    }
    json_end(json);
}

/* The report. */

static ReportCase case_at(const void *context, int i) { return ((const Many *)context)->rows[i].judged; }

static void write_results(FILE *out, const void *context) {
    json_output_print(out, &(JsonOutput){"twinbox compare many 1", write_json, context});
}

static void write_page(FILE *out, const void *context) {
    const Many *many = context;
    house_page_begin(out, "Comparison of many runs", "");
    html_print(out, "<main>\n<h1>Comparison with %s</h1>\n<p>%s</p>\n", many->options->paths[0], many->summary.text);
    if (many->link.text[0] != '\0')
        html_print(out, "<p><a href=\"%s\">%s beside it, at the first difference</a></p>\n", many->link.text,
                   many->rows[many->first].paths[ACTUAL]);
    fputs("<table>\n<tr><th>run</th><th>verdict</th><th>where</th></tr>\n", out);
    for (int i = 0; i < many->count; i++)
        html_print(out, "<tr><td>%s</td><td>%s</td><td>%s</td></tr>\n", many->rows[i].paths[ACTUAL],
                   many->rows[i].judged.verdict, many->rows[i].judged.words.text);
    fputs("</table>\n</main>\n", out);
    house_page_end(out);
}

/* The page plays the pair that parts first. */
static bool write_report(Many *many, Error *error) {
    const char *folder = many->options->report;
    const Row *first = many->first >= 0 ? &many->rows[many->first] : NULL;
    int failed = 0;
    for (int i = 0; i < many->count; i++) failed += many->rows[i].judged.failed;
    bool ok = true;
    if (first != NULL) {
        CompareOptions options;
        RunComparison c;
        ok = compare_row(many, first, &options, &c, error) && compare_runs_page(&c, folder, error);
        many->link = c.link;
        compare_runs_free(&c);
    }
    const ReportResults results = {.comparison = many,
                                   .count = many->count,
                                   .failed = failed,
                                   .notes = many->summary.text,
                                   .seconds = many->seconds,
                                   .at = case_at,
                                   .write_page = write_page,
                                   .write_json = write_results};
    return ok && report_write(&results, folder, error);
}

bool compare_many(const CompareOptions *options, Error *error) {
    Many many = {.options = options};
    const double begun = clock_seconds();
    bool ok = true;
    for (int input = 1; ok && input < options->count; input++) ok = list_rows(&many, input, error);
    for (int i = 0; ok && i < many.count; i++) ok = judge(&many, &many.rows[i], error);
    many.seconds = clock_seconds() - begun;
    if (ok) summarise(&many);
    ok = ok && (options->report == NULL || write_report(&many, error));
    if (ok && !options->json) print_table(&many);
    if (ok && !options->json && options->report != NULL) printf("report -> %s/report.html\n", options->report);
    ok = ok && (!options->json || json_output("twinbox compare many 1", write_json, &many, error));
    for (int i = 0; i < many.count; i++)
        for (RegressionSide side = EXPECTED; side < SIDES; side++) free(many.rows[i].paths[side]);
    free(many.rows);
    if (ok && many.refused.kind != ERROR_NONE) return *error = many.refused, false;
    return ok && many.inputs_equal == options->count - 1;
}
