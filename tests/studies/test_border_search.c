/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Borders of known functions: their values, their order, and undecided values. */
#include "testing.h"

#include "studies/stability.h"

/* Fails, as `how`, in the intervals [from, to]; in the undecided interval only for failing_seed (-1: no such
   interval). */
typedef struct Made {
    double from[3], to[3];
    int intervals;
    double undecided_from, undecided_to;
    int failing_seed;
    Verdict how;
    int calls;
} Made;

static bool evaluate(void *context, double value, int seed, Verdict *verdict, Error *error) {
    Made *made = context;
    made->calls++;
    if (made->how == VERDICTS) return error_input(error, "made", "refused");
    *verdict = value > 5 ? VERDICT_MOVES : VERDICT_SETTLES;
    for (int i = 0; i < made->intervals; i++)
        if (value >= made->from[i] && value <= made->to[i]) *verdict = made->how;
    if (made->failing_seed >= 0 && value >= made->undecided_from && value <= made->undecided_to)
        *verdict = seed == made->failing_seed ? VERDICT_EXPLODES : VERDICT_SETTLES;
    return true;
}

static BorderList search(const BorderScan *scan, Made *made) {
    Error error = {0};
    BorderList list;
    assert_ok(border_search(&list, scan, &(BorderProbe){evaluate, made, BORDER_SEEDS}, &error), error);
    return list;
}

/* These borders and no others. */
#define expect_borders(scan, made, ...) \
    check_borders(scan, made, (const Border[]){__VA_ARGS__}, sizeof((const Border[]){__VA_ARGS__}) / sizeof(Border))

static void check_borders(const BorderScan *scan, Made *made, const Border *expected, size_t count) {
    const BorderList list = search(scan, made);
    assert_int_equal(list.count, count);
    for (size_t i = 0; i < count; i++) {
        const Border *found = &list.items[i];
        assert_true(found->holds_at == expected[i].holds_at || (isnan(found->holds_at) && isnan(expected[i].holds_at)));
        assert_true(found->fails_at == expected[i].fails_at || (isnan(found->fails_at) && isnan(expected[i].fails_at)));
        assert_int_equal(found->verdict, expected[i].verdict);
    }
}

static const BorderScan heights = {.from = 2, .to = 40, .points = 10, .whole = true},
                        backwards = {.from = 2, .to = 40, .points = 10, .whole = true, .fails_low = true};

TEST(one_border_is_found_to_the_unit) {
    for (int first = 3; first <= 40; first++) {
        Made made = {.from = {first}, .to = {99}, .intervals = 1, .failing_seed = -1, .how = VERDICT_FALLS};
        expect_borders(&heights, &made, {first - 1, first, VERDICT_FALLS});
        assert_true(made.calls <= 10 + 3 + 4 + 6); /* scan, bisection of a step of 5, seeds, two values beside */
    }
}

TEST(linear_is_found_to_a_hundredth_of_the_range) {
    const BorderScan scan = {.from = 0, .to = 0.6, .points = 7};
    Made made = {.from = {0.2345}, .to = {1}, .intervals = 1, .failing_seed = -1, .how = VERDICT_FALLS};
    BorderList list = search(&scan, &made);
    assert_int_equal(list.count, 1);
    const Border *border = &list.items[0];
    assert_true(border->holds_at < 0.2345 && border->fails_at >= 0.2345);
    assert_true(border->fails_at - border->holds_at <= 0.006);
}

/* Iterations: fails at low values, holds from 17. 16 and 17 are neighbours, although their ratio is 1.06. */
TEST(logarithmic_is_found_to_a_factor) {
    const BorderScan counts = {
        .from = 1, .to = 100, .points = 8, .logarithmic = true, .whole = true, .fails_low = true};
    const BorderScan ratios = {.from = 1, .to = 1000, .points = 10, .logarithmic = true};
    Made few = {.from = {0}, .to = {16}, .intervals = 1, .failing_seed = -1, .how = VERDICT_SINKS};
    Made heavy = {.from = {77.7}, .to = {1e9}, .intervals = 1, .failing_seed = -1, .how = VERDICT_FALLS};
    expect_borders(&counts, &few, {17, 16, VERDICT_SINKS});
    const BorderList list = search(&ratios, &heavy);
    assert_int_equal(list.count, 1);
    assert_true(list.items[0].holds_at < 77.7 && list.items[0].fails_at >= 77.7);
    assert_true(list.items[0].fails_at <= 1.05 * list.items[0].holds_at);
}

/* Holds to 9, fails from 10 to 20, holds to 30, fails from 31. */
TEST(all_borders_are_listed) {
    Made made = {.from = {10, 31}, .to = {20, 99}, .intervals = 2, .failing_seed = -1, .how = VERDICT_FALLS};
    expect_borders(&heights, &made, {9, 10, VERDICT_FALLS}, {21, 20, VERDICT_FALLS}, {30, 31, VERDICT_FALLS});
    expect_borders(&backwards, &made, {30, 31, VERDICT_FALLS}, {21, 20, VERDICT_FALLS}, {9, 10, VERDICT_FALLS});
}

/* Holds to 21 except at 20, which a scan of ..., 19, 23, ... and a bisection at 21 miss. */
TEST(a_hole_beside_a_border_is_found) {
    Made made = {.from = {20, 22}, .to = {20, 99}, .intervals = 2, .failing_seed = -1, .how = VERDICT_FALLS};
    expect_borders(&heights, &made, {19, 20, VERDICT_FALLS}, {21, 20, VERDICT_FALLS}, {21, 22, VERDICT_FALLS});
}

TEST(without_a_border_there_is_one_side) {
    Made holds = {.failing_seed = -1, .how = VERDICT_FALLS};
    Made fails = {.from = {0}, .to = {99}, .intervals = 1, .failing_seed = -1, .how = VERDICT_TUNNELS};
    expect_borders(&heights, &holds, {40, NAN, VERDICT_MOVES});
    expect_borders(&backwards, &holds, {2, NAN, VERDICT_MOVES});
    expect_borders(&heights, &fails, {NAN, 2, VERDICT_TUNNELS});
    expect_borders(&backwards, &fails, {NAN, 40, VERDICT_TUNNELS});
    assert_int_equal(holds.calls, 2 * 10);
}

/* Holds to 14 and fails from 20; between them, one of three seeds explodes. */
TEST(undecided_values_are_no_side_of_a_border) {
    for (int seed = 0; seed < BORDER_SEEDS; seed++) {
        Made made = {.from = {20},
                     .to = {99},
                     .intervals = 1,
                     .undecided_from = 15,
                     .undecided_to = 19,
                     .failing_seed = seed,
                     .how = VERDICT_FALLS};
        expect_borders(&heights, &made, {14, 20, VERDICT_FALLS});
    }
}

/* From 33 on only the first seed explodes. */
TEST(undecided_values_at_the_end_are_reported) {
    Made made = {.undecided_from = 33, .undecided_to = 99, .failing_seed = 0, .how = VERDICT_FALLS};
    expect_borders(&heights, &made, {32, NAN, VERDICT_EXPLODES});
    made =
        (Made){.from = {8}, .to = {12}, .intervals = 1, .undecided_from = 33, .undecided_to = 99, .how = VERDICT_FALLS};
    expect_borders(&heights, &made, {7, 8, VERDICT_FALLS}, {13, 12, VERDICT_FALLS}, {32, NAN, VERDICT_EXPLODES});
}

/* From 19 to 26 only the first seed explodes; all other values hold. */
TEST(undecided_values_in_the_middle_end_what_holds) {
    Made made = {.undecided_from = 19, .undecided_to = 26, .failing_seed = 0, .how = VERDICT_FALLS};
    expect_borders(&heights, &made, {18, NAN, VERDICT_EXPLODES});
    expect_borders(&backwards, &made, {27, NAN, VERDICT_EXPLODES});
}

TEST(values_are_rounded_as_in_tables) {
    double values[BORDER_POINTS_MAX];
    const BorderScan few = {.from = 1, .to = 4, .points = 9, .logarithmic = true, .whole = true};
    assert_int_equal(border_scan_values(&few, values), 4);
    for (int i = 0; i < 4; i++) assert_near(values[i], i + 1, 0);
    const BorderScan ratios = {.from = 1, .to = 1000, .points = 10, .logarithmic = true};
    assert_int_equal(border_scan_values(&ratios, values), 10);
    assert_near(values[4], 21.54, 0); /* 1000^(4/9) = 21.5443 */
    assert_near(values[9], 1000, 0);
}

TEST(a_failing_evaluation_ends_the_search) {
    BorderList list;
    Made made = {.how = VERDICTS};
    assert_refused(border_search(&list, &heights, &(BorderProbe){evaluate, &made, 1}, &error), "refused");
    assert_int_equal(made.calls, 1);
}

RUN_TESTS(NULL, NULL)
