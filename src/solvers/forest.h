/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What stands on the ground without loops, stacks above all: solved as a whole, without a sweep.

   Two points where nothing slides or opens tie all that two bodies have between them in the plane. So where pairs form
   trees that grow from static bodies, and hold, the velocities follow from the ground up and the impulses from the top
   down. For a body b on a body a, with two contacts k,

       v_b + w_b x r_b[k] = v_a + w_a x r_a[k] + bias[k] n   (along the tangent for one k: it is the same for both)
       sum over k of P[k] = m_b (v_b - v_b before) + the impulses that b gives to those on it

   and the same for angular momentum says how the points share the impulse. Where none of them pulls or drags more than
   friction allows, this is the solution that sweeps converge to, however high a stack is and whatever weighs on it.
   Source: the two passes of Luh, Walker, Paul, "On-Line Computational Scheme for Mechanical Manipulators" (1980). Fails,
   and says so, where a body of a tree slides, tips, or stands on a corner, and for all that is in a loop, such as the
   stones of a wall, or stands on one. */
#pragma once
#include "dynamics/contact_problem.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct ForestBody {
    BodyVelocity after; /* before the step; where grounded, after it */
    Vec2 push;          /* N s: what those that it carries give to it, and their turn in N m s */
    float turn;
    int pairs, links; /* pairs not taken off yet, and the exclusive or of their first contacts */
    bool grounded;    /* in a tree, by pairs of two points all the way down */
} ForestBody;

/* A pair of a tree, or of a branch that grows from a loop. */
typedef struct ForestPair {
    int first, points; /* its contacts */
    int above, below;  /* its bodies */
} ForestPair;

/* Zero-initialise; arrays grow and are reused. */
typedef struct Forest {
    ForestBody *bodies; /* [bodies] */
    ForestPair *pairs;  /* [pair_count] from the tips down */
    int pair_count;
    size_t body_capacity, pair_capacity;
} Forest;

typedef enum ForestAnswer {
    FOREST_NONE, /* nothing is grounded */
    FOREST_PART, /* some contacts slide or open, or are in no tree */
    FOREST_WHOLE /* impulses and velocities solve the problem */
} ForestAnswer;

void forest_free(Forest *forest);

/* Fills impulses [contact_count] and forest->bodies[].after. In part: where a tree does not hold, impulses that are near,
   within their cones; the warm start where nothing is grounded. False when memory is short. */
bool forest_solve(Forest *forest, const ContactProblem *problem, ContactImpulse *impulses, ForestAnswer *answer);
