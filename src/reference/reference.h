/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The converged solution of a contact problem, in double: what the solvers are scored against.

   It solves the problem that sequential impulses approach: every contact pushes just enough to bring its normal
   velocity to the bias, or not at all, and rubs with at most mu times that push against its sliding. */
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

/* Zero-initialise; arrays grow and are reused. The results are those of the last solve. */
typedef struct Reference {
    ReferenceVelocity *velocities; /* [body_count] */
    ReferenceImpulse *impulses;    /* [contact_count] */
    double residual;               /* m/s: the largest change of a contact's relative velocity, normal or tangent,
                                      that one more plain sweep makes: |change of impulse| / effective mass */
    int sweeps;                    /* over all contacts, that it took */
    bool plain;                    /* to be set: no vectors of the processor; slower, with the same bits */
    /* workspace, in units in which every mass is 1, pairs of bodies in the order of the sweeps */
    int body_count, group_count;
    ReferenceGroup *groups;                                          /* [group_count] */
    ReferenceMomentum *momenta, *momenta_before, *momenta_direction; /* [body_count + 1] one after the other */
    ReferenceNumbers *sums, *sums_before, *steps, *direction;        /* [group_count] in `numbers` */
    ReferenceNumbers *numbers;                                       /* [4, group_count] */
    int *rounds;     /* [contact_count] while loading: the round of the sweep that visits the pair */
    uint64_t *taken; /* [body_count] while loading: a bit for each round that visits the body */
    size_t velocity_capacity, impulse_capacity, group_capacity, momenta_capacity, number_capacity, round_capacity,
        taken_capacity;
} Reference;

/* The residual at which a solve stops, and the most visits of contacts that it may take to get there: 120,000 sweeps of
   scenes/stack, 9,000 of scenes/pyramid_settled. On the stack's impacts all solves get there, in 0.1 ms (mean), and
   velocities are within 6e-6 m/s (RMS, median) and 5e-5 m/s (95%) of those after fifty times the visits; at rest, within
   9e-5 m/s in both scenes. Of the pyramid's impacts six in ten end at the last visit, after 10 ms, 3e-4 m/s (median) and
   0.014 m/s (95%) away: loads that can pass in many ways creep from one to another. Half the visits leave 1e-3 m/s
   (median), two and a half times as many 9e-5 m/s (median) and 0.007 m/s (95%). Where fifty times the visits end
   depends on the start, by up to 4e-3 m/s. */
#define REFERENCE_TOLERANCE 1e-5 /* m/s */
enum { REFERENCE_MAX_VISITS = 2000000 };

void reference_free(Reference *reference);

/* Solves until the residual is at most `tolerance` or `max_visits` of contacts are done (two sweeps at least). start:
   impulses to begin with [contact_count]; NULL: the problem's warm start. A solve that does not get there is no error:
   `residual` says how far it got. False only when memory is short. */
bool reference_solve(Reference *reference, const ContactProblem *problem, double tolerance, int max_visits,
                     const ContactImpulse *start, Error *error);

/* The residual of a method's own impulses [contact_count], whatever velocities it found. False when memory is short. */
bool reference_residual(Reference *reference, const ContactProblem *problem, const ContactImpulse *impulses,
                        double *residual, Error *error);
