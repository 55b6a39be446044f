/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/scales.h"

#include <math.h>
#include <stdlib.h>

/* Shares of a panel's shorter side. */
static const double LONGEST = 0.28;
static const double FASTEST = 0.20;        /* the arrow of the first run's fastest body */
static const double COMMON_IMPULSE = 0.10; /* the arrow of an impulse that 9 in 10 are below */
static const double NAMED = 0.07;          /* an arrow in the legend, at most */
static const double FASTEST_COUNTED = 1e4; /* m/s; what explodes is no measure */
enum { MOST_DECADE = 1 };                  /* 10 m: what is farther is just gone */

static double fastest(const Trajectory *run) {
    double square = 0;
    for (size_t i = 0; i < (size_t)run->frames * (size_t)run->bodies; i++) {
        double x = (double)run->velocity[i].x, y = (double)run->velocity[i].y, v = x * x + y * y;
        if (v > square && v < FASTEST_COUNTED * FASTEST_COUNTED) square = v;
    }
    return sqrt(square);
}

static int compare_floats(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* An impulse that 9 in 10 of those that push are below; 0 where none does. */
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

/* The largest 1, 2 or 5 times a power of ten that is not above. */
static double round_number(double most) {
    double power = 1;
    while (power > most && power > 1e-12) power /= 10;
    while (10 * power <= most && power < 1e12) power *= 10;
    return most >= 5 * power ? 5 * power : most >= 2 * power ? 2 * power : power;
}

/* Pixels for one unit, and the arrow that the legend shows. */
static void choose(double *scale, double *named, double value, double pixels, double most_named) {
    *scale = value > 1e-9 ? pixels / value : pixels;
    *named = round_number(most_named / *scale);
}

bool scales_choose(Scales *scales, const Trajectory *run, const Layout *layout, double largest_apart, Error *error) {
    Rect panel = layout->panels[0];
    double side = fmin(panel.right - panel.left, panel.bottom - panel.top), impulse = 0;
    if (!common_impulse(run, &impulse, error)) return false;
    scales->longest = LONGEST * side;
    choose(&scales->impulse, &scales->named_impulse, impulse, COMMON_IMPULSE * side, NAMED * side);
    choose(&scales->velocity, &scales->named_velocity, fastest(run), FASTEST * side, NAMED * side);
    double power = 1;
    for (scales->last_decade = 0; power < largest_apart && scales->last_decade < MOST_DECADE; power *= 10)
        scales->last_decade++;
    scales->goes_beyond = power < largest_apart;
    return true;
}

double scales_share(const Scales *scales, double distance) {
    if (!(distance > 1e-3)) return 0;
    return fmin(1, (log10(distance) - SCALE_FIRST_DECADE) / (scales->last_decade - SCALE_FIRST_DECADE));
}
