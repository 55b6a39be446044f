/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scales of arrows and colours, chosen once for all panels and frames. */
#pragma once
#include "picture/layout.h"
#include "picture/look.h"
#include "trajectory/trajectory.h"

typedef struct Scales {
    double box;                             /* pixels, shorter side of the median box of the first run */
    double impulse, velocity;               /* pixels per N s and per m/s */
    double legend_impulse, legend_velocity; /* the values of the legend's arrows, round numbers */
    double max_arrow;                       /* pixels; a longer arrow is truncated to this length and has two heads */
    int last_decade;                        /* the colour scale ends at 10^last_decade m */
    bool exceeded;                          /* some distances exceed the end */
} Scales;

/* What the scales follow from. */
typedef struct ScaleMeasures {
    double impulse; /* N s, 90th percentile of the positive impulses; 0: no contacts */
    double speed;   /* m/s, of the fastest body */
    double box;     /* m, shorter side of the median box */
} ScaleMeasures;

/* False with error set if out of memory. */
bool scales_measure(const Trajectory *run, ScaleMeasures *measures, Error *error);

enum { SCALE_FIRST_DECADE = -3 }; /* the colour scale begins at 1 mm */

/* From the first run; `scale` in pixels per metre, `largest_distance` in m. Arrows are in proportion to the panel, but to
   its boxes where these are small, or they would cover them. False with error set if out of memory. */
bool scales_choose(Scales *scales, const Trajectory *run, const Layout *layout, double scale, double largest_distance,
                   Error *error);

/* Position of a distance (m) on the logarithmic colour scale, 0 to 1. */
double scales_share(const Scales *scales, double distance);
