/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The launches that figure 3 shows, and the row that it takes from one of them. */
#pragma once
#include "sketch/sketch.h"

#include "pair/pair.h"
#include "scene/scene.h"

/* Of the paper's sweep (3.3) every so many launches are shown. The row is of the one where the bomb hits the edge of the
   highest box, which it pushes down and turns. */
enum { SWEEP_LAUNCHES = 201, SWEEP_SHOWN_EVERY = 10, SWEEP_ROW_LAUNCH = 120 };

/* m, of launch i */
float sweep_x(int i);

/* A pair of the bomb and a box that can move, at the bomb's first touch. */
typedef struct SweepRow {
    int step, bodies[2], bomb;
    Box boxes[2];
    float inputs[PAIR_INPUTS], changes[PAIR_CHANGES]; /* pair_inputs(), relative, and pair_changes() */
} SweepRow;

/* Runs the launches shown, to the end, and draws the bomb's ways to its first touch over the scene at its start. rows:
   touching pairs in all their steps. ERROR_INPUT where the row's launch touches no box. */
bool put_sweep(Sketch *sketch, const View *view, const Scene *scene, SweepRow *row, int *rows, Error *error);
