/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A moment within a step, as pairs see it: velocities and impulses so far, and what the contacts around would do next. */
#pragma once
#include "dynamics/contact_problem.h"

#include <stdbool.h>
#include <stddef.h>

/* Zero-initialise; arrays grow and are reused. */
typedef struct PairMoment {
    BodyVelocity *velocities; /* [body_count] */
    ContactImpulse *impulses; /* [contact_count] so far */
    /* filled by pair_moment_look(): */
    ContactImpulse *alone; /* [contact_count] what each contact would add if it were the only one */
    BodyVelocity *pushes;  /* [body_count] what these would change of each body, all together */
    size_t velocity_capacity, impulse_capacity, alone_capacity, push_capacity;
} PairMoment;

void pair_moment_free(PairMoment *moment);

/* Makes room for a problem; the caller fills velocities and impulses. False when memory is short. */
bool pair_moment_reserve(PairMoment *moment, const ContactProblem *problem);

/* The velocities and impulses as a solution to be filled in. */
ContactSolution pair_moment_solution(const PairMoment *moment);

/* Lets every contact look: one visit each, all from these same velocities (a sweep of Jacobi's). */
void pair_moment_look(PairMoment *moment, const ContactProblem *problem);

/* Of these pushes, those by other pairs than the one whose contacts begin at `first`, on one of its two bodies. */
BodyVelocity pair_moment_others(const PairMoment *moment, const ContactProblem *problem, int first, int body);
