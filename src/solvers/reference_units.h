/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference's workspace: bodies and contacts in units in which every mass is 1, contacts in the order of the sweeps.
   Only reference.c and reference_load.c include this. */
#pragma once
#include "solvers/reference.h"

/* One direction of a contact, in units in which every mass is 1: velocities are times the root of the mass, impulses
   through the root of the contact's effective mass. There an impulse q changes the velocities by q times the row, and
   its own relative velocity, row * velocities, by q. */
typedef struct ReferenceRow {
    double a[3], b[3]; /* x, y, spin of the two bodies */
    double target;     /* the relative velocity that no impulse changes any more */
    double scale;      /* root of the effective mass, kg^(1/2): impulse in N s = scale q, velocity in m/s = q / scale */
} ReferenceRow;

struct ReferenceContact {
    int index, a, b; /* in the problem */
    ReferenceRow normal, tangent;
    double friction; /* of impulses in the units above */
};

/* Room for the problem. False when memory is short. */
bool reference_reserve(Reference *reference, const ContactProblem *problem);

/* Takes the problem in. */
void reference_load(Reference *reference, const ContactProblem *problem);

/* Sets the workspace to these impulses, or to the warm start where start is NULL, and the velocities that they give. */
void reference_start(Reference *reference, const ContactProblem *problem, const ContactImpulse *start);

/* Fills velocities and impulses of the result from the impulses of the workspace, without the rounding of many sweeps. */
void reference_hand_out(Reference *reference, const ContactProblem *problem);
