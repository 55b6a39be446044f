/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What contacts would do next, each as if it were alone. */
#include "worlds.h"
#include "testing.h"

#include "engine/uniform.h"
#include "methods/pair.h"

enum { BODIES = 6, CONTACTS = 2 * BODIES * BODIES };

typedef struct Example {
    ProblemBody bodies[BODIES];
    ContactPoint contacts[CONTACTS];
    ContactProblem problem;
    PairMoment moment;
} Example;

/* 1 / mass that a push along a direction meets at the point. */
static float effective_mass(const Example *example, const ContactPoint *contact, Vec2 direction) {
    const ProblemBody *a = &example->bodies[contact->a], *b = &example->bodies[contact->b];
    const float turn_a = vec2_cross(contact->arm_a, direction), turn_b = vec2_cross(contact->arm_b, direction);
    return 1 / (a->inv_mass + b->inv_mass + a->inv_inertia * turn_a * turn_a + b->inv_inertia * turn_b * turn_b);
}

static ContactPoint random_contact(const Example *example, uint32_t *seed, int a, int b, Vec2 normal) {
    ContactPoint contact = {.a = a,
                            .b = b,
                            .normal = normal,
                            .arm_a = {uniform(seed, -1, 1), uniform(seed, -1, 1)},
                            .arm_b = {uniform(seed, -1, 1), uniform(seed, -1, 1)},
                            .friction = uniform(seed, 0, 1),
                            .bias = uniform(seed, 0, 1)};
    contact.mass_normal = effective_mass(example, &contact, normal);
    contact.mass_tangent = effective_mass(example, &contact, vec2_cross_scalar(normal, 1));
    return contact;
}

/* Bodies of any masses, the first of them fixed, and about every second pair in one point or two; but not pair number
   left_out (-1: none). Velocities and impulses so far are in the moment. */
static void make_example(Example *example, uint32_t seed, int left_out) {
    Error error = {0};
    *example = (Example){.problem = {.body_count = BODIES, .bodies = example->bodies, .contacts = example->contacts}};
    for (int i = 1; i < BODIES; i++)
        example->bodies[i] = (ProblemBody){.inv_mass = uniform(&seed, 0.1f, 2), .inv_inertia = uniform(&seed, 0.1f, 9)};
    ContactImpulse so_far[CONTACTS];
    int count = 0, pair = 0;
    for (int a = 0; a < BODIES; a++)
        for (int b = a + 1; b < BODIES; b++) {
            if (uniform(&seed, 0, 1) < 0.5f) continue;
            const Vec2 normal = mat22_rotation(uniform(&seed, -3, 3)).column1;
            const int points = 1 + (uniform(&seed, 0, 1) < 0.5f);
            for (int k = 0; k < points; k++) {
                example->contacts[count] = random_contact(example, &seed, a, b, normal);
                const float pushed = uniform(&seed, 0, 2), most = example->contacts[count].friction * pushed;
                so_far[count] = (ContactImpulse){pushed, uniform(&seed, -most, most)};
                if (pair != left_out) count++;
            }
            pair++;
        }
    example->problem.contact_count = count;
    assert_ok(pair_moment_reserve(&example->moment, &example->problem) || error_memory(&error, "test"), error);
    memcpy(example->moment.impulses, so_far, (size_t)count * sizeof so_far[0]);
    for (int i = 0; i < BODIES; i++)
        example->moment.velocities[i] =
            (BodyVelocity){{uniform(&seed, -3, 3), uniform(&seed, -3, 3)}, uniform(&seed, -3, 3)};
}

/* The relative velocity at a contact after what it does to its bodies when there is no other; *push: its impulse. */
static Vec2 velocity_after(const Example *example, int i, ContactImpulse *push) {
    const ContactPoint *contact = &example->contacts[i];
    const ContactProblem alone = {
        .body_count = BODIES, .contact_count = 1, .bodies = example->bodies, .contacts = contact};
    BodyVelocity pushes[BODIES], after[2];
    PairMoment moment = example->moment;
    moment.impulses += i;
    moment.alone = push;
    moment.pushes = pushes;
    pair_moment_jacobi(&moment, &alone);
    const int bodies[2] = {contact->a, contact->b};
    for (int k = 0; k < 2; k++) {
        const BodyVelocity *before = &moment.velocities[bodies[k]], *change = &pushes[bodies[k]];
        after[k] = (BodyVelocity){vec2_add(before->linear, change->linear), before->angular + change->angular};
    }
    return pair_point_velocity(contact, &after[0], &after[1]);
}

/* Without friction its push along the normal is all there is: what approaches comes to the bias, what leaves faster is
   held by nothing. */
TEST(a_contact_alone_comes_to_its_bias) {
    int held = 0, let_go = 0;
    for (uint32_t seed = 1; seed <= 20; seed++) {
        static Example example;
        make_example(&example, seed, -1);
        for (int i = 0; i < example.problem.contact_count; i++) {
            example.contacts[i].friction = 0;
            example.moment.impulses[i].tangent = 0;
        }
        pair_moment_jacobi(&example.moment, &example.problem);
        for (int i = 0; i < example.problem.contact_count; i++) {
            ContactImpulse push;
            const float approach = velocity_after(&example, i, &push).x, bias = example.contacts[i].bias;
            const float total = example.moment.impulses[i].normal + push.normal;
            assert_true(total > -1e-6f);
            assert_near(push.tangent, 0, 0);
            assert_near(example.moment.alone[i].normal, push.normal, 0); /* whatever is around it */
            if (total > 1e-6f)
                assert_near(approach, bias, 1e-5);
            else
                assert_true(approach > bias - 1e-5f);
            held += total > 1e-6f;
            let_go += total <= 1e-6f;
        }
        pair_moment_free(&example.moment);
    }
    assert_true(held > 50 && let_go > 10);
}

TEST(pushes_keep_the_cone) {
    int sliding = 0, sticking = 0;
    for (uint32_t seed = 1; seed <= 20; seed++) {
        static Example example;
        make_example(&example, seed, -1);
        pair_moment_jacobi(&example.moment, &example.problem);
        for (int i = 0; i < example.problem.contact_count; i++) {
            const ContactPoint *contact = &example.contacts[i];
            const ContactImpulse before = example.moment.impulses[i], push = example.moment.alone[i];
            const float normal = before.normal + push.normal, tangent = before.tangent + push.tangent;
            assert_true(normal > -1e-6f && fabsf(tangent) <= contact->friction * normal + 1e-5f);
            if (fabsf(tangent) > contact->friction * normal - 1e-5f) {
                sliding++;
                continue;
            }
            const Vec2 velocity = pair_point_velocity(contact, &example.moment.velocities[contact->a],
                                                      &example.moment.velocities[contact->b]);
            assert_near(push.tangent, -contact->mass_tangent * velocity.y, 1e-5);
            sticking++;
        }
        pair_moment_free(&example.moment);
    }
    assert_true(sliding > 20 && sticking > 10);
}

/* What other pairs would do to a pair's bodies is what all would if this pair were not there. */
TEST(others_are_all_without_the_own) {
    int pairs = 0;
    for (uint32_t seed = 1; seed <= 20; seed++) {
        static Example all, without;
        make_example(&all, seed, -1);
        pair_moment_jacobi(&all.moment, &all.problem);
        for (int first = 0, pair = 0; first < all.problem.contact_count; pair++, pairs++) {
            make_example(&without, seed, pair);
            pair_moment_jacobi(&without.moment, &without.problem);
            const int bodies[2] = {all.contacts[first].a, all.contacts[first].b};
            for (int k = 0; k < 2; k++) {
                const BodyVelocity others = pair_moment_others(&all.moment, &all.problem, first, bodies[k]);
                const BodyVelocity *expected = &without.moment.pushes[bodies[k]];
                assert_velocity(others, expected->linear.x, expected->linear.y, expected->angular, 1e-4);
            }
            first += pair_contact_count(&all.problem, first);
            pair_moment_free(&without.moment);
        }
        pair_moment_free(&all.moment);
    }
    assert_true(pairs > 100);
}

RUN_TESTS(NULL, NULL)
