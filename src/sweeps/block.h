/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scalar reference implementation of the block solver (block.c), and its data for the two points of a pair. */
#pragma once
#include "dynamics/contact_problem.h"

/* K of two normals, 1/kg: K x is the change of the two normal velocities by the normal impulses x. */
typedef struct Block {
    float k11, k12, k22;
    float inverse_determinant; /* kg^2; 0 if the points are solved separately */
} Block;

/* first, second: points of the same pair. They are solved separately if K is ill-conditioned. */
Block block_make(const ContactPoint *first, const ContactPoint *second, const ProblemBody *bodies);

/* One sweep over all contacts. */
void block_sweep(const ContactProblem *problem, ContactSolution *solution);

/* `count` sweeps, after the warm start. */
void block_solve(const ContactProblem *problem, int count, ContactSolution *solution);
