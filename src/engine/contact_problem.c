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

static void add_arbiter(ContactSet *set, BodyPair pair, const Manifold *manifold, const Box *boxes) {
    const Box *a = &boxes[pair.a], *b = &boxes[pair.b];
    Arbiter *arbiter = &set->arbiters[set->arbiter_count++];
    *arbiter = (Arbiter){
        pair.a,
        pair.b,
        set->contact_count,
        manifold->count,
        {vec2_sub(b->position, a->position), a->rotation.column1, b->rotation.column1, {0, 0}},
    };
    for (int k = 0; k < manifold->count; k++) {
        const ManifoldPoint *point = &manifold->points[k];
        ContactPoint *contact = &set->contacts[set->contact_count++];
        contact->a = pair.a;
        contact->b = pair.b;
        contact->position = point->position;
        contact->normal = manifold->normal;
        contact->arm_a = vec2_sub(point->position, a->position);
        contact->arm_b = vec2_sub(point->position, b->position);
        contact->separation = arbiter->found.separation[k] = point->separation;
        contact->feature = point->feature;
        contact->warm_normal = contact->warm_tangent = 0;
    }
}

/* (cos, sin) of the rotation from one unit vector to another. */
static Vec2 turn_from(Vec2 from, Vec2 to) { return vec2(vec2_dot(from, to), vec2_cross(from, to)); }

/* By how much the rotation moves the end of a lever arm. */
static Vec2 moved_by(Vec2 turn, Vec2 arm) {
    return vec2_sub(vec2(turn.x * arm.x - turn.y * arm.y, turn.y * arm.x + turn.x * arm.y), arm);
}

static float radius(const Box *box) { return sqrtf(vec2_dot(box->half, box->half)); }

/* Adds the arbiter of the last step with the points that it had; false if it must be found anew. A single point is: a
   corner that another may soon join. */
static bool keep_arbiter(ContactSet *set, const ContactSet *last, const Arbiter *old, const Box *boxes, float keep) {
    const float least_cosine = 0.98f,
                share = 0.05f; /* Box2D's angle; a thin box is not supported far beyond its edge */
    if (old->count < 2) return false;
    const Box *a = &boxes[old->a], *b = &boxes[old->b];
    const Vec2 shift = vec2_sub(vec2_sub(b->position, a->position), old->found.between);
    const Vec2 turn_a = turn_from(old->found.axis_a, a->rotation.column1);
    const Vec2 turn_b = turn_from(old->found.axis_b, b->rotation.column1);
    const float side = 2.0f * fminf(fminf(a->half.x, a->half.y), fminf(b->half.x, b->half.y));
    const float reach = fminf(radius(a), radius(b));
    const float drift = sqrtf(vec2_dot(shift, shift)) + reach * fabsf(vec2_cross(turn_a, turn_b));
    if (!(turn_a.x > least_cosine && turn_b.x > least_cosine && drift < fminf(keep, share * side))) return false;

    Arbiter *arbiter = &set->arbiters[set->arbiter_count++];
    *arbiter = *old;
    arbiter->first = set->contact_count;
    for (int k = 0; k < old->count; k++) {
        ContactPoint *contact = &set->contacts[set->contact_count++];
        *contact = last->contacts[old->first + k];
        const Vec2 apart = vec2_sub(moved_by(turn_b, contact->arm_b), moved_by(turn_a, contact->arm_a));
        contact->position = vec2_add(a->position, contact->arm_a);
        contact->separation = old->found.separation[k] + vec2_dot(vec2_add(shift, apart), contact->normal);
        contact->warm_normal = contact->warm_tangent = 0;
    }
    return true;
}

static bool before(int a, int b, int of_a, int of_b) { return a < of_a || (a == of_a && b < of_b); }

bool contact_set_collide(ContactSet *set, const PairList *pairs, const Box *boxes, const ContactSet *last, float keep) {
    const Arbiter *old = last->arbiters, *end = old + (keep > 0 ? last->arbiter_count : 0);
    const BodyPair *pair = pairs->pairs, *pairs_end = pair + pairs->count;
    set->arbiter_count = set->contact_count = 0;
    if (!reserve(set, pairs->count + (size_t)(end - old))) return false;
    /* Both lists rise by (a, b). */
    while (pair < pairs_end || old < end) {
        const bool is_old = old < end && (pair == pairs_end || !before(pair->a, pair->b, old->a, old->b));
        const bool may_touch = !is_old || (pair < pairs_end && pair->a == old->a && pair->b == old->b);
        Manifold manifold = {0};
        if (!(is_old && keep_arbiter(set, last, old, boxes, keep)) && may_touch) {
            manifold_compute(&manifold, &boxes[pair->a], &boxes[pair->b]);
            if (manifold.count > 0) add_arbiter(set, *pair, &manifold, boxes);
        }
        old += is_old;
        pair += may_touch;
    }
    return true;
}

void contact_set_match(ContactSet *set, const ContactSet *last) {
    const Arbiter *old = last->arbiters, *end = old + last->arbiter_count;
    for (int i = 0; i < set->arbiter_count; i++) {
        const Arbiter *arbiter = &set->arbiters[i];
        while (old < end && before(old->a, old->b, arbiter->a, arbiter->b)) old++;
        if (old == end) return;
        if (before(arbiter->a, arbiter->b, old->a, old->b)) continue;
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
        contact->mass_normal = effective_mass(a, b, contact->arm_a, contact->arm_b, contact->normal);
        Vec2 tangent = vec2_cross_scalar(contact->normal, 1.0f);
        contact->mass_tangent = effective_mass(a, b, contact->arm_a, contact->arm_b, tangent);
        contact->bias = position_correction ? contact_bias(contact->separation, inverse_dt) : 0;
        if (contact->separation > 0) contact->bias = -contact->separation * inverse_dt;
        contact->friction = sqrtf(friction[contact->a] * friction[contact->b]);
    }
}

void contact_solution_begin(const ContactProblem *problem, ContactSolution *solution) {
    for (int i = 0; i < problem->body_count; i++)
        solution->velocities[i] = (BodyVelocity){problem->bodies[i].velocity, problem->bodies[i].angular_velocity};
    for (int i = 0; i < problem->contact_count; i++) solution->impulses[i] = (ContactImpulse){0, 0};
}
