/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The log of a run, to compare it with another run of the same launch. */
#pragma once
#include "scene/scene.h"
#include "simulate/phases.h"

#include <stddef.h>

/* Zero-initialise; arrays grow and are reused. Bodies are those of the scene, without the bomb. */
typedef struct RunLog {
    int bodies, frames;          /* frames: the last one logged */
    int touch;                   /* first step in which the bomb touched, 0: none */
    int launch_frame, end_frame; /* the bomb's, and the one 5 s later, where boxes that moved are counted */
    Vec2 *position;              /* [frames + 1, bodies] m */
    double *energy;              /* [frames + 1] J: kinetic and potential, of all moving bodies */
    double *penetration;         /* [frames + 1] m: of the deepest contact of the step; 0 without one */
    Phase *phase;                /* [frames + 1] of each step */
    size_t position_capacity, energy_capacity, penetration_capacity, phase_capacity;
} RunLog;

void run_log_free(RunLog *log);

/* Begins the log of a run of the scene. False when memory is short. */
bool run_log_begin(RunLog *log, const Scene *scene, const World *world);

/* Adds a step. */
void run_log_step(RunLog *log, const Scene *scene, const World *world, int frame, Phase phase);

/* Figures of a run compared with the converged run of the same launch; NAN if there is nothing to compare. */
typedef struct RunFigures {
    double penetration[PHASES]; /* m: the largest of the phase */
    double energy[PHASES];      /* J above the converged run's at the same frame, mean over the phase */
    double drift; /* m: mean distance of the boxes from the converged run's, just before the bomb touches in either */
    double moved; /* boxes that moved more than 0.5 m in the 5 s after the launch */
} RunFigures;

RunFigures run_figures(const RunLog *log, const RunLog *converged, const Scene *scene);
