/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves trees of touching bodies that stand on static bodies, such as stacks, directly: without sweeps.

   Two sticking contacts remove all relative motion between two bodies. So if pairs form trees that are rooted in static
   bodies, and every contact sticks, then velocities follow from the root up and impulses from the tips down. For a body
   b on a body a, with two contacts k,

       v_b + w_b x r_b[k] = v_a + w_a x r_a[k] + bias[k] n   (along the tangent for one k: it is the same for both)
       sum over k of P[k] = m_b (v_b - v_b before) + the impulses that b exerts on the bodies it carries

   and the balance of angular momentum determines how the two points share the impulse. If no contact pulls or exceeds
   friction, this is the solution that sweeps converge to, at any height and under any load. Source: the two passes of
   Luh, Walker, Paul, "On-Line Computational Scheme for Mechanical Manipulators" (1980). Fails, and reports it, if a
   body of a tree slides, tips or stands on a corner, and for bodies in or on a loop, such as the stones of a wall. */
#pragma once
#include "dynamics/contact_problem.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct ForestBody {
    BodyVelocity after; /* of the step if grounded; else the velocity before it */
    Vec2 push;          /* N s, and turn in N m s: impulses from the bodies it carries */
    float turn;
    int pairs, links; /* pairs that remain, and the exclusive or of their first contacts */
    bool grounded;    /* in a tree; pairs of two points down to the root */
} ForestBody;

/* A pair of a tree, or of a branch on a loop. */
typedef struct ForestPair {
    int first, points; /* its contacts */
    int above, below;  /* its bodies */
} ForestPair;

/* Zero-initialise; arrays grow and are reused. */
typedef struct Forest {
    ForestBody *bodies; /* [bodies] */
    ForestPair *pairs;  /* [pair_count] from the tips to the roots */
    int pair_count;
    size_t body_capacity, pair_capacity;
} Forest;

typedef enum ForestResult {
    FOREST_NONE, /* no body is grounded */
    FOREST_PART, /* some contacts slide or separate, or are in no tree */
    FOREST_WHOLE /* impulses and velocities solve the contact problem */
} ForestResult;

void forest_free(Forest *forest);

/* Fills impulses [contact_count] and forest->bodies[].after. FOREST_PART: impulses of contacts that do not stick are
   approximate, inside their cones; those of bodies that are not grounded are the warm start. False when memory is
   short. */
bool forest_solve(Forest *forest, const ContactProblem *problem, ContactImpulse *impulses, ForestResult *result);
