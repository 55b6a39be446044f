/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Errors and times of a memory on launches that it has not learned. */
#pragma once
#include "scene/scene.h"
#include "tabulation/tabulation.h"

typedef struct HybridTimes HybridTimes;

/* The scene must outlive it; steps: of each launch, from the first touch. NULL with error set. */
HybridTimes *hybrid_times_create(const Scene *scene, int steps, uint64_t seed, bool quick, Error *error);
void hybrid_times_destroy(HybridTimes *times);

/* As in HybridRow; NAN where no step is answered, or none is not. */
typedef struct HybridMeasures {
    double error, error_95;
    double us_answer, us_solve, us_question, us_step, us_step_solve;
} HybridMeasures;

/* Runs some launches with the memory, then solves each step with an impact in turns by hybrid and by interior:near=0.001,
   with medians over repetitions. turned: with a random rotation and spin. */
bool hybrid_measure(HybridTimes *times, const Tabulation *memory, bool turned, HybridMeasures *measures, Error *error);
