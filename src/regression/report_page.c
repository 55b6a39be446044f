/* SPDX-License-Identifier: GPL-3.0-or-later */
/* report.html: what a comparison found, the differences of all frames as a curve, pictures and results for the page's
   script. */
#include "pictures/page.h"
#include "regression/approve.h"
#include "regression/regression.h"
#include "regression/regression_internal.h"
#include "runs/compare_runs.h"

#include <ctype.h>

enum { HEIGHT = 100 };

/* The largest difference of each frame as a step curve, one unit of width per frame, in an SVG that is stretched to its
   place; equal steps are joined, and frames without a value leave a gap. Labels are text of the page, so they keep
   their size on any screen and are never clipped. */
static void write_plot(FILE *file, const Regression *regression) {
    enum { MOST = 255 };
    const int count = regression->count;
    int before = -1;
    fprintf(file,
            "<div class=\"plot\"><h3>Largest difference of a channel</h3>\n<div "
            "class=\"values\"><span>%d</span><span>0</span></div>\n<svg viewBox=\"0 0 %d %d\" "
            "preserveAspectRatio=\"none\" role=\"img\" aria-label=\"Largest difference of a channel, of each of %d "
            "frames, at most %d\"><path class=\"largest\" d=\"",
            MOST, count, HEIGHT, count, MOST);
    for (int i = 0; i < count; i++) {
        const RegressionFrame *frame = &regression->frames[i];
        const bool measured = frame->pixels <= PIXELS_RESIZED && !frame->sizes_alone;
        const int value = measured ? frame->difference.largest : -1;
        const double y = HEIGHT - (double)HEIGHT * value / MOST;
        if (value == before) continue;
        if (before >= 0) fprintf(file, "H%d", i);
        if (value >= 0 && before < 0) fprintf(file, "M%d %.2f", i, y);
        if (value >= 0 && before >= 0) fprintf(file, "V%.2f", y);
        before = value;
    }
    if (before >= 0) fprintf(file, "H%d", count);
    fprintf(file,
            "\"/><line class=\"cursor\" visibility=\"hidden\" x1=\"0\" x2=\"0\" y1=\"0\" y2=\"%d\"/></svg>\n<div "
            "class=\"ends\">",
            HEIGHT);
    html_print(file, "<span>%s</span>", frame_name(&regression->frames[0]));
    if (count > 1) html_print(file, "<span>%s</span>", frame_name(&regression->frames[count - 1]));
    fputs("</div></div>\n", file);
}

/* The fixed parts of page/, and pictures and results as data for its script. */

static void write_counts(FILE *file, const Regression *regression) {
    const int *by = regression->by_verdict, different = regression->run_failed - regression->runs_unread;
    const struct {
        int count;
        const char *look, *what;
        bool runs;
    } lines[] = {{regression->renderer, "bad", "renderer changed", false},
                 {regression->physics, "bad", "physics changed", false},
                 {regression->view, "bad", "view changed", false},
                 {regression->elsewhere, "bad", "run changed", false},
                 {regression->unknown, "bad", "pictures differ", false},
                 {by[PIXELS_MISSING], "bad", "missing", false},
                 {by[PIXELS_EXTRA], "bad", "extra", false},
                 {by[PIXELS_UNREAD], "bad", "not comparable", false},
                 {regression->metadata_failed, "bad", "metadata changed", false},
                 {by[PIXELS_WITHIN], "odd", "within tolerance", false},
                 {by[PIXELS_EQUAL], "good", "equal pixels", false},
                 {different, "bad", different == 1 ? "differs" : "differ", true},
                 {regression->runs_unread, "bad", "not comparable", true},
                 {regression->run_within, "odd", "within tolerance", true}};
    fputs("<ul class=\"counts\" aria-label=\"Frames by verdict\">\n", file);
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        const int count = lines[i].count;
        const char *unit = lines[i].runs ? (count == 1 ? "trajectory " : "trajectories ")
                           : count == 1  ? "frame: "
                                         : "frames: ";
        if (count > 0)
            fprintf(file, "<li class=\"%s\"><b>%d</b> %s%s</li>\n", lines[i].look, count, unit, lines[i].what);
    }
    fputs("</ul>\n", file);
}

static void write_head(FILE *file, const Regression *regression) {
    /* The policy prevents any request, whatever names the page contains. */
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
          "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
          "style-src 'unsafe-inline'; script-src",
          file);
    html_put_script_hash(file, report_script_sha256);
    fputs("\">\n<title>twinbox compare: ", file);
    html_put(file, regression_verdict(regression).text);
    fprintf(file, "</title>\n<style>\n%s%s</style>\n</head>\n<body>\n", house_css, report_page_css);
    fputs("<a class=\"skip\" id=\"skip\" href=\"#stage\">Skip to the pictures</a>\n<main>\n", file);
}

/* The text of the link tells where it leads, for those who hear the links only. */
static void write_run_link(FILE *file, const Report *report, int index) {
    const TrajectoryDifference *difference = &report->regression->runs[index].difference;
    const char *link = report->links[index].text;
    if (link[0] == '\0') return;
    html_print(file, "<a href=\"%s\">play both runs", link);
    if (difference->frame >= 0) fprintf(file, " from frame %d, body %d", difference->frame, difference->body);
    fputs("</a>", file);
}

static void write_summary(FILE *file, const Report *report) {
    const Regression *regression = report->regression;
    RegressionText verdict = regression_verdict(regression), notes = regression_notes(regression);
    verdict.text[0] = (char)toupper((unsigned char)verdict.text[0]);
    html_print(file,
               "<header><h1>twinbox compare</h1>\n<span class=\"verdict %s\" id=\"verdict\">%s</span>\n</header>\n",
               regression_passed(regression) ? "good" : "bad", verdict.text);
    html_print(file, "<p class=\"soft\">Expected <code>%s</code>, actual <code>%s</code>: ",
               regression->sequences[EXPECTED]->folder, regression->sequences[ACTUAL]->folder);
    fprintf(file, "%d %s, ", regression->count, regression->count == 1 ? "frame" : "frames");
    fprintf(file, "tolerance: %s", regression_limits(regression).text);
    if (regression->rules != NULL) html_print(file, ", rules of <code>%s</code>", rules_path(regression->rules));
    if (regression->options.mask != NULL && regression->options.mask->count > 0)
        fprintf(file, ", %d %s", regression->options.mask->count,
                regression->options.mask->count == 1 ? "mask" : "masks");
    fputs(".</p>\n", file);
    write_counts(file, regression);
    html_print(file, "<p class=\"begin\">%s", regression_begin(regression).text);
    if (regression->first_run >= 0) {
        fputs("\n", file);
        write_run_link(file, report, regression->first_run);
    }
    fputs("</p>\n<ul id=\"causes\" aria-label=\"Causes\"></ul>\n", file);
    if (notes.text[0] != '\0') html_print(file, "<p class=\"begin\" id=\"notes\">%s</p>\n", notes.text);
    if (report->pictures_left_out > 0)
        fprintf(
            file,
            "<p class=\"bad\">The pictures of %d frames exceed the report's size limit and are omitted. These frames "
            "cannot be approved; compare again with a larger <code>--report-size</code>.</p>\n",
            report->pictures_left_out);
    fputs("<noscript><p class=\"bad\">The pictures need JavaScript. junit.xml next to this page lists every frame that "
          "failed.</p></noscript>\n",
          file);
}

static void write_runs(FILE *file, const Report *report) {
    const Regression *regression = report->regression;
    if (regression->run_count == 0) return;
    fputs("<section class=\"panel scroll\" tabindex=\"0\" aria-labelledby=\"runs\"><h2 id=\"runs\">Trajectories</h2>\n"
          "<table><thead><tr><th>Name</th><th>Verdict</th><th>Difference</th><th>Page</th></tr></thead><tbody>\n",
          file);
    for (int i = 0; i < regression->run_count; i++) {
        const RegressionRun *run = &regression->runs[i];
        const char *look = run_failed(run) ? "bad" : run->within ? "odd" : "good";
        const RegressionText verdicts = run_verdicts(run);
        html_print(file, "<tr><td>%s</td><td class=\"%s\">%s</td><td>%s%s%s</td><td>", run->name, look,
                   run_verdict(run), run_words(run).text, verdicts.text[0] != '\0' ? "; " : "", verdicts.text);
        write_run_link(file, report, i);
        fputs("</td></tr>\n", file);
    }
    fputs("</tbody></table>\n", file);
    if (report->runs_left_out > 0)
        fprintf(
            file,
            "<p class=\"odd\">Without a page, as these exceed the report's size limit: %d. Compare again with a larger "
            "<code>--report-size</code>.</p>\n",
            report->runs_left_out);
    fputs("</section>\n", file);
}

static void write_approval(FILE *file, const Report *report) {
    if (regression_passed(report->regression)) return;
    const char *expected = report->regression->sequences[EXPECTED]->folder;
    html_print(file,
               "<section class=\"panel\" aria-labelledby=\"approve\"><h2 id=\"approve\">Accept these "
               "changes</h2>\n<p><code>twinbox approve %s",
               report->folder);
    if (path_below_current(expected) == NULL) html_print(file, " --expected %s", expected); /* approve must be told. */
    fputs("</code>", file);
    fputs(report->regression->count + report->regression->run_count > 1
              ? " replaces the expected files by the actual ones; with <code>--only 'stack_*'</code>, only files of "
                "matching names."
              : " replaces the expected file by the actual one.",
          file);
    if (report->regression->by_verdict[PIXELS_MISSING] + report->regression->runs_alone[EXPECTED] > 0)
        fputs(" Expected files that have no actual one are kept with <code>--partial</code>, removed with "
              "<code>--remove</code>.",
              file);
    fputs("</p></section>\n", file);
}

void report_write_page(FILE *file, const void *context) {
    const Report *report = context;
    const Regression *regression = report->regression;
    write_head(file, regression);
    write_summary(file, report);
    if (regression->film) {
        fputs("<section class=\"panel\" id=\"plot\" aria-label=\"Differences of all frames\">\n", file);
        write_plot(file, regression);
        fputs("</section>\n", file);
    }
    fputs(report_page_html, file);
    write_runs(file, report);
    write_approval(file, report);
    fputs(report_help_html, file);
    for (int i = 0; i < regression->count; i++)
        for (int kind = 0; kind < REPORT_KINDS; kind++) {
            const ReportPicture *picture = &report->pictures[i][kind];
            if (picture->data == NULL) continue;
            fprintf(file, "<script type=\"text/plain\" id=\"p%d%c\">", i, "ead"[kind]);
            base64_put(file, picture->data, picture->size);
            fputs("</script>\n", file);
        }
    fputs("<script type=\"application/json\" id=\"data\">", file);
    report_write_json(file, report);
    fprintf(file, "</script>\n<script>%s</script>\n</main>\n</body>\n</html>\n", report_script);
}
