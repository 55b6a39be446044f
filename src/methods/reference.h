/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The converged solution of a contact problem, in double. Errors of solvers are measured against it.

   It is the fixed point of sequential impulses: for every contact, the normal velocity equals the bias and the normal
   impulse is positive, or the impulse is 0 and the velocity exceeds the bias; the tangent impulse opposes sliding,
   within the friction cone. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/block_lu.h"

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
typedef struct ReferencePoint ReferencePoint;

/* Zero-initialise; arrays grow and are reused. Holds the results of the last solve. residual: the largest change of a
   contact's relative velocity, normal or tangent, by one more sweep: |change of impulse| / effective mass. */
typedef struct Reference {
    ReferenceVelocity *velocities; /* [body_count] */
    ReferenceImpulse *impulses;    /* [contact_count] */
    double residual;               /* m/s */
    int factorizations;            /* used */
    int attempts;                  /* 0: the start's contact states were right; 1: interior points; more: begun again */
    bool scalar;                   /* set by the caller: no vector instructions; slower, with the same bits */
    /* workspace */
    ReferenceVelocity *other_velocities; /* of another answer */
    ReferenceImpulse *other_impulses;
    BlockGraph graph;
    int group_count, pair_count, contact_count; /* contact_count: that act on a moving body */
    ReferenceGroup *groups;
    BlockPair *pairs; /* [2 group_count] */
    int32_t *first;   /* [pair_count + 1] pair i has the contacts first[i] to first[i + 1] - 1 of the problem */
    /* [graph.lu.count + 1] by position; the last is zero, for bodies that do not move. x, y, spin, unused */
    Vec4 *moved, *changes, *first_changes;
    struct {
        ReferencePoint *points;
        Vec4 *moved;
        double target;
    } kept[2];          /* interior points to go back to */
    double aim, enough; /* m/s: residuals that end a solve: as soon as reached; once steps get short */
    double calm;        /* m/s, the unit of speeds: interior points start half of it inside the bounds, if not more */
    int most;           /* factorizations that a solve may use */
    bool persist;       /* begins again from other starts, where reference_solve_to() gives up */
    bool by_heaviest;   /* the first start measures impulses by the heaviest body; see ReferenceAim */
    bool push_out;      /* contacts have their bias */
    int left;           /* that this attempt may still use */
    double stiffest;    /* a contact resists by at most this times its effective mass */
    double best;        /* residual of the best answer, m/s */
    ArrayBlock memory;
} Reference;

/* m/s. A solve aims at a tenth of it. All steps of scenes/stack and scenes/pyramid_settled with the engine, and with
   the reference itself, reach it.

   In about 1% of the impacts on walls and piles friction allows a second solution, 0.01 to 2.8 m/s from the first.
   Some steps of piles between walls have no solution: position correction pushes boxes into each other, and no
   impulses are large enough. Their residual stays high. Of the steps of random structures that do not converge, most
   do without position correction (tests/deep/run structures). Scenes without friction are hard, as 0 is computed as a
   cone of 1e-12. */
#define REFERENCE_TOLERANCE 1e-9

/* Factorizations that a solve may take, and as many again without position correction: a bound of its work. Of 36,000
   steps of 300 random structures all but one that converge take fewer than 8,000. */
enum { REFERENCE_MOST = 10000 };

/* Whether the last solve reached it. Without it, nothing is to be scored against the answer. */
static inline bool reference_converged(const Reference *reference) {
    return reference->residual <= REFERENCE_TOLERANCE;
}

void reference_free(Reference *reference);

/* Solves until the residual is at most REFERENCE_TOLERANCE. start: initial impulses [contact_count]; NULL: the
   problem's warm start. Not to reach the tolerance is not an error; see `residual`. False only when memory is short.

   Where all attempts end above 1e-5 m/s, the step may have no solution. Its answer is then never one that adds energy:
   the best that was found, or the solution without position correction, whichever has the smaller residual. Position
   correction alone makes steps unsolvable: with a bias of 0, rest is allowed, and the problem has a solution (Anitescu,
   Potra, "Formulating Dynamic Multi-Rigid-Body Contact Problems with Friction as Solvable LCPs", 1997) with no more
   kinetic energy than before its impulses. An answer with more is shortened: all impulses times the share that has the
   least energy. */
bool reference_solve(Reference *reference, const ContactProblem *problem, const ContactImpulse *start, Error *error);

typedef struct ReferenceAim {
    double tolerance; /* m/s */
    int most;         /* factorizations */
    bool push_out;    /* position correction */
    bool by_heaviest; /* impulses are measured by the heaviest body, and short steps at first are allowed: where bodies
                         of unlike masses touch, only this leads to the path */
} ReferenceAim;

/* The same from the problem's warm start, but ends as soon as the residual is at most the tolerance, or after about the
   most factorizations. `residual` is then the largest change by one more visit of a contact while all others stay. */
bool reference_solve_to(Reference *reference, const ContactProblem *problem, const ReferenceAim *aim, Error *error);

/* Stores the results of the last solve, in float: rounding may take a tangent impulse out of the friction cone. */
void reference_round(const Reference *reference, const ContactProblem *problem, ContactSolution *solution);

/* The residual of a method's impulses [contact_count]; its velocities do not count. False when memory is short. */
bool reference_residual(Reference *reference, const ContactProblem *problem, const ContactImpulse *impulses,
                        double *residual, Error *error);

/* The error of a method's velocities against the reference. Only dynamic bodies (inv_mass > 0) count. Spin has the
   weight that it has in the kinetic energy of a unit box: m v^2 / 2 + m w^2 / 12 = m (v^2 + w^2 / 6) / 2. */

typedef struct SolutionError {
    double rms;  /* m/s: root of the mean over the bodies of |dv|^2 + dspin^2 / 6; 0 without bodies */
    int right;   /* bodies with a right velocity */
    int counted; /* dynamic bodies */
    int worst;   /* the body with the largest |dv|^2 + dspin^2 / 6; -1: none */
} SolutionError;

/* velocities, reference: [problem->body_count]. A body's velocity is right if |v - v*| <= max(0.05 m/s, 5% of |v* -
   v_free|), with |.|^2 = x^2 + y^2 + (spin / 2)^2 and v_free the problem's velocity, before any impulse. A NaN or
   infinite velocity is wrong; the error is then infinite. */
SolutionError solution_error(const ContactProblem *problem, const BodyVelocity *velocities,
                             const ReferenceVelocity *reference);

/* The floor of a contact problem is the largest error, SolutionError.rms in m/s, of an answer that satisfies the laws
   of contact to REFERENCE_TOLERANCE, as the reference's does; errors below it do not tell methods apart. It is measured
   as the largest distance from `answer`, a converged reference, of the answers to which *r converges from so many other
   starts: no impulses, what sweeps make of these, then random ones in their cones.

   Where only one answer is right it is 0 to rounding: stacks, towers, gates. It is a lower bound, as a start finds
   half of the steps of walls and piles that have another answer. False when memory is short. */
bool reference_floor(Reference *r, const ContactProblem *problem, const Reference *answer, int starts, double *floor,
                     Error *error);

/* Raises it by one more start. */
bool reference_raise_floor(Reference *r, const ContactProblem *problem, const Reference *answer,
                           const ContactImpulse *start, double *floor, Error *error);
