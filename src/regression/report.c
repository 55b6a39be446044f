/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "regression/report.h"

#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "regression/internal.h"
#include "regression/regression.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* results.json is last: if it exists, the report is complete. */
static const struct {
    const char *name;
    void (*write)(FILE *file, const void *report);
} parts[] = {{"report.html", report_write_page},
             {"junit.xml", report_write_junit},
             {"results.tap", report_write_tap},
             {"results.json", report_write_json}};

bool regression_report_write(Regression *regression, const char *folder, size_t max_bytes, const Progress *progress,
                             Error *error) {
    ReportPictures pictures;
    ReportRuns runs = {0};
    char path[PATH_MAX];
    if (!file_make_directory(folder, error) ||
        !report_pictures_gather(&pictures, regression, max_bytes, progress, error))
        return false;
    const Report report = {regression, &pictures, &runs, folder};
    bool ok = report_runs_write(&runs, regression, folder, max_bytes, progress, error);
    for (size_t i = 0; ok && i < sizeof parts / sizeof parts[0]; i++) {
        ok = file_path(path, sizeof path, error, "%s/%s", folder, parts[i].name) &&
             file_write_text(path, parts[i].write, &report, error);
    }
    report_runs_free(&runs);
    report_pictures_free(&pictures);
    return ok;
}

int regression_case_count(const Regression *regression) { return regression->count + regression->run_count; }

static RegressionCase frame_case(const RegressionFrame *frame) {
    RegressionCase made = {.kind = "frames",
                           .name = frame_name(frame),
                           .verdict = frame_verdict(frame),
                           .failed = frame_failed(frame),
                           .words = frame_words(frame),
                           .seconds = frame->seconds,
                           .frame = frame};
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (frame->at[side] != NULL && !file_path(made.paths[side], PATH_MAX, &(Error){0}, "%s", frame->at[side]->path))
            made.paths[side][0] = '\0';
    return made;
}

RegressionCase regression_case(const Regression *regression, int i) {
    if (i < regression->count) return frame_case(&regression->frames[i]);
    const RegressionRun *run = &regression->runs[i - regression->count];
    RegressionCase made = {.kind = "trajectories",
                           .name = run->name,
                           .verdict = run->difference.equal ? "equal" : "physics changed",
                           .failed = !run->difference.equal,
                           .words = run_words(run),
                           .seconds = run->seconds};
    for (RegressionSide side = EXPECTED; side < SIDES; side++)
        if (!file_path(made.paths[side], PATH_MAX, &(Error){0}, "%s/%s", regression->sequences[side]->folder,
                       run->name))
            made.paths[side][0] = '\0';
    return made;
}

/* The step summary of GitHub Actions. */

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

static void write_row(FILE *out, const RegressionCase *made) {
    fputs("| ", out);
    put_code(out, made->name);
    fputs(" | ", out);
    put_text(out, made->verdict);
    fputs(" | ", out);
    put_text(out, made->words.text);
    write_figures(out, made->frame);
}

/* The length of a row, to know whether it fits before it is written. */
static size_t row_length(const RegressionCase *made) {
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
        const RegressionCase made = regression_case(regression, i);
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
