/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The converged solution of a contact problem, in double: what the solvers are scored against.

   It solves the problem that sequential impulses approach: every contact pushes just enough to bring its normal
   velocity to the bias, or not at all, and rubs with at most mu times that push against its sliding. */
#pragma once
#include "common/error.h"
#include "dynamics/contact_problem.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct ReferenceVelocity {
    double x, y, spin; /* m/s, rad/s */
} ReferenceVelocity;

typedef struct ReferenceImpulse {
    double normal, tangent; /* N s, as ContactImpulse */
} ReferenceImpulse;

typedef struct ReferenceContact ReferenceContact;

/* Zero-initialise; arrays grow and are reused. The results are those of the last solve. */
typedef struct Reference {
    ReferenceVelocity *velocities; /* [body_count] */
    ReferenceImpulse *impulses;    /* [contact_count] */
    double residual;               /* m/s: the largest change of a contact's relative velocity, normal or tangent,
                                      that one more plain sweep makes: |change of impulse| / effective mass */
    int sweeps;                    /* over all contacts, that it took */
    /* workspace */
    int body_count, contact_count;
    ReferenceContact *contacts;                                /* [contact_count] */
    ReferenceVelocity *velocities_before, *velocity_direction; /* [body_count] */
    ReferenceImpulse *impulses_before, *direction;             /* [contact_count] */
    size_t body_capacity[3], contact_capacity[4];
} Reference;

/* The residual at which a solve stops, and the most sweeps it may take to get there. */
#define REFERENCE_TOLERANCE 1e-5 /* m/s */
enum { REFERENCE_MAX_SWEEPS = 10000 };

void reference_free(Reference *reference);

/* Solves until the residual is at most `tolerance` or `max_sweeps` are done. start: impulses to begin with
   [contact_count]; NULL: the problem's warm start. A solve that does not get there is no error: `residual` says how
   far it got. False only when memory is short. */
bool reference_solve(Reference *reference, const ContactProblem *problem, double tolerance, int max_sweeps,
                     const ContactImpulse *start, Error *error);
