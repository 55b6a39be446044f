/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scalar reference implementation of sequential impulses. The vectorised sweeps (sweeps.h) must have its bits. */
#pragma once
#include "dynamics/contact_problem.h"

#include <stdbool.h>

typedef struct SequentialOptions {
    bool accumulate;  /* clamp accumulated impulses, not each impulse */
    bool warm;        /* start from the problem's warm-start impulses, not from zero */
    float relaxation; /* factor of every impulse; 1: none */
} SequentialOptions;

/* Sets velocities and impulses before the first sweep. */
void sequential_impulses_begin(const ContactProblem *problem, const SequentialOptions *options,
                               ContactSolution *solution);

/* Visits `count` contacts, from `first` on. */
void sequential_impulses_visit(const ContactProblem *problem, const SequentialOptions *options, int first, int count,
                               ContactSolution *solution);

/* One sweep. */
void sequential_impulses_sweep(const ContactProblem *problem, const SequentialOptions *options,
                               ContactSolution *solution);

/* Begins, then `count` sweeps. */
void sequential_impulses_solve(const ContactProblem *problem, const SequentialOptions *options, int count,
                               ContactSolution *solution);
