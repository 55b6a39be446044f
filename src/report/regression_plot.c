/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/regression_parts.h"

#include <math.h>

enum { WIDTH = 1200, HEIGHT = 124, LEFT = 50, RIGHT = 1190, ROW = 34, FLIP_TOP = 22, LARGEST_TOP = 84 };

typedef double (*Figure)(const RegressionFrame *frame);

static bool has_figures(const RegressionFrame *frame) { return frame->pixels <= PIXELS_DIFFER; }
static double flip_of(const RegressionFrame *frame) { return has_figures(frame) ? frame->flip : (double)NAN; }
static double largest_of(const RegressionFrame *frame) {
    return has_figures(frame) ? (double)frame->difference.largest : (double)NAN;
}

static double step(const Regression *regression) { return (double)(RIGHT - LEFT) / regression->count; }

/* Steps, one a frame; those of equal height make one line, and frames without a figure leave a gap. */
static void put_curve(FILE *file, const Regression *regression, const char *name, Figure figure, double most, int top) {
    double before = NAN;
    fprintf(file, "<path class=\"curve %s\" d=\"", name);
    for (int i = 0; i < regression->count; i++) {
        double value = figure(&regression->frames[i]), x = LEFT + i * step(regression),
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

static void put_row(FILE *file, const Regression *regression, const char *title, const char *name, Figure figure,
                    double most, int top) {
    fprintf(file, "<text x=\"%d\" y=\"%d\">%s</text>\n", LEFT, top - 8, title);
    fprintf(file, "<text x=\"%d\" y=\"%d\" text-anchor=\"end\">%.3g</text>\n", LEFT - 6, top + 10, most);
    fprintf(file, "<text x=\"%d\" y=\"%d\" text-anchor=\"end\">0</text>\n", LEFT - 6, top + ROW);
    fprintf(file, "<path class=\"axis\" d=\"M%d %dV%dH%d\"/>\n", LEFT, top, top + ROW, RIGHT);
    put_curve(file, regression, name, figure, most, top);
}

void report_put_plot(FILE *file, const Regression *regression) {
    double most = 0;
    for (int i = 0; i < regression->count; i++) most = fmax(most, flip_of(&regression->frames[i]));
    fprintf(file,
            "<svg viewBox=\"0 0 %d %d\" data-left=\"%d\" data-step=\"%.9g\" role=\"img\" "
            "aria-label=\"FLIP and largest difference of each of %d frames; FLIP is at most %.3g\">\n",
            WIDTH, HEIGHT, LEFT, step(regression), regression->count, most);
    put_row(file, regression, "FLIP, mean of the frame", "flip", flip_of, most > 0 ? most : 1, FLIP_TOP);
    put_row(file, regression, "Largest difference of a channel", "largest", largest_of, 255, LARGEST_TOP);
    fprintf(file, "<line class=\"cursor\" visibility=\"hidden\" x1=\"0\" x2=\"0\" y1=\"%d\" y2=\"%d\"/>\n</svg>\n",
            FLIP_TOP - 4, LARGEST_TOP + ROW + 4);
}
