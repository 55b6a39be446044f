/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random contact problems with a network of scene-net that knows a part of their contacts. */
#pragma once
#include "random_problem.h"

#include "nets/scene_net_layers.h"

/* The network knows so large a share of the contacts, and a slot behind each that the problem lacks. Some warm impulses
   are below 0, as a problem's file may have them. */
static inline SceneNet *make_scene_net_problem(RandomProblem *random, uint32_t *seed, int bodies, float density,
                                               float share) {
    static Slot slots[2 * CONTACTS_MAX + 1];
    make_random(random, seed, bodies, density, 2);
    int count = 0;
    for (int i = 0; i < bodies; i++) {
        random->bodies[i].position = any_vector(seed, 20);
        random->bodies[i].angle = any_number(seed, 3);
    }
    for (int i = 0; i < random->problem.contact_count; i++) {
        ContactPoint *contact = &random->contacts[i];
        contact->feature = (uint32_t)(10 * i);
        if (uniform(seed, 0, 1) < 0.1f) contact->warm_normal = -contact->warm_normal;
        if (uniform(seed, 0, 1) < share) slots[count++] = (Slot){contact->a, contact->b, contact->feature};
        slots[count++] = (Slot){contact->a, contact->b, contact->feature + 1};
    }
    if (count == 0) slots[count++] = (Slot){0, 1, 0};
    const SceneNetShape shape = {bodies, (int)uniform(seed, 0, (float)bodies - 0.01f), count, 16, 16, 16, 16};
    return make_scene_net(&shape, slots, seed);
}
