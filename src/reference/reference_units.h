/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference's workspace: bodies and contacts in units in which every mass is 1, pairs of bodies in groups whose
   visits commute, one pair per lane. Only the files of the reference include this. */
#pragma once
#include "reference/reference.h"

#include <math.h>

enum {
    REFERENCE_LANES = 4,  /* pairs in a group */
    REFERENCE_POINTS = 2, /* contacts of a pair that are solved in one visit */
    REFERENCE_ROWS = 2 * REFERENCE_POINTS,
    REFERENCE_COUPLINGS = REFERENCE_ROWS * (REFERENCE_ROWS - 1) / 2
};

/* A converged direction shrinks by beta per sweep down to subnormal numbers, which cost a hundred cycles each. Adding
   and subtracting this constant flushes them to 0 and leaves all other numbers unchanged. */
static const double reference_floor = 0x1p-200;

/* Velocity times the square root of the mass, in one vector register. The fourth number is unused. */
struct ReferenceMomentum {
    double x, y, spin, unused;
};

/* One direction of a contact per lane, in units in which every mass is 1: velocities are multiplied by the square root
   of the mass, impulses divided by the square root of the contact's effective mass. In these units an impulse q changes
   the velocities by q times the row, and its own relative velocity, row * velocities, by q. */
typedef struct ReferenceRow {
    double a[3][REFERENCE_LANES], b[3][REFERENCE_LANES]; /* x, y, spin of the two bodies */
    double target[REFERENCE_LANES];                      /* the target relative velocity */
    double to_velocity[REFERENCE_LANES]; /* 1 / square root of the effective mass, kg^(-1/2): q times this is in m/s */
} ReferenceRow;

/* Pairs that share no moving body; static bodies keep zeros, even if several lanes write them. Rows: normal and tangent
   of the first contact, then of the second. A lane without a pair has zeros and the spare body, a pair with one contact
   has zeros for the second point; both have no effect. */
struct ReferenceGroup {
    int a[REFERENCE_LANES], b[REFERENCE_LANES];      /* in the problem; the spare body is body_count */
    int contacts[REFERENCE_POINTS][REFERENCE_LANES]; /* in the problem; -1: none */
    ReferenceRow rows[REFERENCE_ROWS];
    double friction[REFERENCE_POINTS][REFERENCE_LANES]; /* of impulses in the units above */
    /* Dot products of rows 1 0, 2 0, 2 1, 3 0, 3 1, 3 2. */
    double coupling[REFERENCE_COUPLINGS][REFERENCE_LANES];
};

/* One number per impulse of a group. */
struct ReferenceNumbers {
    double rows[REFERENCE_ROWS][REFERENCE_LANES];
};

/* Square roots of the effective masses, kg^(1/2): an impulse q in the units above is scale * q in N s. */
static inline ReferenceImpulse reference_scale(const ContactPoint *contact) {
    return (ReferenceImpulse){sqrt((double)contact->mass_normal), sqrt((double)contact->mass_tangent)};
}

/* Loads the problem. False when memory is short. */
bool reference_load(Reference *reference, const ContactProblem *problem);

/* Sets the workspace to these impulses (start NULL: the warm start) and their velocities. */
void reference_start(Reference *reference, const ContactProblem *problem, const ContactImpulse *start);

/* Computes the result's velocities from the impulses of the workspace, which avoids the rounding errors of many
   sweeps. */
void reference_store(Reference *reference, const ContactProblem *problem);

/* The results of one sweep: |g|^2; -g d, with the direction of the previous sweeps; and the largest change of a
   contact's relative velocity, m/s. The first two are energies, so bodies of different mass have equal weight. Each is
   summed lane by lane, and the lanes in pairs at the end, so that both functions below round alike. */
typedef struct ReferenceSweep {
    double squared, along, change;
} ReferenceSweep;

/* Adds beta times the direction to the result of the previous sweep, then sweeps once, from `sums_before` to `sums`. A
   visit computes the velocities along all its rows at once, and the effect of its own impulses on them by the dot
   products: the same as Gauss-Seidel, with a shorter dependency chain. The scalar and the vectorised function have the
   same bits as long as all numbers are finite. */
ReferenceSweep reference_sweep_scalar(Reference *reference, double beta);
ReferenceSweep reference_sweep_avx2(Reference *reference, double beta);
