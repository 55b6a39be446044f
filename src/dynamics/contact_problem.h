/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contact problem of one step, frozen: the whole input of a contact solver. Datasets are recorded from it and
   accuracy is measured on it. Source: Catto, "Iterative Dynamics with Temporal Coherence" (2005) and "Fast and Simple
   Physics using Sequential Impulses" (GDC 2006). */
#pragma once
#include "common/error.h"
#include "common/vec2.h"

#include <stdbool.h>
#include <stdint.h>

/* m: penetration that position correction leaves. */
#define CONTACT_SLOP 0.01f

typedef struct ProblemBody {
    Vec2 position;               /* m */
    float angle;                 /* rad */
    Vec2 size;                   /* full width and height, m */
    float inv_mass, inv_inertia; /* 1/kg, 1/(kg m^2); 0 for a static body */
    Vec2 velocity;               /* m/s, after gravity, before the warm start */
    float angular_velocity;      /* rad/s */
} ProblemBody;

/* True for a body of finite mass. */
static inline bool problem_body_moves(const ProblemBody *body) {
    return body->inv_mass != 0.0f || body->inv_inertia != 0.0f;
}

typedef struct ContactPoint {
    int a, b;                        /* bodies, a < b; the points of one pair are adjacent, pairs rise by (a, b) */
    Vec2 position;                   /* m, world */
    Vec2 normal;                     /* unit, from a to b; the tangent is normal turned a quarter clockwise */
    Vec2 arm_a, arm_b;               /* m, from the centre of each body to the point */
    float separation;                /* m, negative for penetration */
    float mass_normal, mass_tangent; /* kg, effective masses along normal and tangent */
    float friction;                  /* coefficient of the pair */
    float bias;                      /* m/s, target normal velocity of position correction; 0 without it */
    uint32_t feature;                /* feature id: the edges that make the point; identifies it in the next step */
    float warm_normal, warm_tangent; /* N s, impulses of the step before; 0 without warm starting or when new */
} ContactPoint;

typedef struct ContactProblem {
    int body_count, contact_count;
    int marked; /* body that the caller of world_mark() chose: a scene marks its bomb; or -1 */
    float dt; /* s */
    const ProblemBody *bodies;
    const ContactPoint *contacts;
} ContactProblem;

typedef struct BodyVelocity {
    Vec2 linear;   /* m/s */
    float angular; /* rad/s */
} BodyVelocity;

typedef struct ContactImpulse {
    float normal, tangent; /* N s, accumulated over the step; b gets +, a gets - */
} ContactImpulse;

/* What a method solved by simpler means than its own. The first two count network outputs that were discarded or
   corrected, by contact or pair. */
typedef struct NetworkFallbacks {
    int not_finite;      /* NaN, infinite or out of bounds; discarded */
    int outside_cone;    /* impulses that were clamped to the friction cone */
    int beyond_training; /* steps unlike the training data: taken without the network, or with inputs or components that
                            were clamped to its range (the method's file says which) */
    int by_sweeps;       /* steps that sweeps solved, because the residual of interior-point steps stayed high or the
                            problem is too large for them */
} NetworkFallbacks;

static inline void network_fallbacks_add(NetworkFallbacks *sum, const NetworkFallbacks *step) {
    sum->not_finite += step->not_finite;
    sum->outside_cone += step->outside_cone;
    sum->beyond_training += step->beyond_training;
    sum->by_sweeps += step->by_sweeps;
}

/* What a solver fills in; the arrays are the caller's. */
typedef struct ContactSolution {
    BodyVelocity *velocities; /* [body_count] */
    ContactImpulse *impulses; /* [contact_count]; zeros from a method without impulses */
    /* N s: momentum that the method created: the sum over pairs of moving bodies of |ma dva + mb dvb|; 0 for a method
       that applies impulses; of avbd and sain the sum over bodies of the momentum that impulses do not account
       for; of gns that which bodies without a contact gained beyond gravity's */
    float momentum_error;
    NetworkFallbacks fallbacks; /* zeros for most methods */
} ContactSolution;

/* Solves a contact problem: fills the solution. False with error set only when memory is short or the problem cannot be
   solved at all. Allocates nothing once the state has met a problem of that size. */
typedef bool ContactSolve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error);
