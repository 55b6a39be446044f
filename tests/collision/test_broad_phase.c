/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "uniform.h"

#include "collision/broad_phase.h"

enum { BOXES = 120 };

static bool has_pair(const PairList *list, int a, int b) {
    for (size_t i = 0; i < list->count; i++)
        if (list->pairs[i].a == a && list->pairs[i].b == b) return true;
    return false;
}

/* Every pair that the narrow phase would find is a candidate, also where float32 has few digits left. */
static void no_touching_pair_is_lost(float far_away, float spread) {
    uint32_t seed = 7;
    Box boxes[BOXES];
    Bounds bounds[BOXES];
    bool fixed[BOXES];
    for (int i = 0; i < BOXES; i++) {
        Vec2 position = vec2(far_away + uniform(&seed, -spread, spread), uniform(&seed, -spread, spread));
        boxes[i] = box_make(position, vec2(uniform(&seed, 0.1f, 2), uniform(&seed, 0.1f, 2)), uniform(&seed, -3, 3));
        bounds[i] = bounds_of_box(&boxes[i]);
        fixed[i] = i % 10 == 0;
    }
    PairList list = {0};
    assert_true(broad_phase_find(&list, bounds, fixed, BOXES));
    int touching = 0;
    for (int a = 0; a < BOXES; a++) {
        for (int b = a + 1; b < BOXES; b++) {
            Manifold manifold;
            manifold_compute(&manifold, &boxes[a], &boxes[b]);
            if (manifold.count == 0 || (fixed[a] && fixed[b])) continue;
            touching++;
            assert_true(has_pair(&list, a, b));
        }
    }
    assert_in_range(touching, 50, BOXES * BOXES / 4);
    /* Still a broad phase: it throws most pairs out. */
    assert_true(list.count < BOXES * BOXES / 4);
    free(list.pairs);
}

static void touching_pairs_are_found_near_the_origin(void **state) {
    (void)state;
    no_touching_pair_is_lost(0, 8);
}

static void touching_pairs_are_found_far_from_the_origin(void **state) {
    (void)state;
    no_touching_pair_is_lost(1e6f, 8);
}

static void pairs_rise_and_fixed_bodies_do_not_pair(void **state) {
    (void)state;
    Bounds all = {{-1, -1}, {1, 1}};
    const Bounds bounds[4] = {all, all, all, {{5, 5}, {6, 6}}};
    const bool fixed[4] = {true, false, true, false};
    PairList list = {0};
    assert_true(broad_phase_find(&list, bounds, fixed, 4));
    assert_int_equal(list.count, 2);
    assert_int_equal(list.pairs[0].a, 0);
    assert_int_equal(list.pairs[0].b, 1);
    assert_int_equal(list.pairs[1].a, 1);
    assert_int_equal(list.pairs[1].b, 2);
    free(list.pairs);
}

static void bounds_hold_the_turned_box(void **state) {
    (void)state;
    Box box = box_make(vec2(2, 3), vec2(2, 2), 0.25f * 3.14159265f);
    Bounds bounds = bounds_of_box(&box);
    assert_near(bounds.low.x, 2 - sqrtf(2), 1e-4f);
    assert_near(bounds.high.y, 3 + sqrtf(2), 1e-4f);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(touching_pairs_are_found_near_the_origin),
                                       cmocka_unit_test(touching_pairs_are_found_far_from_the_origin),
                                       cmocka_unit_test(pairs_rise_and_fixed_bodies_do_not_pair),
                                       cmocka_unit_test(bounds_hold_the_turned_box)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
