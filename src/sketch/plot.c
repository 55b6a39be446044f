/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sketch/plot.h"

#include "picture/style.h"
#include "type/type.h"

#include <math.h>

static const double tic = 1; /* mm */

static double em(double points) { return points * MM_PER_POINT; }

double plot_left_margin(double points) {
    return 1.35 * em(points) + type_width("10\xE2\x88\x92", points) + em(points) + tic;
}

double plot_bottom_margin(double points) { return 2.9 * em(points) + tic; }

void plot_begin(Plot *plot, Point low, Point high, double begin, double end, double least, double most, double points) {
    *plot = (Plot){low, high, begin, end, log_axis(least, most), points};
    plot->axis.from = low.y, plot->axis.to = high.y;
}

Point plot_place(const Plot *plot, double x, double y) {
    double share = (x - plot->begin) / (plot->end - plot->begin);
    double up = log_axis_place(&plot->axis, fmin(fmax(y, plot->axis.low), plot->axis.high));
    return (Point){plot->low.x + fmin(fmax(share, 0), 1) * (plot->high.x - plot->low.x), up};
}

/* A round step that gives at most eight labels. */
static double linear_step(double length) {
    const double most_steps = 8, least = length / most_steps, power = pow(10, floor(log10(least)));
    const double share = least / power;
    return power * (share <= 1 ? 1 : share <= 2 ? 2 : share <= 5 ? 5 : 10);
}

static void draw_linear_axis(const Plot *plot, Sketch *sketch, const char *name) {
    const double step = linear_step(plot->end - plot->begin), slack = 1e-9 * step, size = em(plot->points);
    const int decimals = step >= 0.99 ? 0 : (int)ceil(-log10(step) - 1e-9);
    const Pen pen = pen_line(INK, 1.2, NULL);
    const TextStyle numbers = {plot->points, TEXT_CENTER, INK, 0, false};
    for (double i = ceil(plot->begin / step - 1e-9); i * step <= plot->end + slack; i++) {
        const double x = i * step;
        const Point at = {plot_place(plot, x, plot->axis.low).x, plot->low.y};
        sketch_line(sketch, at, (Point){at.x, at.y - tic}, &pen);
        sketch_text(sketch, (Point){at.x, at.y - tic - 0.75 * size}, &numbers, "%s", show_decimals(x, decimals).text);
    }
    sketch_text(sketch, (Point){(plot->low.x + plot->high.x) / 2, plot->low.y - tic - 2.2 * size}, &numbers, "%s",
                name);
}

static void draw_log_axis(const Plot *plot, Sketch *sketch, const char *name) {
    const LogAxis *axis = &plot->axis;
    const int first = (int)ceil(log10(axis->low) - 1e-9), last = (int)floor(log10(axis->high) + 1e-9);
    const double decade = (axis->to - axis->from) / log10(axis->high / axis->low);
    const int step = (int)fmax(ceil(1.6 * em(plot->points) / decade), 1);
    const Pen pen = pen_line(INK, 1.2, NULL), guide = pen_line(GRID_STRONG, 0.9, NULL);
    const TextStyle numbers = {plot->points, TEXT_RIGHT, INK, 0, false};
    for (int power = first; power <= last; power++) {
        const double y = log_axis_place(axis, pow(10, power));
        if (power % step != 0) continue;
        sketch_line(sketch, (Point){plot->low.x, y}, (Point){plot->high.x, y}, &guide);
        sketch_line(sketch, (Point){plot->low.x - tic, y}, (Point){plot->low.x, y}, &pen);
        sketch_power_of_ten(sketch, (Point){plot->low.x - tic - 0.4, y}, &numbers, power);
    }
    const double x = plot->low.x - plot_left_margin(plot->points) + 0.6 * em(plot->points);
    sketch_text(sketch, (Point){x, (plot->low.y + plot->high.y) / 2},
                &(TextStyle){plot->points, TEXT_CENTER, INK, 90, false}, "%s", name);
}

void plot_draw_axes(const Plot *plot, Sketch *sketch, const char *x_name, const char *y_name) {
    draw_log_axis(plot, sketch, y_name);
    draw_linear_axis(plot, sketch, x_name);
    const Point line[] = {{plot->low.x, plot->high.y}, plot->low, {plot->high.x, plot->low.y}};
    const Pen pen = pen_line(INK, 1.2, NULL);
    sketch_path(sketch, line, 3, &pen);
}
