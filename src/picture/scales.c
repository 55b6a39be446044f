/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/scales.h"

#include <math.h>
#include <stdlib.h>

/* In units of a panel's shorter side. */
static const double MAX_ARROW = 0.28;
static const double FASTEST_ARROW = 0.20; /* the arrow of the first run's fastest body */
static const double COMMON_ARROW = 0.10;  /* the arrow of the 90th percentile of impulses */
static const double LEGEND_ARROW = 0.07;  /* an arrow in the legend, at most */
/* The same in boxes; the smaller counts. */
static const double MAX_ARROW_BOXES = 4, FASTEST_ARROW_BOXES = 3, COMMON_ARROW_BOXES = 1.2, LEGEND_ARROW_BOXES = 3.5;
static const double MAX_SPEED = 1e4; /* m/s; faster bodies, of an exploding run, do not count */
enum { MAX_DECADE = 1 };             /* 10 m, the end of the colour scale */

static double fastest(const Trajectory *run) {
    double square = 0;
    for (size_t i = 0; i < (size_t)run->frames * (size_t)run->bodies; i++) {
        double x = (double)run->velocity[i].x, y = (double)run->velocity[i].y, v = x * x + y * y;
        if (v > square && v < MAX_SPEED * MAX_SPEED) square = v;
    }
    return sqrt(square);
}

static int compare_floats(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* m: the median of the shorter sides of the dynamic bodies without the bomb; 1 without any. */
static bool median_box(const Trajectory *run, double *side, Error *error) {
    float *sides = malloc(((size_t)run->bodies + 1) * sizeof *sides);
    size_t count = 0;
    if (sides == NULL) return error_memory(error, "render");
    for (int body = 0; body < run->bodies; body++)
        if (!run->fixed[body] && body != run->bomb) sides[count++] = fminf(run->size[body].x, run->size[body].y);
    qsort(sides, count, sizeof *sides, compare_floats);
    *side = count > 0 ? (double)sides[count / 2] : 1;
    free(sides);
    return true;
}

/* Finds the 90th percentile of the positive impulses; 0 if there are none. */
static bool common_impulse(const Trajectory *run, double *impulse, Error *error) {
    size_t total = (size_t)run->contact_start[run->frames], count = 0;
    float *impulses = malloc((total + 1) * sizeof *impulses);
    if (impulses == NULL) return error_memory(error, "render");
    for (size_t i = 0; i < total; i++) {
        float normal = run->contacts[i].normal_impulse;
        if (normal > 0 && isfinite(normal)) impulses[count++] = normal;
    }
    qsort(impulses, count, sizeof *impulses, compare_floats);
    *impulse = count > 0 ? (double)impulses[count - 1 - count / 10] : 0;
    free(impulses);
    return true;
}

bool scales_measure(const Trajectory *run, ScaleMeasures *measures, Error *error) {
    measures->speed = fastest(run);
    return common_impulse(run, &measures->impulse, error) && median_box(run, &measures->box, error);
}

/* The largest 1, 2 or 5 times a power of ten that is at most `most`. */
static double round_number(double most) {
    double power = 1;
    while (power > most && power > 1e-12) power /= 10;
    while (10 * power <= most && power < 1e12) power *= 10;
    return most >= 5 * power ? 5 * power : most >= 2 * power ? 2 * power : power;
}

/* Sets the pixels per unit, and the value of the legend's arrow. */
static void choose(double *scale, double *legend, double value, double pixels, double max_legend) {
    *scale = value > 1e-9 ? pixels / value : pixels;
    *legend = round_number(max_legend / *scale);
}

bool scales_choose(Scales *scales, const Trajectory *run, const Layout *layout, double scale, double largest_distance,
                   Error *error) {
    Rect panel = layout->panels[0];
    double side = fmin(panel.right - panel.left, panel.bottom - panel.top);
    ScaleMeasures measures;
    if (!scales_measure(run, &measures, error)) return false;
    const double box = scales->box = scale * measures.box, legend = fmin(LEGEND_ARROW * side, LEGEND_ARROW_BOXES * box);
    scales->max_arrow = fmin(MAX_ARROW * side, MAX_ARROW_BOXES * box);
    choose(&scales->impulse, &scales->legend_impulse, measures.impulse,
           fmin(COMMON_ARROW * side, COMMON_ARROW_BOXES * box), legend);
    choose(&scales->velocity, &scales->legend_velocity, measures.speed,
           fmin(FASTEST_ARROW * side, FASTEST_ARROW_BOXES * box), legend);
    double power = 1;
    for (scales->last_decade = 0; power < largest_distance && scales->last_decade < MAX_DECADE; power *= 10)
        scales->last_decade++;
    scales->exceeded = power < largest_distance;
    return true;
}

double scales_share(const Scales *scales, double distance) {
    if (!(distance > 1e-3)) return 0;
    return fmin(1, (log10(distance) - SCALE_FIRST_DECADE) / (scales->last_decade - SCALE_FIRST_DECADE));
}
