/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pair/pair_context.h"

#include "pair/pair.h"

#include <stddef.h>

static const float unit_tolerance = 1e-3f; /* of a normal's squared length */

static void put(float *to, Vec2 v) {
    to[0] = v.x;
    to[1] = v.y;
}

static void put_velocity(float *to, const ProblemBody *body) {
    put(to, body->velocity);
    to[2] = body->angular_velocity;
}

void pair_context(const ContactProblem *problem, int first, float context[PAIR_CONTEXT]) {
    const ContactPoint *contact = &problem->contacts[first];
    const ProblemBody *a = &problem->bodies[contact->a], *b = &problem->bodies[contact->b];
    const int count = pair_contact_count(problem, first);
    Vec2 arm_a = vec2(0, 0), arm_b = vec2(0, 0);
    for (int i = 0; i < count; i++) {
        arm_a = vec2_add(arm_a, contact[i].arm_a);
        arm_b = vec2_add(arm_b, contact[i].arm_b);
    }
    context[CONTEXT_INV_MASS_A] = a->inv_mass;
    context[CONTEXT_INV_INERTIA_A] = a->inv_inertia;
    context[CONTEXT_INV_MASS_B] = b->inv_mass;
    context[CONTEXT_INV_INERTIA_B] = b->inv_inertia;
    put(context + CONTEXT_NORMAL, contact->normal);
    context[CONTEXT_FRICTION] = contact->friction;
    put(context + CONTEXT_ARM_A, vec2_scale(1.0f / (float)count, arm_a));
    put(context + CONTEXT_ARM_B, vec2_scale(1.0f / (float)count, arm_b));
    put_velocity(context + CONTEXT_VELOCITIES, a);
    put_velocity(context + CONTEXT_VELOCITIES + 3, b);
}

const char *pair_context_fault(const float context[PAIR_CONTEXT]) {
    const Vec2 normal = vec2(context[CONTEXT_NORMAL], context[CONTEXT_NORMAL + 1]);
    for (int i = CONTEXT_INV_MASS_A; i <= CONTEXT_INV_INERTIA_B; i++)
        if (context[i] < 0) return "an inverse mass or inertia below 0";
    if (context[CONTEXT_INV_MASS_A] == 0 && context[CONTEXT_INV_MASS_B] == 0) return "two static bodies";
    if (!(fabsf(vec2_dot(normal, normal) - 1) <= unit_tolerance)) return "a normal whose length is not 1";
    if (context[CONTEXT_FRICTION] < 0) return "friction below 0";
    return NULL;
}
