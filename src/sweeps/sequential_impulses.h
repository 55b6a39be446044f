/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plain text of sequential impulses, contact by contact: what the fast sweeps (sweeps.h) are held to. */
#pragma once
#include "dynamics/contact_problem.h"

#include <stdbool.h>

typedef struct SequentialOptions {
    bool accumulate;  /* clamp the sum of impulses, from the warm start on, not each one */
    bool warm;        /* start from the problem's warm impulses, not from zero */
    float relaxation; /* of every step; 1: none */
} SequentialOptions;

/* Velocities and impulses before the first sweep. */
void sequential_impulses_begin(const ContactProblem *problem, const SequentialOptions *options,
                               ContactSolution *solution);

/* Once over the contacts from `first` on, `count` of them. */
void sequential_impulses_visit(const ContactProblem *problem, const SequentialOptions *options, int first, int count,
                               ContactSolution *solution);

/* Once over all contacts. */
void sequential_impulses_sweep(const ContactProblem *problem, const SequentialOptions *options,
                               ContactSolution *solution);

/* `count` sweeps from the beginning. */
void sequential_impulses_solve(const ContactProblem *problem, const SequentialOptions *options, int count,
                               ContactSolution *solution);
