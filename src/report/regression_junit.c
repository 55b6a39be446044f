/* SPDX-License-Identifier: GPL-3.0-or-later */
/* junit.xml for CI systems: a test case per frame and trajectory. Without times, so that the same comparison gives the
   same bytes. html_put() also escapes for XML. */
#include "common/html_text.h"
#include "report/regression_parts.h"

static void write_case(FILE *file, const char *kind, const char *name, const char *verdict, const char *words) {
    fprintf(file, "  <testcase classname=\"%s\" name=\"", kind);
    html_put(file, name);
    fputc('"', file);
    if (verdict == NULL) {
        fputs("/>\n", file);
        return;
    }
    fputs("><failure type=\"", file);
    html_put(file, verdict);
    fputs("\" message=\"", file);
    html_put(file, verdict);
    fputs(": ", file);
    html_put(file, words);
    fputs("\"/></testcase>\n", file);
}

void report_write_junit(FILE *file, const void *context) {
    const Regression *regression = ((const Report *)context)->regression;
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n", file);
    fprintf(file, "<testsuite name=\"twinbox compare\" tests=\"%d\" failures=\"%d\" errors=\"0\" skipped=\"0\">\n",
            regression->count + regression->run_count, regression->failed + regression->run_failed);
    for (int i = 0; i < regression->count; i++) {
        const RegressionFrame *frame = &regression->frames[i];
        write_case(file, "frames", frame_name(frame), frame_failed(frame) ? frame_verdict(frame) : NULL,
                   frame_words(frame).text);
    }
    for (int i = 0; i < regression->run_count; i++) {
        const RegressionRun *run = &regression->runs[i];
        write_case(file, "trajectories", run->name, run->difference.equal ? NULL : "physics changed",
                   run_words(run).text);
    }
    fputs("</testsuite>\n", file);
}
