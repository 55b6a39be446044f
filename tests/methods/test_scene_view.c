/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How random contact problems look to networks of scene-net that know a part of their contacts. */
#include "scene_net_problems.h"

#include "engine/engine.h"
#include "methods/scene_net.h"

/* Bodies, and the share of their pairs that touch: none, few, many. */
static const struct {
    int bodies;
    float density;
} sizes[] = {{2, 1}, {3, 0}, {5, 0.5f}, {12, 0.3f}, {40, 0.1f}};
enum { SIZES = sizeof sizes / sizeof sizes[0] };

/* Calls check with a view of each problem; the view is one and the same, so stale numbers are met too. */
static void for_all(void (*check)(const SceneView *view, const SceneNet *network, const ContactProblem *problem)) {
    static RandomProblem random;
    SceneView view = {0};
    uint32_t seed = 1;
    for (int round = 0; round < 6; round++)
        for (int s = 0; s < SIZES; s++) {
            SceneNet *network = make_scene_net_problem(&random, &seed, sizes[s].bodies, sizes[s].density, 0.6f);
            assert_true(scene_view_take(&view, network, &random.problem));
            check(&view, network, &random.problem);
            scene_net_destroy(network);
        }
    scene_view_free(&view);
}

static int slot_of(const SceneNet *network, const ContactProblem *problem, const ContactPoint *contact) {
    return scene_net_find(network, contact->a, contact->b, scene_view_feature(problem, contact));
}

static void check_list(const SceneView *view, const SceneNet *network, const ContactProblem *problem) {
    const SceneNetView *slots = &view->slots;
    int k = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const int slot = slot_of(network, problem, contact);
        if (slot < 0) continue;
        assert_true(k < slots->slot_count);
        assert_int_equal(view->contacts[k], i);
        assert_int_equal(slots->slots[k], slot);
        assert_int_equal(slots->impulses[2 * k], 2 * slot);
        assert_int_equal(slots->impulses[2 * k + 1], 2 * slot + 1);
        assert_true(slots->ones[k] == 1);
        assert_memory_equal(&slots->warm[2 * k], &contact->warm_normal, sizeof(float));
        assert_memory_equal(&slots->warm[2 * k + 1], &contact->warm_tangent, sizeof(float));
        k++;
    }
    assert_int_equal(slots->slot_count, k);
}

TEST(what_has_a_slot_is_listed_in_the_order_of_contacts) { for_all(check_list); }

/* What lies within is taken as it is. */
static void check_base(const SceneView *view, const SceneNet *network, const ContactProblem *problem) {
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const ContactImpulse *base = &view->base[i];
        const int slot = slot_of(network, problem, contact);
        if (slot < 0) {
            assert_memory_equal(&base->normal, &contact->warm_normal, sizeof(float));
            assert_memory_equal(&base->tangent, &contact->warm_tangent, sizeof(float));
            continue;
        }
        const float most = contact->friction * base->normal;
        assert_true(base->normal >= 0 && base->normal <= network->cap[slot]);
        assert_true(fabsf(base->tangent) <= most);
        if (contact->warm_normal >= 0 && contact->warm_normal <= network->cap[slot])
            assert_true(base->normal == contact->warm_normal);
        else
            assert_true(base->normal == (contact->warm_normal < 0 ? 0 : network->cap[slot]));
        if (fabsf(contact->warm_tangent) <= most)
            assert_true(base->tangent == contact->warm_tangent);
        else
            assert_true(base->tangent == copysignf(most, contact->warm_tangent));
    }
}

TEST(the_start_is_the_nearest_within_cap_and_cone) { for_all(check_base); }

static void assert_body(const float numbers[SLOT_BODY_NUMBERS], const ProblemBody *body) {
    const float expected[SLOT_BODY_NUMBERS] = {body->position.x, body->position.y, body->angle,
                                               body->velocity.x, body->velocity.y, body->angular_velocity};
    assert_memory_equal(numbers, expected, sizeof expected);
}

static const double quarter = 1.5707963267948966;

/* By quarters, or halves of what is oblong, as far as it goes. */
static void assert_turned_back(const ProblemBody *bomb, float seen) {
    const double step = bomb->size.x == bomb->size.y ? quarter : 2 * quarter;
    const double turns = ((double)bomb->angle - (double)seen) / step;
    assert_true(fabs(turns - round(turns)) < 1e-6 * (1 + fabs((double)bomb->angle)));
    assert_true(fabs((double)seen) <= step / 2 * (1 + 1e-6));
}

static void check_state(const SceneView *view, const SceneNet *network, const ContactProblem *problem) {
    const float *next = view->slots.state;
    const ProblemBody *bomb = &problem->bodies[network->bomb];
    ProblemBody seen = *bomb;
    seen.angle = view->slots.bomb[2];
    assert_body(view->slots.bomb, &seen);
    assert_turned_back(bomb, seen.angle);
    for (int i = 0; i < problem->body_count; i++) {
        if (i == network->bomb) continue;
        assert_body(next, &problem->bodies[i]);
        next += SLOT_BODY_NUMBERS;
    }
    assert_int_equal(next - view->slots.state, network->state.from);
}

TEST(the_state_leaves_out_the_bomb_only) { for_all(check_state); }

/* Features of a bomb at that angle upon a box, as seen, sorted; 0 where there are fewer. */
static int see_features(uint32_t seen[2], const Box *box, Vec2 position, Vec2 size, float angle) {
    const Box bomb = box_make(position, size, angle);
    Manifold manifold = {0};
    manifold_compute(&manifold, box, &bomb);
    ProblemBody bodies[2] = {0};
    bodies[1].size = size;
    bodies[1].angle = angle;
    const ContactProblem problem = {.body_count = 2, .bodies = bodies, .bomb = 1};
    for (int i = 0; i < manifold.count; i++)
        seen[i] = scene_view_feature(&problem, &(ContactPoint){.a = 0, .b = 1, .feature = manifold.points[i].feature});
    if (manifold.count == 2 && seen[0] > seen[1]) {
        const uint32_t first = seen[0];
        seen[0] = seen[1];
        seen[1] = first;
    }
    return manifold.count;
}

/* What a turn of a quarter leaves as it looks has the same features, seen from any quarter; an oblong one by halves. */
TEST(a_turned_bomb_is_seen_as_before) {
    uint32_t seed = 11;
    int touched[2] = {0, 0};
    for (int i = 0; i < 4000; i++) {
        const Box box = box_make(vec2(0, 0), vec2(uniform(&seed, 1, 3), 1), uniform(&seed, -3, 3));
        const Vec2 position = vec2(uniform(&seed, -2, 2), uniform(&seed, -2, 2));
        const bool oblong = i % 2 == 1;
        const float angle = uniform(&seed, -0.7f, 0.7f);
        uint32_t as_is[2], turned[2];
        const int count = see_features(as_is, &box, position, vec2(1, oblong ? 2 : 1), angle);
        touched[oblong] += count > 0;
        for (int turns = -9; turns <= 9; turns++) {
            const double by = (oblong ? 2 : 1) * turns * quarter;
            /* Rounding of the turned corners: a touch may come or go, or a tie be broken the other way. */
            const int same = see_features(turned, &box, position, vec2(1, oblong ? 2 : 1), (float)((double)angle + by));
            if (same != count || count == 0) continue;
            if (memcmp(as_is, turned, (size_t)count * sizeof *turned) != 0)
                fail_msg("turned %d times from %g: %08x, not %08x", turns, (double)angle, turned[0], as_is[0]);
        }
    }
    assert_true(touched[0] > 500 && touched[1] > 500);
}

/* Edges that no box has, as a file may say, stay what they are; so do features of others, and all without a bomb. */
TEST(other_features_stay) {
    ProblemBody bodies[3] = {0};
    bodies[2].size = vec2(1, 1);
    bodies[2].angle = 1.6f;
    ContactProblem problem = {.body_count = 3, .bodies = bodies, .bomb = 2};
    assert_int_equal(scene_view_feature(&problem, &(ContactPoint){.a = 0, .b = 1, .feature = 0x01020304}), 0x01020304);
    assert_int_equal(scene_view_feature(&problem, &(ContactPoint){.a = 0, .b = 2, .feature = 0x00ff0304}), 0x00ff0304);
    assert_int_equal(scene_view_feature(&problem, &(ContactPoint){.a = 0, .b = 2, .feature = 0x04010304}), 0x01020304);
    problem.bomb = 0;
    bodies[0] = bodies[2];
    assert_int_equal(scene_view_feature(&problem, &(ContactPoint){.a = 0, .b = 2, .feature = 0x04010304}), 0x04010401);
    problem.bomb = -1;
    assert_int_equal(scene_view_feature(&problem, &(ContactPoint){.a = 0, .b = 2, .feature = 0x04010304}), 0x04010304);
}

/* Else the laws above would hold of nothing. */
static int with_slot, without_slot, capped, outside;

static void count_cases(const SceneView *view, const SceneNet *network, const ContactProblem *problem) {
    (void)view;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const int slot = slot_of(network, problem, contact);
        with_slot += slot >= 0;
        without_slot += slot < 0;
        capped += slot >= 0 && contact->warm_normal > network->cap[slot];
        outside += slot >= 0 && fabsf(contact->warm_tangent) > contact->friction * contact->warm_normal;
    }
}

TEST(every_case_is_among_the_problems) {
    for_all(count_cases);
    assert_true(with_slot > 100 && without_slot > 100 && capped > 100 && outside > 100);
}

RUN_TESTS(NULL, NULL)
