/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each curve is an SVG that is stretched to its place, one unit of width per frame. Its labels are text of the page, so
   they keep their size on any screen and are never clipped. */
#include "common/html_text.h"
#include "report/regression_parts.h"

#include <math.h>

enum { HEIGHT = 100 };

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

void report_write_plot(FILE *file, const Regression *regression) {
    double most = 0;
    for (int i = 0; i < regression->count; i++) most = fmax(most, flip_of(&regression->frames[i]));
    write_plot(file, regression, "FLIP, mean of the frame", "flip", flip_of, most > 0 ? most : 1);
    write_plot(file, regression, "Largest difference of a channel", "largest", largest_of, 255);
}
