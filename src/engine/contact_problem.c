/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of all float operations is fixed: reference trajectories are compared bit by bit. */
#include "base/base.h"
#include "engine/engine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void contact_set_free(ContactSet *set) {
    free(set->arbiters);
    free(set->contacts);
    free(set->impulses);
    *set = (ContactSet){0};
}

/* Reserves two points for every candidate pair. */
static bool reserve(ContactSet *set, size_t pairs) {
    return array_reserve((void **)&set->arbiters, &set->arbiter_capacity, pairs, sizeof *set->arbiters) &&
           array_reserve((void **)&set->contacts, &set->contact_capacity, 2 * pairs, sizeof *set->contacts) &&
           array_reserve((void **)&set->impulses, &set->impulse_capacity, 2 * pairs, sizeof *set->impulses);
}

bool contact_set_copy(ContactSet *to, const ContactSet *from) {
    size_t arbiters = (size_t)from->arbiter_count, contacts = (size_t)from->contact_count;
    if (!reserve(to, arbiters)) return false;
    to->arbiter_count = from->arbiter_count;
    to->contact_count = from->contact_count;
    if (arbiters == 0) return true;
    memcpy(to->arbiters, from->arbiters, arbiters * sizeof *to->arbiters);
    memcpy(to->contacts, from->contacts, contacts * sizeof *to->contacts);
    memcpy(to->impulses, from->impulses, contacts * sizeof *to->impulses);
    return true;
}

static void add_arbiter(ContactSet *set, BodyPair pair, const Manifold *manifold) {
    set->arbiters[set->arbiter_count++] = (Arbiter){pair.a, pair.b, set->contact_count, manifold->count};
    for (int k = 0; k < manifold->count; k++) {
        const ManifoldPoint *point = &manifold->points[k];
        ContactPoint *contact = &set->contacts[set->contact_count++];
        contact->a = pair.a;
        contact->b = pair.b;
        contact->position = point->position;
        contact->normal = manifold->normal;
        contact->separation = point->separation;
        contact->feature = point->feature;
        contact->warm_normal = contact->warm_tangent = 0;
    }
}

bool contact_set_collide(ContactSet *set, const PairList *pairs, const Box *boxes) {
    set->arbiter_count = set->contact_count = 0;
    if (!reserve(set, pairs->count)) return false;
    for (size_t i = 0; i < pairs->count; i++) {
        BodyPair pair = pairs->pairs[i];
        Manifold manifold;
        manifold_compute(&manifold, &boxes[pair.a], &boxes[pair.b]);
        if (manifold.count > 0) add_arbiter(set, pair, &manifold);
    }
    return true;
}

static bool before(const Arbiter *x, const Arbiter *y) { return x->a < y->a || (x->a == y->a && x->b < y->b); }

void contact_set_match(ContactSet *set, const ContactSet *last) {
    const Arbiter *old = last->arbiters, *end = old + last->arbiter_count;
    for (int i = 0; i < set->arbiter_count; i++) {
        const Arbiter *arbiter = &set->arbiters[i];
        while (old < end && before(old, arbiter)) old++;
        if (old == end) return;
        if (before(arbiter, old)) continue;
        for (int k = arbiter->first; k < arbiter->first + arbiter->count; k++) {
            for (int j = old->first; j < old->first + old->count; j++) {
                if (last->contacts[j].feature != set->contacts[k].feature) continue;
                set->contacts[k].warm_normal = last->impulses[j].normal;
                set->contacts[k].warm_tangent = last->impulses[j].tangent;
                break;
            }
        }
    }
}

void contact_set_forget(ContactSet *set, int body) {
    for (int i = 0; i < set->arbiter_count; i++)
        if (set->arbiters[i].a == body || set->arbiters[i].b == body) set->arbiters[i].count = 0;
}

/* The effective mass of a contact along the unit vector `axis`. */
static float effective_mass(const ProblemBody *a, const ProblemBody *b, Vec2 arm_a, Vec2 arm_b, Vec2 axis) {
    float along_a = vec2_dot(arm_a, axis), along_b = vec2_dot(arm_b, axis);
    float inverse = a->inv_mass + b->inv_mass;
    inverse += a->inv_inertia * (vec2_dot(arm_a, arm_a) - along_a * along_a) +
               b->inv_inertia * (vec2_dot(arm_b, arm_b) - along_b * along_b);
    return 1.0f / inverse;
}

float contact_bias(float separation, float inverse_dt) {
    /* Correct only penetration beyond the slop; otherwise resting contacts jitter between touching and apart (Catto
       2006). */
    const float bias_factor = 0.2f;
    float depth = separation + CONTACT_SLOP;
    return -bias_factor * inverse_dt * (depth < 0.0f ? depth : 0.0f);
}

void contact_set_prepare(ContactSet *set, const ProblemBody *bodies, const float *friction, float dt,
                         bool position_correction) {
    float inverse_dt = 1.0f / dt;
    for (int i = 0; i < set->contact_count; i++) {
        ContactPoint *contact = &set->contacts[i];
        const ProblemBody *a = &bodies[contact->a], *b = &bodies[contact->b];
        contact->arm_a = vec2_sub(contact->position, a->position);
        contact->arm_b = vec2_sub(contact->position, b->position);
        contact->mass_normal = effective_mass(a, b, contact->arm_a, contact->arm_b, contact->normal);
        Vec2 tangent = vec2_cross_scalar(contact->normal, 1.0f);
        contact->mass_tangent = effective_mass(a, b, contact->arm_a, contact->arm_b, tangent);
        contact->bias = position_correction ? contact_bias(contact->separation, inverse_dt) : 0;
        contact->friction = sqrtf(friction[contact->a] * friction[contact->b]);
    }
}

void contact_solution_begin(const ContactProblem *problem, ContactSolution *solution) {
    for (int i = 0; i < problem->body_count; i++)
        solution->velocities[i] = (BodyVelocity){problem->bodies[i].velocity, problem->bodies[i].angular_velocity};
    for (int i = 0; i < problem->contact_count; i++) solution->impulses[i] = (ContactImpulse){0, 0};
}
