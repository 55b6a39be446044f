/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The state within a step between two sweeps: velocities and impulses so far, and one Jacobi sweep from there. */
#pragma once
#include "dynamics/contact_problem.h"

#include <stdbool.h>
#include <stddef.h>

/* Zero-initialise; arrays grow and are reused. */
typedef struct PairMoment {
    BodyVelocity *velocities; /* [body_count] */
    ContactImpulse *impulses; /* [contact_count] so far */
    /* filled by pair_moment_jacobi(): */
    ContactImpulse *alone; /* [contact_count] added by each contact alone */
    BodyVelocity *pushes;  /* [body_count] change of each body by all of these */
    size_t velocity_capacity, impulse_capacity, alone_capacity, push_capacity;
} PairMoment;

void pair_moment_free(PairMoment *moment);

/* Reserves memory for a problem; the caller fills velocities and impulses. False when memory is short. */
bool pair_moment_reserve(PairMoment *moment, const ContactProblem *problem);

/* The velocities and impulses as a solution for a solver to fill. */
ContactSolution pair_moment_solution(const PairMoment *moment);

/* One Jacobi sweep: visits every contact once, all from the same velocities. */
void pair_moment_jacobi(PairMoment *moment, const ContactProblem *problem);

/* Of `pushes`, the part by other pairs than the one whose contacts begin at `first`, on one of its two bodies. */
BodyVelocity pair_moment_others(const PairMoment *moment, const ContactProblem *problem, int first, int body);
