/* SPDX-License-Identifier: GPL-3.0-or-later */
/* report.html: what a comparison found, the values of all frames as curves, pictures and results for the page's
   script. */
#include "pictures/page.h"
#include "regression/regression_internal.h"
#include "regression/regression.h"
#include "runs/trajectory.h"

#include <ctype.h>
#include <math.h>

enum { HEIGHT = 100 };

/* Each curve is an SVG that is stretched to its place, one unit of width per frame. Its labels are text of the page, so
   they keep their size on any screen and are never clipped. */
typedef double (*Measure)(const RegressionFrame *frame);

static bool is_measured(const RegressionFrame *frame) { return frame->pixels <= PIXELS_RESIZED && !frame->sizes_alone; }
static double flip_of(const RegressionFrame *frame) { return is_measured(frame) ? frame->flip : (double)NAN; }
static double largest_of(const RegressionFrame *frame) {
    return is_measured(frame) ? (double)frame->difference.largest : (double)NAN;
}

/* A step curve with one step per frame; equal steps are joined, and frames without a value leave a gap. */
static void write_curve(FILE *file, const Regression *regression, const char *name, Measure measure, double most) {
    double before = NAN;
    fprintf(file, "<path class=\"%s\" d=\"", name);
    for (int i = 0; i < regression->count; i++) {
        double value = measure(&regression->frames[i]), y = HEIGHT - HEIGHT * value / most;
        if (isnan(value) ? isnan(before) : value == before) continue;
        if (!isnan(before)) fprintf(file, "H%d", i);
        if (!isnan(value) && isnan(before)) fprintf(file, "M%d %.2f", i, y);
        if (!isnan(value) && !isnan(before)) fprintf(file, "V%.2f", y);
        before = value;
    }
    if (!isnan(before)) fprintf(file, "H%d", regression->count);
    fputs("\"/>", file);
}

static void write_end(FILE *file, const RegressionFrame *frame) {
    fputs("<span>", file);
    html_put(file, frame_name(frame));
    fputs("</span>", file);
}

static void write_plot(FILE *file, const Regression *regression, const char *title, const char *name, Measure measure,
                       double most) {
    fprintf(file, "<div class=\"plot\"><h3>%s</h3>\n<div class=\"values\"><span>%.3g</span><span>0</span></div>\n",
            title, most);
    fprintf(
        file,
        "<svg viewBox=\"0 0 %d %d\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"%s, of each of %d frames, "
        "at most %.3g\">",
        regression->count, HEIGHT, title, regression->count, most);
    write_curve(file, regression, name, measure, most);
    fprintf(file, "<line class=\"cursor\" visibility=\"hidden\" x1=\"0\" x2=\"0\" y1=\"0\" y2=\"%d\"/></svg>\n",
            HEIGHT);
    fputs("<div class=\"ends\">", file);
    write_end(file, &regression->frames[0]);
    if (regression->count > 1) write_end(file, &regression->frames[regression->count - 1]);
    fputs("</div></div>\n", file);
}

/* Plots FLIP and the largest difference over the frames, as HTML with SVG. There must be a frame. */
static void report_write_plot(FILE *file, const Regression *regression) {
    double most = 0;
    for (int i = 0; i < regression->count; i++) most = fmax(most, flip_of(&regression->frames[i]));
    write_plot(file, regression, "FLIP, mean of the frame", "flip", flip_of, most > 0 ? most : 1);
    write_plot(file, regression, "Largest difference of a channel", "largest", largest_of, 255);
}

/* The fixed parts of page/, and pictures and results as data for its script. */

static void write_count(FILE *file, int count, const char *look, const char *what) {
    if (count > 0) fprintf(file, "<li class=\"%s\"><b>%d</b> %s</li>\n", look, count, what);
}

static void write_frames(FILE *file, int count, const char *look, const char *what) {
    char words[64];
    snprintf(words, sizeof words, "%s: %s", count == 1 ? "frame" : "frames", what);
    write_count(file, count, look, words);
}

static void write_counts(FILE *file, const Regression *regression) {
    const int *by = regression->by_verdict;
    fputs("<ul class=\"counts\" aria-label=\"Frames by verdict\">\n", file);
    write_frames(file, regression->renderer, "bad", "renderer changed");
    write_frames(file, regression->physics, "bad", "physics changed");
    write_frames(file, regression->view, "bad", "view changed");
    write_frames(file, regression->elsewhere, "bad", "run changed");
    write_frames(file, regression->unknown, "bad", "pictures differ");
    write_frames(file, by[PIXELS_MISSING], "bad", "missing");
    write_frames(file, by[PIXELS_EXTRA], "bad", "extra");
    write_frames(file, by[PIXELS_UNREAD], "bad", "not comparable");
    write_frames(file, regression->metadata_failed, "bad", "metadata changed");
    write_frames(file, by[PIXELS_WITHIN], "odd", "within tolerance");
    write_frames(file, by[PIXELS_EQUAL], "good", "equal pixels");
    write_count(file, regression->run_failed, "bad",
                regression->run_failed == 1 ? "trajectory differs" : "trajectories differ");
    write_count(file, regression->run_within, "odd",
                regression->run_within == 1 ? "trajectory within tolerance" : "trajectories within tolerance");
    fputs("</ul>\n", file);
}

static void write_verdict(FILE *file, const Regression *regression) {
    RegressionText verdict = regression_verdict(regression);
    verdict.text[0] = (char)toupper((unsigned char)verdict.text[0]);
    fprintf(file, "<span class=\"verdict %s\" id=\"verdict\">", regression_passed(regression) ? "good" : "bad");
    html_put(file, verdict.text);
    fputs("</span>\n", file);
}

static void write_code(FILE *file, const char *text) {
    fputs("<code>", file);
    html_put(file, text);
    fputs("</code>", file);
}

static void write_description(FILE *file, const Regression *regression) {
    const RegressionOptions *options = &regression->options;
    fputs("<p class=\"soft\">Expected ", file);
    write_code(file, regression->sequences[EXPECTED]->folder);
    fputs(", actual ", file);
    write_code(file, regression->sequences[ACTUAL]->folder);
    fprintf(file, ": %d %s, ", regression->count, regression->count == 1 ? "frame" : "frames");
    fprintf(file, "tolerance: %s", regression_limits(regression).text);
    if (regression->rules != NULL) {
        fputs(", rules of ", file);
        write_code(file, rules_path(regression->rules));
    }
    if (options->mask != NULL && options->mask->count > 0)
        fprintf(file, ", %d %s", options->mask->count, options->mask->count == 1 ? "mask" : "masks");
    fputs(".</p>\n", file);
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

static void write_notes(FILE *file, const Regression *regression) {
    RegressionText notes = regression_notes(regression);
    if (notes.text[0] == '\0') return;
    fputs("<p class=\"begin\" id=\"notes\">", file);
    html_put(file, notes.text);
    fputs("</p>\n", file);
}

/* The text of the link tells where it leads, for those who hear the links only. */
static void write_run_link(FILE *file, const Report *report, int index) {
    const TrajectoryDifference *difference = &report->regression->runs[index].difference;
    const char *link = report->runs->links[index].text;
    if (link[0] == '\0') return;
    fputs("<a href=\"", file);
    html_put(file, link);
    fputs("\">play both runs", file);
    if (difference->frame >= 0) fprintf(file, " from frame %d, body %d", difference->frame, difference->body);
    fputs("</a>", file);
}

static void write_summary(FILE *file, const Report *report) {
    const Regression *regression = report->regression;
    fputs("<header><h1>twinbox compare</h1>\n", file);
    write_verdict(file, regression);
    fputs("</header>\n", file);
    write_description(file, regression);
    write_counts(file, regression);
    fputs("<p class=\"begin\">", file);
    html_put(file, regression_begin(regression).text);
    if (regression->first_run >= 0) {
        fputs("\n", file);
        write_run_link(file, report, regression->first_run);
    }
    fputs("</p>\n<ul id=\"causes\" aria-label=\"Causes\"></ul>\n", file);
    write_notes(file, regression);
    if (report->pictures->left_out > 0)
        fprintf(
            file,
            "<p class=\"bad\">The pictures of %d frames exceed the report's size limit and are omitted. These frames "
            "cannot be approved; compare again with a larger <code>--report-size</code>.</p>\n",
            report->pictures->left_out);
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
        fputs("<tr><td>", file);
        html_put(file, run->name);
        fprintf(file, "</td><td class=\"%s\">%s</td><td>",
                run_failed(run) ? "bad"
                : run->within   ? "odd"
                                : "good",
                run_verdict(run));
        html_put(file, run_words(run).text);
        fputs("</td><td>", file);
        write_run_link(file, report, i);
        fputs("</td></tr>\n", file);
    }
    fputs("</tbody></table>\n", file);
    if (report->runs->left_out > 0)
        fprintf(
            file,
            "<p class=\"odd\">Without a page, as these exceed the report's size limit: %d. Compare again with a larger "
            "<code>--report-size</code>.</p>\n",
            report->runs->left_out);
    fputs("</section>\n", file);
}

static void write_approval(FILE *file, const Report *report) {
    if (regression_passed(report->regression)) return;
    fputs("<section class=\"panel\" aria-labelledby=\"approve\"><h2 id=\"approve\">Accept these changes</h2>\n<p>",
          file);
    write_code(file, "twinbox approve ");
    write_code(file, report->folder);
    const char *expected = report->regression->sequences[EXPECTED]->folder;
    if (path_below_current(expected) == NULL) { /* approve must be told. */
        write_code(file, " --expected ");
        write_code(file, expected);
    }
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

static void write_pictures(FILE *file, const ReportPictures *pictures) {
    for (int i = 0; i < pictures->count; i++)
        for (int kind = 0; kind < REPORT_KINDS; kind++) {
            const ReportPicture *picture = &pictures->frames[i][kind];
            if (picture->data == NULL) continue;
            fprintf(file, "<script type=\"text/plain\" id=\"p%d%c\">", i, report_kind_letters[kind]);
            base64_put(file, picture->data, picture->size);
            fputs("</script>\n", file);
        }
}

void report_write_page(FILE *file, const void *context) {
    const Report *report = context;
    const Regression *regression = report->regression;
    write_head(file, regression);
    write_summary(file, report);
    if (regression->film) {
        fputs("<section class=\"panel\" id=\"plot\" aria-label=\"Differences of all frames\">\n", file);
        report_write_plot(file, regression);
        fputs("</section>\n", file);
    }
    fputs(report_page_html, file);
    write_runs(file, report);
    write_approval(file, report);
    fputs(report_help_html, file);
    write_pictures(file, report->pictures);
    fputs("<script type=\"application/json\" id=\"data\">", file);
    report_write_json(file, report);
    fprintf(file, "</script>\n<script>%s</script>\n</main>\n</body>\n</html>\n", report_script);
}
