/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run of a method in closed loop: each step starts from the result of the last one, and is scored against the
   converged solution of the same step. */
#pragma once
#include "common/error.h"
#include "reference/reference.h"
#include "simulate/method.h"
#include "study/run_log.h"

/* Scores of steps. Zero-initialise; free with step_scores_free. */
typedef struct StepScores {
    int count;
    double *error; /* [count] m/s, RMS over the bodies that move */
    double *share; /* [count] share of the bodies whose velocity is right */
    size_t error_capacity, share_capacity;
} StepScores;

/* Adds a step, from its end velocities. False when memory is short. */
bool step_scores_add(StepScores *scores, const ContactProblem *problem, const BodyVelocity *velocities,
                     const ReferenceVelocity *reference);
void step_scores_free(StepScores *scores);

/* All impact frames are scored, and one in so many of the others: a reference solve costs more than everything else. */
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

/* m/s: far below the errors compared. Only states that a bad method has blown up do not converge to it. */
#define SOLVE_CONVERGED 1e-3

void rollout_free(Rollout *rollout);

/* Runs a launched scene, and adds the sampled steps to scores[PHASES] (NULL: none). A run whose state becomes NaN or
   infinite ends there, with a shorter log. False with error set when memory is short. */
bool rollout_run(Rollout *rollout, Stepper *stepper, const Scene *launched, const Sampling *sampling,
                 StepScores scores[PHASES], Error *error);
