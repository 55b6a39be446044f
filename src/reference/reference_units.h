/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference's workspace: bodies and contacts in units in which every mass is 1, pairs of bodies in groups whose
   visits commute, one pair a lane. Only the files of the reference include this. */
#pragma once
#include "reference/reference.h"

#include <math.h>

enum {
    REFERENCE_LANES = 4,  /* pairs in a group */
    REFERENCE_POINTS = 2, /* contacts of a pair that are solved in one visit */
    REFERENCE_ROWS = 2 * REFERENCE_POINTS,
    REFERENCE_COUPLINGS = REFERENCE_ROWS * (REFERENCE_ROWS - 1) / 2
};

/* A direction in which nothing changes any more shrinks by beta from sweep to sweep, to numbers so small that a
   processor takes a hundred cycles for each. Added and taken away again, this makes it 0 before that, and leaves all
   others alone. */
static const double reference_floor = 0x1p-200;

/* Velocity times the root of the mass: one vector register. Nothing reads the fourth number. */
struct ReferenceMomentum {
    double x, y, spin, unused;
};

/* One direction of a contact in each lane, in units in which every mass is 1: velocities are times the root of the
   mass, impulses through the root of the contact's effective mass. There an impulse q changes the velocities by q times
   the row, and its own relative velocity, row * velocities, by q. */
typedef struct ReferenceRow {
    double a[3][REFERENCE_LANES], b[3][REFERENCE_LANES]; /* x, y, spin of the two bodies */
    double target[REFERENCE_LANES];                      /* the relative velocity that no impulse changes any more */
    double to_velocity[REFERENCE_LANES]; /* 1 / root of the effective mass, kg^(-1/2): q times this is in m/s */
} ReferenceRow;

/* Pairs that share no moving body; one that does not move keeps its zeros, whoever writes them. Rows: normal and
   tangent of the first contact, then of the second. A lane without a pair has zeros and the spare body, a pair with one
   contact zeros in the second point: they change nothing. */
struct ReferenceGroup {
    int a[REFERENCE_LANES], b[REFERENCE_LANES];      /* in the problem; the spare body is body_count */
    int contacts[REFERENCE_POINTS][REFERENCE_LANES]; /* in the problem; -1: none */
    ReferenceRow rows[REFERENCE_ROWS];
    double friction[REFERENCE_POINTS][REFERENCE_LANES]; /* of impulses in the units above */
    /* Row times an earlier one: rows 1 0, 2 0, 2 1, 3 0, 3 1, 3 2. */
    double coupling[REFERENCE_COUPLINGS][REFERENCE_LANES];
};

/* A number for each impulse of a group. */
struct ReferenceNumbers {
    double rows[REFERENCE_ROWS][REFERENCE_LANES];
};

/* Roots of the effective masses, kg^(1/2): an impulse of q in the units above is scale * q in N s. */
static inline ReferenceImpulse reference_scale(const ContactPoint *contact) {
    return (ReferenceImpulse){sqrt((double)contact->mass_normal), sqrt((double)contact->mass_tangent)};
}

/* Takes the problem in. False when memory is short. */
bool reference_load(Reference *reference, const ContactProblem *problem);

/* Sets the workspace to these impulses, or to the warm start where start is NULL, and the velocities that they give. */
void reference_start(Reference *reference, const ContactProblem *problem, const ContactImpulse *start);

/* Fills velocities and impulses of the result from the impulses of the workspace, without the rounding of many
   sweeps. */
void reference_hand_out(Reference *reference, const ContactProblem *problem);

/* What one sweep did: |g|^2; -g d, with the direction of the sweeps before; and the largest change of a contact's
   relative velocity, m/s. The first two are energies: bodies of unlike mass count alike. Each is summed lane by lane,
   and the lanes in pairs at the end, so that both texts below round alike. */
typedef struct ReferenceSweep {
    double squared, along, change;
} ReferenceSweep;

/* Goes on by beta times the direction from where the sweep before ended, and sweeps once from there, `sums_before` into
   `sums`. A visit takes the velocities along its rows at once, and what its impulses add to them from the couplings:
   that is Gauss-Seidel all the same, without waiting for the velocities in between. The plain text, and the lanes of
   a processor that has them: the same bits, as long as all numbers are finite. */
ReferenceSweep reference_sweep_plain(Reference *reference, double beta);
ReferenceSweep reference_sweep_avx2(Reference *reference, double beta);
