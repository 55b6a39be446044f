/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A closed-loop run of a method; each step is scored against its own converged solution. */
#pragma once
#include "common/error.h"
#include "study/converged_step.h"
#include "study/run_log.h"

/* Where the error of a scored step is largest. */
typedef struct StepPlace {
    int frame, body; /* body -1: none */
} StepPlace;

/* Errors of the scored steps. Zero-initialise; free with step_scores_free(). */
typedef struct StepScores {
    int count;
    double *error;    /* [count] m/s, RMS over the dynamic bodies */
    double *share;    /* [count] share of bodies that are right (solution_error.h) */
    StepPlace *place; /* [count] */
    size_t error_capacity, share_capacity, place_capacity;
} StepScores;

/* Adds the step to `frame`, given its final velocities. False if out of memory. */
bool step_scores_add(StepScores *scores, int frame, const ContactProblem *problem, const BodyVelocity *velocities,
                     const ReferenceVelocity *reference);
void step_scores_free(StepScores *scores);

/* All impact frames are scored; of the frames after and at rest, every n-th: reference solves dominate the run time. */
typedef struct Sampling {
    int after, rest;
} Sampling;

bool sampling_takes(const Sampling *sampling, Phase phase, const PhaseTracker *tracker, int frame);

/* One thread's run in progress; zero-initialise, free with rollout_free. */
typedef struct Rollout {
    World *world;
    ConvergedStep converged;
    RunLog log;
    int solves, unconverged; /* reference solves; those with a residual above SOLVE_CONVERGED */
} Rollout;

/* m/s, far below the differences between methods. Only states that a bad method made explode, and steps without a
   solution (reference/reference.h), do not reach it. */
#define SOLVE_CONVERGED 1e-3

void rollout_free(Rollout *rollout);

/* Runs a launched scene and adds the sampled steps to scores[PHASES] (NULL: none). If the state becomes NaN or
   infinite, the run ends early and its log is shorter. False with error set if out of memory. */
bool rollout_run(Rollout *rollout, Stepper *stepper, const Scene *launched, const Sampling *sampling,
                 StepScores scores[PHASES], Error *error);
