/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact problems that no scene would give. */
#pragma once
#include "testing.h"

#include "engine/uniform.h"
#include "worlds.h"

enum { BODIES_MAX = 80, CONTACTS_MAX = 500 };

typedef struct RandomProblem {
    ProblemBody bodies[BODIES_MAX];
    ContactPoint contacts[CONTACTS_MAX];
    ContactProblem problem;
} RandomProblem;

/* A zero of either sign now and then: sums and clamps must keep them apart. */
static inline float any_number(uint32_t *seed, float size) {
    float kind = uniform(seed, 0, size > 0 ? 1 : 0.2f);
    if (kind < 0.1f) return 0.0f;
    if (kind < 0.2f) return -0.0f;
    return uniform(seed, -size, size);
}

static inline Vec2 any_vector(uint32_t *seed, float size) {
    float x = any_number(seed, size), y = any_number(seed, size);
    return vec2(x, y);
}

static inline ContactPoint random_point(uint32_t *seed, int a, int b, Vec2 normal, float friction) {
    return (ContactPoint){.a = a,
                          .b = b,
                          .normal = normal,
                          .arm_a = any_vector(seed, 2),
                          .arm_b = any_vector(seed, 2),
                          .mass_normal = uniform(seed, 0.01f, 0.2f),
                          .mass_tangent = uniform(seed, 0.01f, 0.2f),
                          .friction = friction,
                          .bias = any_number(seed, 1),
                          .warm_normal = fabsf(any_number(seed, 1)),
                          .warm_tangent = any_number(seed, 1)};
}

/* mass_exponent: inverse masses are spread over so many powers of ten. density: share of the pairs that touch. */
static inline void make_random(RandomProblem *random, uint32_t *seed, int bodies, float density, float mass_exponent) {
    for (int i = 0; i < bodies; i++) {
        bool fixed = uniform(seed, 0, 1) < 0.15f;
        float inverse = fixed ? 0.0f : powf(10, uniform(seed, -mass_exponent, 0));
        random->bodies[i] = (ProblemBody){.inv_mass = inverse,
                                          .inv_inertia = 3 * inverse,
                                          .velocity = any_vector(seed, 10),
                                          .angular_velocity = any_number(seed, 5)};
    }
    int contacts = 0;
    for (int a = 0; a < bodies; a++) {
        for (int b = a + 1; b < bodies && contacts + 3 <= CONTACTS_MAX; b++) {
            if (uniform(seed, 0, 1) > density) continue;
            float angle = uniform(seed, -3, 3), friction = fabsf(any_number(seed, 1));
            int points = 1 + (int)uniform(seed, 0, 2.99f);
            for (int k = 0; k < points; k++)
                random->contacts[contacts++] = random_point(seed, a, b, mat22_rotation(angle).column1, friction);
        }
    }
    random->problem = (ContactProblem){.body_count = bodies,
                                       .contact_count = contacts,
                                       .bomb = -1,
                                       .dt = world_dt,
                                       .bodies = random->bodies,
                                       .contacts = random->contacts};
}

/* All at rest, and nothing but zeros of either sign to compute with. */
static inline void calm_down(RandomProblem *random, uint32_t *seed) {
    for (int i = 0; i < random->problem.body_count; i++) {
        random->bodies[i].velocity = any_vector(seed, 0);
        random->bodies[i].angular_velocity = any_number(seed, 0);
    }
    for (int i = 0; i < random->problem.contact_count; i++) {
        random->contacts[i].bias = any_number(seed, 0);
        random->contacts[i].warm_normal = any_number(seed, 0);
        random->contacts[i].warm_tangent = any_number(seed, 0);
    }
}
