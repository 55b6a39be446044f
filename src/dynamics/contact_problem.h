/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One step's contact problem, frozen: everything a contact solver may see. Datasets are recorded from it and
   accuracy is scored on it. Source: Catto, "Iterative Dynamics with Temporal Coherence" (2005) and "Fast and
   Simple Physics using Sequential Impulses" (GDC 2006). */
#pragma once
#include "common/vec2.h"

#include <stdbool.h>
#include <stdint.h>

/* m: overlap that is left as it is. */
#define CONTACT_SLOP 0.01f

typedef struct ProblemBody {
    Vec2 position;               /* m */
    float angle;                 /* rad */
    Vec2 size;                   /* full width and height, m */
    float inv_mass, inv_inertia; /* 1/kg, 1/(kg m^2); 0 for a static body */
    Vec2 velocity;               /* m/s, after gravity, before the warm start */
    float angular_velocity;      /* rad/s */
} ProblemBody;

/* Can an impulse move it? */
static inline bool problem_body_moves(const ProblemBody *body) {
    return body->inv_mass != 0.0f || body->inv_inertia != 0.0f;
}

typedef struct ContactPoint {
    int a, b;                        /* bodies, a < b; the points of one pair are adjacent, pairs rise by (a, b) */
    Vec2 position;                   /* m, world */
    Vec2 normal;                     /* unit, from a to b; the tangent is normal turned a quarter clockwise */
    Vec2 arm_a, arm_b;               /* m, from the centre of each body to the point */
    float separation;                /* m, negative where they overlap */
    float mass_normal, mass_tangent; /* kg, effective masses along normal and tangent */
    float friction;                  /* coefficient of the pair */
    float bias;       /* m/s, target normal velocity that undoes penetration; 0 without position correction */
    uint32_t feature; /* which edges made the point: the same number means the same point a step later */
    float warm_normal, warm_tangent; /* N s, impulses of the step before; 0 without warm starting or when new */
} ContactPoint;

typedef struct ContactProblem {
    int body_count, contact_count;
    int bomb; /* body index, or -1 */
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

/* What a network said in a step and no body got to feel, counted by contacts or pairs. */
typedef struct NetworkFallbacks {
    int not_finite;      /* no numbers, or beyond all bounds: the solver goes on without */
    int outside_cone;    /* impulses that were brought into the friction cone */
    int beyond_training; /* steps in which it was not asked, as they are not like those that it learned from */
} NetworkFallbacks;

/* What a solver fills in; the arrays are the caller's. */
typedef struct ContactSolution {
    BodyVelocity *velocities; /* [body_count] */
    ContactImpulse *impulses; /* [contact_count]; zeros from a method that has none */
    /* N s: momentum that the method made from nothing: sum over pairs of moving bodies of |ma dva + mb dvb|; 0 where it
       pushes by impulses */
    float momentum_error;
    NetworkFallbacks fallbacks; /* zeros without a network */
} ContactSolution;
