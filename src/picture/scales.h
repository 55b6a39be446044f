/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How long arrows are, and what colours mean: decided once for all panels and frames. */
#pragma once
#include "picture/layout.h"
#include "picture/look.h"
#include "trajectory/trajectory.h"

typedef struct Scales {
    double impulse, velocity;             /* pixels for 1 N s and 1 m/s */
    double named_impulse, named_velocity; /* round numbers for the legend */
    double longest;                       /* pixels; a longer arrow is cut to this, and has two heads */
    int last_decade;                      /* the colour scale ends at 10 to this power, in m */
    bool goes_beyond;                     /* some bodies are farther than that */
} Scales;

enum { SCALE_FIRST_DECADE = -3 }; /* and it begins here: a millimetre */

/* By the first run: `largest_apart` in m. False with error set when memory is short. */
bool scales_choose(Scales *scales, const Trajectory *run, const Layout *layout, double largest_apart, Error *error);

/* Where a distance (m) lies on the colour scale, 0 to 1; logarithmic. */
double scales_share(const Scales *scales, double distance);
