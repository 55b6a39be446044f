/* SPDX-License-Identifier: GPL-3.0-or-later */
/* report.html. What is fixed of it lies in page/; pictures and figures stand in it as data, which its script reads. */
#include "common/base64.h"
#include "common/html_text.h"
#include "report/page.h"
#include "report/regression_parts.h"

#include <ctype.h>

static void put_count(FILE *file, int count, const char *look, const char *what) {
    if (count > 0) fprintf(file, "<li class=\"%s\"><b>%d</b> %s</li>\n", look, count, what);
}

static void put_counts(FILE *file, const Regression *regression) {
    const int *by = regression->by_verdict;
    fputs("<ul class=\"counts\" aria-label=\"Frames by verdict\">\n", file);
    put_count(file, regression->renderer, "bad", "renderer changed");
    put_count(file, regression->physics, "bad", "physics changed");
    put_count(file, regression->unknown, "bad", "pictures differ");
    put_count(file, by[PIXELS_MISSING], "bad", "missing");
    put_count(file, by[PIXELS_EXTRA], "bad", "extra");
    put_count(file, by[PIXELS_WITHIN], "odd", "within tolerance");
    put_count(file, by[PIXELS_EQUAL], "good", "equal pixels");
    put_count(file, regression->run_failed, "bad", "of the trajectories differ");
    fputs("</ul>\n", file);
}

/* "renderer changed" -> "Renderer changed" */
static void put_verdict(FILE *file, const Regression *regression) {
    RegressionText verdict = regression_verdict(regression);
    verdict.text[0] = (char)toupper((unsigned char)verdict.text[0]);
    fprintf(file, "<span class=\"verdict %s\" id=\"verdict\">", regression_passed(regression) ? "good" : "bad");
    html_put(file, verdict.text);
    fputs("</span>\n", file);
}

static void put_code(FILE *file, const char *text) {
    fputs("<code>", file);
    html_put(file, text);
    fputs("</code>", file);
}

static void put_what(FILE *file, const Regression *regression) {
    const RegressionOptions *options = &regression->options;
    fputs("<p class=\"soft\">Expected ", file);
    put_code(file, regression->sequences[EXPECTED]->folder);
    fputs(", actual ", file);
    put_code(file, regression->sequences[ACTUAL]->folder);
    fprintf(file, ": %d %s, ", regression->count, regression->count == 1 ? "frame" : "frames");
    if (options->max_difference > 0 && options->max_share > 0)
        fprintf(file, "which pass with differences of at most %d in at most %g%% of the pixels",
                options->max_difference, 100 * options->max_share);
    else
        fputs("which pass with equal pixels only", file);
    if (options->mask != NULL && options->mask->count > 0)
        fprintf(file, "; %d %s hide pixels", options->mask->count, options->mask->count == 1 ? "mask" : "masks");
    fputs(".</p>\n", file);
}

static void put_head(FILE *file, const Regression *regression) {
    /* Nothing may be fetched, whatever a name in here says. */
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
          "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
          "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n<title>twinbox compare: ",
          file);
    html_put(file, regression_verdict(regression).text);
    fprintf(file, "</title>\n<style>\n%s</style>\n</head>\n<body>\n<main>\n", report_page_css);
}

static void put_summary(FILE *file, const Report *report) {
    const Regression *regression = report->regression;
    fputs("<header><h1>twinbox compare</h1>\n", file);
    put_verdict(file, regression);
    fputs("</header>\n", file);
    put_what(file, regression);
    put_counts(file, regression);
    fputs("<p class=\"begin\">", file);
    html_put(file, regression_begin(regression).text);
    fputs("</p>\n", file);
    if (report->pictures->left_out > 0)
        fprintf(file,
                "<p class=\"bad\">The pictures of %d frames are left out: the report would have become too large. They "
                "cannot be approved from it; <code>--report-size</code> makes room.</p>\n",
                report->pictures->left_out);
    fputs("<noscript><p class=\"bad\">The pictures are shown by a script, which this browser does not run; junit.xml "
          "beside this page names every frame that failed.</p></noscript>\n",
          file);
}

static void put_runs(FILE *file, const Regression *regression) {
    if (regression->run_count == 0) return;
    fputs("<section class=\"panel scroll\" tabindex=\"0\" aria-labelledby=\"runs\"><h2 id=\"runs\">Trajectories</h2>\n"
          "<table><thead><tr><th>Name</th><th>Verdict</th><th>How</th></tr></thead><tbody>\n",
          file);
    for (int i = 0; i < regression->run_count; i++) {
        const RegressionRun *run = &regression->runs[i];
        fputs("<tr><td>", file);
        html_put(file, run->name);
        fputs(run->difference.equal ? "</td><td class=\"good\">equal</td><td>"
                                    : "</td><td class=\"bad\">physics changed</td><td>",
              file);
        html_put(file, run_words(run).text);
        fputs("</td></tr>\n", file);
    }
    fputs("</tbody></table></section>\n", file);
}

static void put_approval(FILE *file, const Report *report) {
    if (regression_passed(report->regression)) return;
    fputs("<section class=\"panel\" aria-labelledby=\"approve\"><h2 id=\"approve\">To accept what is shown "
          "here</h2>\n<p>",
          file);
    put_code(file, "twinbox approve ");
    put_code(file, report->folder);
    fputs(" replaces the expected files by the actual ones, <code>--only 'stack_*'</code> those of such names.</p>"
          "</section>\n",
          file);
}

static void put_pictures(FILE *file, const ReportPictures *pictures) {
    for (int i = 0; i < pictures->count; i++)
        for (int kind = 0; kind < REPORT_KINDS; kind++) {
            const ReportPicture *picture = &pictures->frames[i][kind];
            if (picture->data == NULL) continue;
            fprintf(file, "<script type=\"text/plain\" id=\"p%d%c\">", i, report_kind_letters[kind]);
            base64_put(file, picture->data, picture->size);
            fputs("</script>\n", file);
        }
}

void report_put_page(FILE *file, const void *context) {
    const Report *report = context;
    const Regression *regression = report->regression;
    put_head(file, regression);
    put_summary(file, report);
    if (regression->count > 0) {
        fputs("<section class=\"panel\" id=\"plot\" aria-label=\"Figures of all frames\">\n", file);
        report_put_plot(file, regression);
        fputs("</section>\n", file);
    }
    fputs(report_page_html, file);
    put_runs(file, regression);
    put_approval(file, report);
    fputs(report_help_html, file);
    put_pictures(file, report->pictures);
    fputs("<script type=\"application/json\" id=\"data\">", file);
    report_put_json(file, report);
    fprintf(file, "</script>\n<script>\n%s</script>\n</main>\n</body>\n</html>\n", report_page_js);
}
