/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Differentiable momentum sweeps (methods/momentum.h, in colour order) in double: reverse-mode derivatives of a loss of
   the final velocities with respect to the start impulses and the momentum factors. A network that predicts the start
   of a solve can thus be trained on the result of the solve.

   A sweep is piecewise linear. The backward pass uses the piece that each visit took in the forward pass, so the
   derivative is exact, except at a kink, where it is that of one of the two pieces. Sources: Griewank and Walther,
   "Evaluating Derivatives" (2008), chapter 3 (reverse mode); Monga, Li, Eldar, "Algorithm Unrolling" (2021) (training
   through an unrolled solver).

   by_x denotes the derivative of the loss with respect to x.

       unrolled_problem_make(&rows, &problem);
       unrolled_run(&unrolled, &rows, start, factors, sweeps);
       unrolled_back(&unrolled, &rows, by_velocity, by_start, by_factors); */
#pragma once
#include "engine/engine.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* One contact point. `normal` and `tangent` are Jacobian rows: linear part for b (negated for a), angular part for a
   and for b. Their product with the velocities is the relative velocity of the contact point of b along the
   direction. */
typedef struct UnrolledContact {
    int a, b;
    double normal[4], tangent[4];     /* x, y, -cross(arm_a, direction), cross(arm_b, direction) */
    double mass_normal, mass_tangent; /* kg */
    double friction;
    double bias;     /* m/s */
    double coupling; /* tangential m/s caused by a normal impulse of 1 N s */
} UnrolledContact;

typedef struct UnrolledProblem {
    int body_count, contact_count;
    UnrolledContact *contacts; /* [contact_count] */
    int32_t *visits;           /* [contact_count] contacts in colour order */
    double *inv_mass;          /* [body_count] 1/kg */
    double *inv_inertia;       /* [body_count] 1/(kg m^2) */
    double *free;              /* [3 body_count] velocity x, y (m/s) and spin (rad/s) before any impulse */
} UnrolledProblem;

/* Free with unrolled_problem_free(). False if out of memory. */
bool unrolled_problem_make(UnrolledProblem *unrolled, const ContactProblem *problem);
void unrolled_problem_free(UnrolledProblem *problem);

/* Work space of a thread. Zero-initialise; arrays grow and are reused. A state is velocities [3 body_count], then
   impulses [2 contact_count]. */
typedef struct Unrolled {
    double *velocities; /* [3 body_count] result of unrolled_run(), in `states` */
    double *impulses;   /* [2 contact_count] N s, normal and tangent of each contact, in `states` */
    int sweeps;
    double *states;   /* [sweeps + 1, state] the start, and after each sweep */
    uint8_t *pieces;  /* [sweeps + 1, contact_count] pieces of the start's projection and of each visit */
    double *factors;  /* [sweeps] */
    double *adjoints; /* [2, state] */
    size_t state_capacity, piece_capacity, factor_capacity, adjoint_capacity;
} Unrolled;

void unrolled_free(Unrolled *unrolled);

/* Projects start[2 contact_count] (N s, normal and tangent of each contact) into the friction cone (Pn = max(Pn, 0),
   Pt = clamp(Pt, -mu Pn, mu Pn)), then runs sweeps >= 0 sweeps. factors[s] extrapolates before sweep s; factors[0] is
   ignored. False if out of memory. */
bool unrolled_run(Unrolled *unrolled, const UnrolledProblem *problem, const double *start, const double *factors,
                  int sweeps);

/* Backward pass, after unrolled_run() of the same problem; may be repeated. by_velocity[3 body_count] refers to the
   final velocities. Writes by_start[2 contact_count] and adds to by_factors[sweeps], if by_factors != NULL. */
void unrolled_back(Unrolled *unrolled, const UnrolledProblem *problem, const double *by_velocity, double *by_start,
                   double *by_factors);
