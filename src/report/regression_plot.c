/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/regression_parts.h"

#include <math.h>

enum { WIDTH = 1200, HEIGHT = 124, LEFT = 50, RIGHT = 1190, ROW = 34, FLIP_TOP = 22, LARGEST_TOP = 84 };

typedef double (*Measure)(const RegressionFrame *frame);

static bool is_measured(const RegressionFrame *frame) { return frame->pixels <= PIXELS_DIFFER; }
static double flip_of(const RegressionFrame *frame) { return is_measured(frame) ? frame->flip : (double)NAN; }
static double largest_of(const RegressionFrame *frame) {
    return is_measured(frame) ? (double)frame->difference.largest : (double)NAN;
}

static double step(const Regression *regression) { return (double)(RIGHT - LEFT) / regression->count; }

/* A step curve with one step per frame; equal steps are joined, and frames without a value leave a gap. */
static void write_curve(FILE *file, const Regression *regression, const char *name, Measure measure, double most,
                        int top) {
    double before = NAN;
    fprintf(file, "<path class=\"curve %s\" d=\"", name);
    for (int i = 0; i < regression->count; i++) {
        double value = measure(&regression->frames[i]), x = LEFT + i * step(regression),
               y = top + ROW - ROW * value / most;
        if (isnan(value) ? isnan(before) : value == before) continue;
        if (!isnan(before)) fprintf(file, "H%.2f", x);
        if (!isnan(value) && isnan(before)) fprintf(file, "M%.2f %.2f", x, y);
        if (!isnan(value) && !isnan(before)) fprintf(file, "V%.2f", y);
        before = value;
    }
    if (!isnan(before)) fprintf(file, "H%d", RIGHT);
    fputs("\"/>\n", file);
}

static void write_row(FILE *file, const Regression *regression, const char *title, const char *name, Measure measure,
                      double most, int top) {
    fprintf(file, "<text x=\"%d\" y=\"%d\">%s</text>\n", LEFT, top - 8, title);
    fprintf(file, "<text x=\"%d\" y=\"%d\" text-anchor=\"end\">%.3g</text>\n", LEFT - 6, top + 10, most);
    fprintf(file, "<text x=\"%d\" y=\"%d\" text-anchor=\"end\">0</text>\n", LEFT - 6, top + ROW);
    fprintf(file, "<path class=\"axis\" d=\"M%d %dV%dH%d\"/>\n", LEFT, top, top + ROW, RIGHT);
    write_curve(file, regression, name, measure, most, top);
}

void report_write_plot(FILE *file, const Regression *regression) {
    double most = 0;
    for (int i = 0; i < regression->count; i++) most = fmax(most, flip_of(&regression->frames[i]));
    fprintf(file,
            "<svg viewBox=\"0 0 %d %d\" data-left=\"%d\" data-step=\"%.9g\" role=\"img\" "
            "aria-label=\"FLIP and largest difference of each of %d frames; FLIP is at most %.3g\">\n",
            WIDTH, HEIGHT, LEFT, step(regression), regression->count, most);
    write_row(file, regression, "FLIP, mean of the frame", "flip", flip_of, most > 0 ? most : 1, FLIP_TOP);
    write_row(file, regression, "Largest difference of a channel", "largest", largest_of, 255, LARGEST_TOP);
    fprintf(file, "<line class=\"cursor\" visibility=\"hidden\" x1=\"0\" x2=\"0\" y1=\"%d\" y2=\"%d\"/>\n</svg>\n",
            FLIP_TOP - 4, LARGEST_TOP + ROW + 4);
}
