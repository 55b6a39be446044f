/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plain text of the block solver, pair by pair (block.c), and what it needs of two points that a pair shares. */
#pragma once
#include "dynamics/contact_problem.h"

/* K of two normals, 1/kg: K x is the change of the two normal velocities by the normal impulses x. */
typedef struct Block {
    float k11, k12, k22;
    float inverse_determinant; /* kg^2; 0 where the points are solved one by one */
} Block;

/* first, second: points of the same pair. One by one where K is so close to singular that its inverse is noise. */
Block block_make(const ContactPoint *first, const ContactPoint *second, const ProblemBody *bodies);

/* Sweeps `count` times over the contacts, from the warm start on. */
void block_solve(const ContactProblem *problem, int count, ContactSolution *solution);
