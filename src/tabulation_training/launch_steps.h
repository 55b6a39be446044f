/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs launches by hybrid, one after the other, and keeps the steps that ask the memory. */
#pragma once
#include "impact_training/impact_problems.h"
#include "scene/launch.h"
#include "solvers/hybrid.h"

/* A step that asked the memory, with copies of all. */
typedef struct AskedStep {
    ContactProblem problem; /* its arrays are in `block`, as those of the solution */
    ContactSolution solution;
    uint64_t hash;
    float bomb[TABULATION_NUMBERS];
    float *others; /* [6 (body_count - 1)] */
    int entry;     /* that answered, or -1: the solution is converged */
    char *block;
} AskedStep;

/* Zero-initialise. */
typedef struct AskedSteps {
    AskedStep *items;
    int count;
    size_t capacity;
    int64_t steps;  /* of the launches so far, asked or not */
    double seconds; /* that the copies took */
} AskedSteps;

/* Empties the list and its sums; its array is kept for the next launch. */
void asked_steps_clear(AskedSteps *steps);
void asked_steps_free(AskedSteps *steps);

typedef struct LaunchSteps LaunchSteps;

/* Runs the scene up to its bomb, which it must have. NULL with error set. */
LaunchSteps *launch_steps_create(const Scene *scene, Error *error);
void launch_steps_destroy(LaunchSteps *runs);

/* Runs one launch up to `steps` steps from the bomb's first touch, and appends the asked ones. The memory, or NULL, is
   not changed. A launch ends if its state becomes NaN or infinite. */
bool launch_steps_run(LaunchSteps *runs, const Launch *launch, const Tabulation *memory, int steps, AskedSteps *asked,
                      Error *error);
