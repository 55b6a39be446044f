/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Log of a run, for comparison with another run of the same launch. */
#pragma once
#include "scene/scene.h"
#include "simulate/phases.h"

#include <stddef.h>

/* Zero-initialise; arrays grow and are reused. Bodies exclude the bomb. */
typedef struct RunLog {
    int bodies, frames;          /* frames: index of the last logged frame */
    int touch;                   /* first step in which the bomb touches; 0: none */
    int launch_frame, end_frame; /* the bomb's frame, and 5 s later: displaced boxes are counted between them */
    Vec2 *position;              /* [frames + 1, bodies] m */
    double *energy;              /* [frames + 1] J: mechanical energy of all dynamic bodies */
    double *penetration;         /* [frames + 1] m: deepest contact of the step; 0 without contacts */
    Phase *phase;                /* [frames + 1] of each step */
    Vec2 *bomb;                  /* [frames + 1] m: the bomb's position; 0 before it is there */
    double momentum_error;       /* N s: momentum created by steps (ContactSolution), sum */
    int fallen_back;             /* steps with discarded outputs, beyond training or solved by sweeps */
    size_t position_capacity, energy_capacity, penetration_capacity, phase_capacity, bomb_capacity;
} RunLog;

void run_log_free(RunLog *log);

/* Begins the log of a run of the scene. False if out of memory. */
bool run_log_begin(RunLog *log, const Scene *scene, const World *world);

void run_log_step(RunLog *log, const Scene *scene, const World *world, int frame, Phase phase);

/* The first frame in which a body, the bomb included, is more than `limit` m from its place in another run of the same
   launch; if the log ended early (NaN or infinite), at the latest the frame after its last; `frames` if never. */
int run_log_apart(const RunLog *log, const RunLog *other, double limit, int frames);

/* Boxes that moved more than 0.5 m in the 5 s after the launch; all if the log ended early. */
double run_log_moved(const RunLog *log, const Scene *scene);

/* A run compared with the converged run of the same launch; NaN if a phase does not occur. */
typedef struct RunMeasures {
    double penetration[PHASES]; /* m: largest of the phase */
    double energy[PHASES];      /* J: excess over the converged run at the same frame, mean over the phase */
    double drift; /* m: mean distance of the boxes from the converged run, just before the bomb touches in either run */
    double moved; /* boxes that moved more than 0.5 m in the 5 s after the launch */
} RunMeasures;

RunMeasures run_measures(const RunLog *log, const RunLog *converged, const Scene *scene);
