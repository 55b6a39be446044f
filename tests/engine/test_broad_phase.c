/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "uniform.h"

#include "engine/engine.h"

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

TEST(touching_pairs_are_found_near_the_origin) { no_touching_pair_is_lost(0, 8); }

TEST(touching_pairs_are_found_far_from_the_origin) { no_touching_pair_is_lost(1e6f, 8); }

TEST(pairs_rise_and_fixed_bodies_do_not_pair) {
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

/* A world in motion: bounds that drift, grow in number, and reach far. */
typedef struct Drift {
    const char *name;
    Vec2 spread;        /* m, either way */
    float far_away;     /* m */
    float size, widest; /* m; one in ten is up to the widest */
    float speed;        /* m a step */
} Drift;

static Bounds random_bounds(uint32_t *seed, const Drift *drift) {
    float largest = uniform(seed, 0, 1) < 0.1f ? drift->widest : drift->size;
    Vec2 half = vec2(uniform(seed, 0, largest), uniform(seed, 0, largest));
    Vec2 at = vec2(drift->far_away + uniform(seed, -drift->spread.x, drift->spread.x),
                   uniform(seed, -drift->spread.y, drift->spread.y));
    return (Bounds){vec2_sub(at, half), vec2_add(at, half)};
}

static void assert_same_pairs(const Drift *drift, const PairList *found, const PairList *expected) {
    if (found->count != expected->count ||
        (found->count > 0 && memcmp(found->pairs, expected->pairs, found->count * sizeof *found->pairs) != 0))
        fail_msg("%s: %zu pairs, or another order; %zu expected", drift->name, found->count, expected->count);
}

static void run_drift(const Drift *drift) {
    enum { MOST = 300, STEPS = 60 };
    static Bounds bounds[MOST];
    static bool fixed[MOST];
    uint32_t seed = 21;
    for (int i = 0; i < MOST; i++) {
        bounds[i] = random_bounds(&seed, drift);
        fixed[i] = uniform(&seed, 0, 1) < 0.2f;
    }
    SortAndSweep sweep = {0};
    PairList found = {0}, expected = {0};
    size_t pairs = 0;
    for (int step = 0; step < STEPS; step++) {
        int count = step < 50 ? 5 + 6 * step : 400 - 6 * step; /* bodies come, and another world may be smaller */
        if (count > MOST) count = MOST;
        for (int i = 0; i < count; i++) {
            Vec2 by = vec2(uniform(&seed, -drift->speed, drift->speed), uniform(&seed, -drift->speed, drift->speed));
            bounds[i] = (Bounds){vec2_add(bounds[i].low, by), vec2_add(bounds[i].high, by)};
        }
        assert_true(sort_and_sweep_find(&sweep, &found, bounds, fixed, count));
        assert_true(broad_phase_find(&expected, bounds, fixed, count));
        assert_same_pairs(drift, &found, &expected);
        pairs += found.count;
    }
    if (pairs < 100) fail_msg("%s: only %zu pairs", drift->name, pairs);
    sort_and_sweep_free(&sweep);
    free(found.pairs);
    free(expected.pairs);
}

TEST(sort_and_sweep_finds_the_pairs_of_the_plain_text) {
    const Drift drifts[] = {{"a heap", {10, 10}, 0, 1, 20, 0.1f},
                            {"a tower", {1, 200}, 0, 1, 3, 0.1f},
                            {"a row", {200, 1}, 0, 1, 3, 0.1f},
                            {"a row that becomes a tower", {20, 2}, 0, 1, 1, 6},
                            {"all in one place", {0, 0}, 0, 1, 1, 0},
                            {"grains", {0.01f, 0.01f}, 0, 1e-3f, 5e-3f, 1e-4f},
                            {"far from the origin", {8, 8}, 1e6f, 1, 1, 1},
                            {"one as large as the world", {1e5f, 1e5f}, 0, 1, 1e6f, 10},
                            {"so far that squares overflow", {1e30f, 1e30f}, 0, 1e29f, 1e30f, 1e29f}};
    for (size_t i = 0; i < sizeof drifts / sizeof drifts[0]; i++) run_drift(&drifts[i]);
}

TEST(bounds_hold_the_turned_box) {
    Box box = box_make(vec2(2, 3), vec2(2, 2), 0.25f * 3.14159265f);
    Bounds bounds = bounds_of_box(&box);
    assert_near(bounds.low.x, 2 - sqrtf(2), 1e-4f);
    assert_near(bounds.high.y, 3 + sqrtf(2), 1e-4f);
}

/* Bodies that come in any order cost as much as sorting does, n log n, not n^2; ties stay as they are. */
TEST(an_unsorted_list_is_sorted_in_few_moves) {
    enum { COUNT = 4000 };
    static Bounds bounds[COUNT];
    static const bool fixed[COUNT];
    uint32_t seed = 3;
    for (int reversed = 0; reversed < 2; reversed++) {
        SortAndSweep sweep = {0};
        PairList found = {0}, expected = {0};
        for (int i = 0; i < COUNT; i++) {
            float x = reversed ? (float)((COUNT - i) / 3) : (float)(int)uniform(&seed, 0, COUNT);
            bounds[i] = (Bounds){{x, 0}, {x + 1.5f, 1}};
        }
        assert_true(sort_and_sweep_find(&sweep, &found, bounds, fixed, COUNT));
        assert_true(broad_phase_find(&expected, bounds, fixed, COUNT));
        assert_int_equal(found.count, expected.count);
        assert_memory_equal(found.pairs, expected.pairs, found.count * sizeof *found.pairs);
        assert_in_range(sweep.moved, COUNT, 40 * COUNT);
        assert_true(sort_and_sweep_find(&sweep, &found, bounds, fixed, COUNT));
        assert_int_equal(sweep.moved, 0);
        sort_and_sweep_free(&sweep);
        free(found.pairs);
        free(expected.pairs);
    }
}

RUN_TESTS(NULL, NULL)
