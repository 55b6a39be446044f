/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Islands: bodies that contacts connect, through bodies that move. What happens in one changes nothing in another, so
   each can be solved as a contact problem of its own. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"

#include <stdint.h>

/* The body that stands for those that `parent` connects, each with another or itself; halves the path to it. */
static inline int32_t islands_root(int32_t *parent, int32_t body) {
    while (parent[body] != body) body = parent[body] = parent[parent[body]];
    return body;
}

typedef struct Island {
    int bodies, contacts; /* their numbers; bodies: those that move */
    int grounded;         /* bodies that touch one that does not move */
    /* Touching pairs that could open without dividing it, where all that does not move is one body. A stack has none, a
       gate one, a pyramid or a wall almost as many as boxes. */
    int loops;
} Island;

/* Zero-initialise; arrays grow and are reused. */
typedef struct Islands {
    int count;
    int moving;                  /* bodies that move, in islands or alone */
    Island *islands;             /* [count], in the order of their first contacts */
    int32_t *island;             /* [contact_count] of each contact; -1: of bodies that do not move */
    struct Gain *gains;          /* [count] see islands_take_gain(); */
    bool shortened;              /* whether its last answer was */
    bool sorted;                 /* `members` and `contacts` are filled */
    int32_t *parent;             /* [body_count] another body of the island, or itself; -1: does not move */
    bool *grounded;              /* [body_count] touches a body that does not move */
    int32_t *number;             /* [body_count] of the island of which the body is the root */
    int32_t *members, *contacts; /* those of the first island, of the second, ... */
    int32_t *behind_members, *behind_contacts; /* [count] where each island's end */
    int32_t *place, *in_island;                /* [body_count] in the island that was taken last */
    /* The island that was taken last. */
    int32_t *bodies; /* in the whole problem */
    ProblemBody *body_copies;
    ContactPoint *contact_copies;
    BodyVelocity *velocities;
    ContactImpulse *impulses;
    ArrayBlock by_body, by_contact;
} Islands;

void islands_free(Islands *islands);

/* Finds the islands of a problem. False when memory is short. */
bool islands_find(Islands *islands, const ContactProblem *problem);

/* A copy of island k of the problem, valid until the next call, and room for its solution. Bodies keep their order, and
   so do contacts. Bodies that do not move are in every island that touches them. */
ContactProblem islands_take(Islands *islands, const ContactProblem *problem, int k, ContactSolution *room);

/* Stores the solution of island k, which was taken last, in that of the whole problem. */
void islands_put(const Islands *islands, int k, const ContactProblem *part, const ContactSolution *of_part,
                 ContactSolution *solution);

/* No answer adds more energy to an island than its bodies have at the sum of its biases, the speed at which the last of
   a row moves if position correction pushes all of its contacts apart; none at all where a contact misses its velocity
   by more than the largest bias. An answer that does is shortened: impulses and changes of velocity times the share
   that leaves the least energy, a square in the share, and what correction may add. So are answers between jammed
   bodies, whose impulses grow without an effect until their rounding moves boxes, and of boxes in a row between walls,
   which a little overlap would throw out as a lever does. Finds the islands where a body gains. False when memory is
   short. */
bool islands_take_gain(Islands *islands, const ContactProblem *problem, ContactSolution *solution);
