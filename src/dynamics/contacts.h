/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contacts of one step, grouped by arbiter. An arbiter is a touching pair; it persists with its impulses as long as
   the pair touches. */
#pragma once
#include "collision/broad_phase.h"
#include "dynamics/contact_problem.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct Arbiter {
    int a, b;         /* bodies, a < b */
    int first, count; /* its points in the contact set; count is 0 once forgotten */
} Arbiter;

/* Zero-initialise; arrays grow and are reused. Arbiters are sorted by (a, b). */
typedef struct ContactSet {
    int arbiter_count, contact_count;
    Arbiter *arbiters;
    ContactPoint *contacts;   /* [contact_count] */
    ContactImpulse *impulses; /* [contact_count] of the solution */
    size_t arbiter_capacity, contact_capacity, impulse_capacity;
} ContactSet;

void contact_set_free(ContactSet *set);

/* Makes `to` equal to `from`. False when memory is short. */
bool contact_set_copy(ContactSet *to, const ContactSet *from);

/* Narrow phase over the candidate pairs; fills positions, normals, separations and feature ids, not masses or impulses.
   False when memory is short. */
bool contact_set_collide(ContactSet *set, const PairList *pairs, const Box *boxes);

/* Sets warm-start impulses: those of the last step at the point with the same pair and feature id. */
void contact_set_match(ContactSet *set, const ContactSet *last);

/* Forgets the arbiters of a body. Contacts and impulses stay in memory, for readers of the last step. */
void contact_set_forget(ContactSet *set, int body);

/* The target velocity of position correction along the normal, m/s (Baumgarte 1972, as in Box2D-Lite); inverse_dt in
   1/s. */
float contact_bias(float separation, float inverse_dt);

/* Lever arms, effective masses, friction and bias (the pre-step of Box2D-Lite). friction: coefficient of each body.
   Without position correction the bias is 0. */
void contact_set_prepare(ContactSet *set, const ProblemBody *bodies, const float *friction, float dt,
                         bool position_correction);
