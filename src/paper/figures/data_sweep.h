/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The launches in figure 3, and the training row that it shows from one of them. */
#pragma once
#include "sketch/sketch.h"

#include "pair/pair.h"
#include "scene/scene.h"

/* Every 10th launch of the paper's sweep (3.3) is shown. The row is from the launch where the bomb hits the edge of the
   highest box, pushes it down and turns it. */
enum { SWEEP_LAUNCHES = 201, SWEEP_SHOWN_EVERY = 10, SWEEP_ROW_LAUNCH = 120 };

/* x of launch i, m */
float sweep_x(int i);

/* The pair of the bomb and a movable box, at the bomb's first touch. */
typedef struct SweepRow {
    int step, bodies[2], bomb;
    Box boxes[2];
    float inputs[PAIR_INPUTS], changes[PAIR_CHANGES]; /* pair_inputs() with PAIR_RELATIVE; pair_changes() */
} SweepRow;

/* Runs the launches shown to their end, and draws the bomb's path up to its first touch over the scene's initial state.
   *rows: touching pairs, summed over all steps. ERROR_INPUT if the launch of the row touches no box. */
bool sweep_draw(Sketch *sketch, const View *view, const Scene *scene, SweepRow *row, int *rows, Error *error);
