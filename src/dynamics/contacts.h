/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contacts of one step, arbiter by arbiter. An arbiter is a touching pair; it persists, and its impulses with
   it, as long as the pair touches. */
#pragma once
#include "collision/broad_phase.h"
#include "dynamics/contact_problem.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct Arbiter {
    int a, b;         /* bodies, a < b */
    int first, count; /* its points in the contact set; none where it is forgotten */
} Arbiter;

/* Zero-initialise; arrays grow and are reused. Arbiters rise by (a, b). */
typedef struct ContactSet {
    int arbiter_count, contact_count;
    Arbiter *arbiters;
    ContactPoint *contacts;   /* [contact_count] */
    ContactImpulse *impulses; /* [contact_count] what the solver found */
    size_t arbiter_capacity, contact_capacity, impulse_capacity;
} ContactSet;

void contact_set_free(ContactSet *set);

/* Makes `to` equal to `from`. False when memory is short. */
bool contact_set_copy(ContactSet *to, const ContactSet *from);

/* Narrow phase over the candidate pairs; fills where, which way and how deep, not yet masses or impulses. False
   when memory is short. */
bool contact_set_collide(ContactSet *set, const PairList *pairs, const Box *boxes);

/* Hands the impulses of the last step to the points of this one that have the same pair and feature. */
void contact_set_match(ContactSet *set, const ContactSet *last);

/* The pairs of a body are as if they had never touched. Contacts and impulses stay where they are: who reads the last
   step still needs them. */
void contact_set_forget(ContactSet *set, int body);

/* The velocity, m/s, that position correction wants along the normal (Baumgarte 1972, as Box2D-Lite has it);
   inverse_dt in 1/s. */
float contact_bias(float separation, float inverse_dt);

/* Lever arms, effective masses, friction and bias (the pre-step of Box2D-Lite). friction: coefficient of each body.
   Without position correction the bias is 0. */
void contact_set_prepare(ContactSet *set, const ProblemBody *bodies, const float *friction, float dt,
                         bool position_correction);
