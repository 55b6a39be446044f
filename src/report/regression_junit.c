/* SPDX-License-Identifier: GPL-3.0-or-later */
/* junit.xml for CI systems: a test case per frame and trajectory, with the time of its comparison. The times make it the
   one file of a report that differs from run to run. html_put() also escapes for XML. */
#include "common/html_text.h"
#include "report/regression_cases.h"
#include "report/regression_parts.h"

#include <string.h>

static void write_attribute(FILE *file, const char *key, const char *value) {
    fprintf(file, " %s=\"", key);
    html_put(file, value);
    fputc('"', file);
}

/* The form in which GitLab and Jenkins link files; "]]" would end it. */
static void write_attachment(FILE *file, const char *path) {
    if (path[0] == '\0' || strstr(path, "]]") != NULL) return;
    fputs("[[ATTACHMENT|", file);
    html_put(file, path);
    fputs("]]\n", file);
}

static void write_regions(FILE *file, const RegressionFrame *frame) {
    const FrameChanges *changes = frame != NULL ? frame->changes : NULL;
    for (int i = 0; changes != NULL && i < changes->regions.kept; i++) {
        html_put(file, region_words(changes, i).text);
        fputc('\n', file);
    }
}

static void write_failure(FILE *file, const RegressionCase *made) {
    static const char *const titles[SIDES] = {"expected: ", "actual: "};
    char message[sizeof made->words.text + 64];
    snprintf(message, sizeof message, "%s: %s", made->verdict, made->words.text);
    fputs("    <failure", file);
    write_attribute(file, "type", made->verdict);
    write_attribute(file, "message", message);
    fputc('>', file);
    for (RegressionSide side = EXPECTED; side < SIDES; side++) {
        if (made->paths[side][0] == '\0') continue;
        fputs(titles[side], file);
        html_put(file, made->paths[side]);
        fputc('\n', file);
    }
    write_regions(file, made->frame);
    fputs("</failure>\n    <system-out>", file);
    write_attachment(file, made->paths[ACTUAL]); /* the first one is what GitLab shows */
    write_attachment(file, made->paths[EXPECTED]);
    fputs("</system-out>\n", file);
}

static void write_case(FILE *file, const RegressionCase *made) {
    fprintf(file, "  <testcase classname=\"%s\"", made->kind);
    write_attribute(file, "name", made->name);
    write_attribute(file, "file", made->paths[made->paths[EXPECTED][0] != '\0' ? EXPECTED : ACTUAL]);
    fprintf(file, " time=\"%.6f\"", made->seconds);
    if (!made->failed) {
        fputs("/>\n", file);
        return;
    }
    fputs(">\n", file);
    write_failure(file, made);
    fputs("  </testcase>\n", file);
}

void report_write_junit(FILE *file, const void *context) {
    const Regression *regression = ((const Report *)context)->regression;
    const int count = regression_case_count(regression);
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n", file);
    fprintf(file,
            "<testsuite name=\"twinbox compare\" tests=\"%d\" failures=\"%d\" errors=\"0\" skipped=\"0\" "
            "time=\"%.6f\">\n",
            count, regression->failed + regression->run_failed, regression->seconds);
    for (int i = 0; i < count; i++) {
        const RegressionCase made = regression_case(regression, i);
        write_case(file, &made);
    }
    const RegressionText notes = regression_notes(regression);
    if (notes.text[0] != '\0') {
        fputs("  <system-out>", file);
        html_put(file, notes.text);
        fputs("</system-out>\n", file);
    }
    fputs("</testsuite>\n", file);
}
