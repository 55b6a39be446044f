/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run of a method in closed loop: each step from the state that the method's last one left, scored against the
   converged solution of that same step. */
#pragma once
#include "common/error.h"
#include "reference/reference.h"
#include "simulate/method.h"
#include "study/run_log.h"

/* Of the steps scored. Zero-initialise; freed by step_scores_free. */
typedef struct StepScores {
    int count;
    double *error; /* [count] m/s, RMS over the bodies that move */
    double *share; /* [count] of the bodies right */
    size_t error_capacity, share_capacity;
} StepScores;

/* Adds one step, by its end velocities. False when memory is short. */
bool step_scores_add(StepScores *scores, const ContactProblem *problem, const BodyVelocity *velocities,
                     const ReferenceVelocity *reference);
void step_scores_free(StepScores *scores);

/* Impact frames are all scored, of the others every so many: a reference solve costs more than all the rest. */
typedef struct Sampling {
    int after, rest;
} Sampling;

bool sampled(const Sampling *sampling, Phase phase, const PhaseTracker *tracker, int frame);

/* One thread's run in progress; zero-initialise, free with rollout_free. */
typedef struct Rollout {
    World *world;
    Reference reference;
    RunLog log;
    int solves, unconverged; /* reference solves made; those that left a residual above SOLVE_CONVERGED */
} Rollout;

/* m/s: far below what is told apart. What does not get there are states that a bad method has blown up. */
#define SOLVE_CONVERGED 1e-3

void rollout_free(Rollout *rollout);

/* Runs a launched scene; scores[PHASES] get the steps that are sampled (NULL: none). A run whose state leaves the finite
   numbers ends there: its log is shorter. False with error set when memory is short. */
bool rollout_run(Rollout *rollout, Stepper *stepper, const Scene *launched, const Sampling *sampling,
                 StepScores scores[PHASES], Error *error);
