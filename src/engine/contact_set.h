/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contacts of one step while they are found: grouped by pairs, with those of the step before. */
#pragma once
#include "engine/boxes.h"
#include "engine/engine.h"

/* An arbiter is a touching pair; it persists with its impulses as long as
   the pair touches. */

/* How a pair was when its points were found. */
typedef struct FoundPair {
    Vec2 between;        /* m, from the centre of a to that of b */
    Vec2 axis_a, axis_b; /* x axes of the boxes */
    float separation[2]; /* m, of its points */
} FoundPair;

typedef struct Arbiter {
    int a, b;         /* bodies, a < b */
    int first, count; /* its points in the contact set; count is 0 once forgotten */
    float rest;       /* m, the overlap that position correction leaves */
    bool narrow;      /* of mended contacts: its points are nearer to each other than half of the smallest side */
    FoundPair found;
} Arbiter;

/* Zero-initialise; arrays grow and are reused. Arbiters are sorted by (a, b). */
typedef struct ContactSet {
    int arbiter_count, contact_count;
    Arbiter *arbiters;
    ContactPoint *contacts;   /* [contact_count] */
    ContactImpulse *impulses; /* [contact_count] of the solution */
    int *before;              /* [contact_count] index of the same point in the last step, or -1 */
    int *partners;            /* scratch: lists of the arbiters of each body */
    size_t arbiter_capacity, contact_capacity, impulse_capacity, before_capacity, partner_capacity;
} ContactSet;

/* Bounds of boxes that touch by these rules overlap. */
Bounds contact_bounds(const Box *box, ContactRules rules);

void contact_set_free(ContactSet *set);

/* Makes `to` equal to `from`. False when memory is short. */
bool contact_set_copy(ContactSet *to, const ContactSet *from);

/* Narrow phase over the candidate pairs; fills positions, normals, lever arms, separations and feature ids, not masses
   or impulses. `last`: the contacts of the last step, for those that are kept. False when memory is short. */
bool contact_set_collide(ContactSet *set, const PairList *pairs, const Box *boxes, const ContactSet *last,
                         ContactRules rules);

/* Finds each point's `before`, and with warm starting takes its impulses: in the same pair, the point with the same
   feature id, as Box2D-Lite does; of mended contacts, the one at the same place. */
void contact_set_match(ContactSet *set, const ContactSet *last, ContactRules rules, bool warm_starting);

/* Forgets the arbiters of a body. Contacts and impulses stay in memory, for readers of the last step. */
void contact_set_forget(ContactSet *set, int body);

/* Effective masses, friction and bias (the pre-step of Box2D-Lite). friction: coefficient of each body. Without
   position correction the bias of contacts that overlap is 0; where a gap is, it lets the gap close in this step, and
   no more. */
void contact_set_prepare(ContactSet *set, const ProblemBody *bodies, const float *friction, float dt,
                         bool position_correction);
