/* SPDX-License-Identifier: GPL-3.0-or-later */
/* results.tap, in version 14 of the Test Anything Protocol (testanything.org): a test per frame and trajectory. What
   follows a failure is YAML; JSON is YAML, and keeps any name in its quotes. */
#include "common/json_write.h"
#include "report/regression_cases.h"
#include "report/regression_parts.h"

/* '#' would begin a directive: "# TODO" turns a failure into a success. */
static void put_description(FILE *file, const char *text) {
    for (; *text != '\0'; text++) {
        if (*text == '#' || *text == '\\') fputc('\\', file);
        fputc((unsigned char)*text < ' ' ? ' ' : *text, file);
    }
}

static void write_details(FILE *file, const RegressionCase *made) {
    JsonWriter json = {.out = file};
    fputs("  ---\n  ", file);
    json_begin_object(&json, NULL, JSON_ONE_LINE);
    json_put_text(&json, "verdict", made->verdict);
    json_put_text(&json, "words", made->words.text);
    json_put_text(&json, "expected", made->paths[EXPECTED][0] != '\0' ? made->paths[EXPECTED] : NULL);
    json_put_text(&json, "actual", made->paths[ACTUAL][0] != '\0' ? made->paths[ACTUAL] : NULL);
    json_end(&json);
    fputs("  ...\n", file);
}

/* A comment for each line. */
static void write_notes(FILE *file, const char *notes) {
    if (notes[0] != '\0') fputs("# ", file);
    for (; *notes != '\0'; notes++) {
        fputc(*notes, file);
        if (*notes == '\n') fputs("# ", file);
        if (notes[1] == '\0') fputc('\n', file);
    }
}

void report_write_tap(FILE *file, const void *context) {
    const Regression *regression = ((const Report *)context)->regression;
    const int count = regression_case_count(regression);
    fprintf(file, "TAP version 14\n1..%d\n", count);
    write_notes(file, regression_notes(regression).text);
    for (int i = 0; i < count; i++) {
        const RegressionCase made = regression_case(regression, i);
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
