/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sweeps with momentum (solvers/momentum.h, in the order of colours) in double, and their derivative: how a loss of the
   velocities after so many sweeps changes with the impulses that they start from, and with their factors. So what
   predicts the start of a solve can be trained on where the solve ends.

   A sweep is piecewise linear. The way back takes at each visit the piece that the way there took, so the derivative is
   exact but where a clamp stands on its edge; there it is that of one of the two pieces. Source of going back through
   an iteration step by step: Griewank and Walther, "Evaluating Derivatives" (2008), chapter 3; of doing so through a
   solver to train what comes before it: Monga, Li, Eldar, "Algorithm Unrolling" (2021). */
#pragma once
#include "dynamics/contact_problem.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* One contact point. A row holds what an impulse of 1 along a direction does before it is divided by masses: to the
   velocity of b (that of a: the opposite), spin of a, spin of b. The product with the velocities is how fast b's
   point leaves a's along that direction. */
typedef struct UnrolledContact {
    int a, b;
    double normal[4], tangent[4];     /* x, y, -cross(arm_a, direction), cross(arm_b, direction) */
    double mass_normal, mass_tangent; /* kg */
    double friction;
    double bias;     /* m/s */
    double coupling; /* m/s along the tangent for each N s along the normal */
} UnrolledContact;

typedef struct UnrolledProblem {
    int body_count, contact_count;
    UnrolledContact *contacts; /* [contact_count] */
    int32_t *visits;           /* [contact_count] the contacts in the order of visits */
    double *inv_mass;          /* [body_count] 1/kg */
    double *inv_inertia;       /* [body_count] 1/(kg m^2) */
    double *free;              /* [3 body_count] x, y (m/s), spin (rad/s) of each body before any impulse */
} UnrolledProblem;

/* One block of memory, which unrolled_problem_free() gives back. False when memory is short. */
bool unrolled_problem_make(UnrolledProblem *unrolled, const ContactProblem *problem);
void unrolled_problem_free(UnrolledProblem *problem);

/* Work space of a thread. Zero-initialise; arrays grow and are reused. A state is the velocities [3 body_count] and then
   the impulses [2 contact_count]. */
typedef struct Unrolled {
    double *velocities; /* [3 body_count] after unrolled_run; lie in `states`, as the impulses do */
    double *impulses;   /* [2 contact_count] N s along normal and tangent, of each contact */
    int sweeps;
    double *states;   /* [sweeps + 1, state] the start, and after each sweep */
    uint8_t *pieces;  /* [sweeps + 1, contact_count] which piece the start's projection and each visit took */
    double *factors;  /* [sweeps] */
    double *adjoints; /* [2, state] on the way back */
    size_t state_capacity, piece_capacity, factor_capacity, adjoint_capacity;
} Unrolled;

void unrolled_free(Unrolled *unrolled);

/* Brings start [2 contact_count] (N s along normal and tangent of each contact; any numbers) into the friction cone,
   Pn = max(Pn, 0), Pt = clamp(Pt, -mu Pn, mu Pn), and sweeps from there, with factors[s] before sweep s (0: no sweep
   before it, so no effect). sweeps >= 0. False when memory is short. */
bool unrolled_run(Unrolled *unrolled, const UnrolledProblem *problem, const double *start, const double *factors,
                  int sweeps);

/* After unrolled_run of the same problem, any number of times: by_velocity [3 body_count] is the derivative of a loss by
   the velocities after the last sweep. Writes that by the start to by_start [2 contact_count] and adds that by the
   factors to by_factors [sweeps], if not NULL. */
void unrolled_back(Unrolled *unrolled, const UnrolledProblem *problem, const double *by_velocity, double *by_start,
                   double *by_factors);
