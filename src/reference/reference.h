/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The converged solution of a contact problem, in double. Errors of solvers are measured against it.

   It is the fixed point of sequential impulses: for every contact, the normal velocity equals the bias and the normal
   impulse is positive, or the impulse is 0 and the velocity exceeds the bias; the tangent impulse opposes sliding,
   within the friction cone. */
#pragma once
#include "common/error.h"
#include "dynamics/contact_problem.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct ReferenceVelocity {
    double x, y, spin; /* m/s, rad/s */
} ReferenceVelocity;

typedef struct ReferenceImpulse {
    double normal, tangent; /* N s, as ContactImpulse */
} ReferenceImpulse;

typedef struct ReferenceGroup ReferenceGroup;
typedef struct ReferenceNumbers ReferenceNumbers;
typedef struct ReferenceMomentum ReferenceMomentum;

/* Zero-initialise; arrays grow and are reused. Holds the results of the last solve. residual: the largest change of a
   contact's relative velocity, normal or tangent, by one more sweep without conjugate gradients: |change of impulse| /
   effective mass. */
typedef struct Reference {
    ReferenceVelocity *velocities; /* [body_count] */
    ReferenceImpulse *impulses;    /* [contact_count] */
    double residual;               /* m/s */
    int sweeps;                    /* over all contacts, used */
    bool scalar;                   /* set by the caller: no vector instructions; slower, with the same bits */
    /* workspace, in units in which every mass is 1, pairs of bodies in the order of the sweeps */
    int body_count, group_count;
    ReferenceGroup *groups;                                          /* [group_count] */
    ReferenceMomentum *momenta, *momenta_before, *momenta_direction; /* [body_count + 1] one after the other */
    ReferenceNumbers *sums, *sums_before, *steps, *direction;        /* [group_count] in `numbers` */
    ReferenceNumbers *numbers;                                       /* [4, group_count] */
    int *rounds;     /* [contact_count] while loading: the colour of the contact's pair */
    uint64_t *taken; /* [body_count] while loading: one bit per colour of the body's pairs */
    size_t velocity_capacity, impulse_capacity, group_capacity, momenta_capacity, number_capacity, round_capacity,
        taken_capacity;
} Reference;

/* The residual at which a solve stops, and the largest number of visits: 120,000 sweeps of scenes/stack, 9,000 of
   scenes/pyramid_settled. All solves of the stack's impacts reach the tolerance, in 0.1 ms (mean), with velocities
   within 6e-6 m/s (RMS, median) and 5e-5 m/s (95%) of those after fifty times the visits; at rest, within 9e-5 m/s in
   both scenes. Six in ten of the pyramid's impacts end at the last visit, after 10 ms, with errors of 3e-4 m/s (median)
   and 0.014 m/s (95%): redundant contacts drift slowly. Half the visits leave 1e-3 m/s (median), two and a half times
   as many 9e-5 m/s (median) and 0.007 m/s (95%). The result after fifty times the visits depends on the start by up to
   4e-3 m/s. */
#define REFERENCE_TOLERANCE 1e-5 /* m/s */
enum { REFERENCE_MAX_VISITS = 2000000 };

void reference_free(Reference *reference);

/* Solves until the residual is at most `tolerance` or after `max_visits` visits (at least two sweeps). start: initial
   impulses [contact_count]; NULL: the problem's warm start. Not to reach the tolerance is not an error; see `residual`.
   False only when memory is short. */
bool reference_solve(Reference *reference, const ContactProblem *problem, double tolerance, int max_visits,
                     const ContactImpulse *start, Error *error);

/* The residual of a method's impulses [contact_count]; its velocities do not count. False when memory is short. */
bool reference_residual(Reference *reference, const ContactProblem *problem, const ContactImpulse *impulses,
                        double *residual, Error *error);
