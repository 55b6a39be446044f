/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Growth of a distance: exponentials, whose rate is known. */
#include "made.h"
#include "files.h"
#include "runs/compare_runs.h"
#include "runs/divergence.h"
#include "runs/trajectory.h"

enum { FRAMES = 200 };

static const double DT = 1.0 / 60;
static double distance[FRAMES];

static void fill(double start, double rate) {
    for (int frame = 0; frame < FRAMES; frame++) distance[frame] = start * exp(rate * frame * DT);
}

static Growth measured(int from, int end) {
    Growth growth;
    Error error = {0};
    assert_ok(growth_measure(distance, from, end, DT, &growth, &error), error);
    return growth;
}

TEST(an_exponential_has_its_rate) {
    for (double rate = -3; rate <= 3; rate += 0.75) {
        fill(1e-6, rate);
        Growth growth = measured(0, FRAMES);
        assert_near(growth.rate, rate, 1e-9);
        assert_near(growth.scatter, 0, 1e-9);
        assert_true(growth.first == 0 && growth.last == FRAMES - 1 && growth.end == FRAMES && !growth.saturated);
        assert_int_equal(growth.count, FRAMES);
        if (rate != 0) assert_near(growth_doubling(&growth, DT), 60 * log(2) / rate, 1e-6);
    }
}

/* The same by two trajectories, whose floats lie far enough from each other to be fine. */
TEST(trajectories_that_part_exponentially) {
    OWN(Trajectory) *a = run_sized(FRAMES, 1), *b = run_sized(FRAMES, 1);
    for (int frame = 0; frame < FRAMES; frame++) {
        a->position[frame] = vec2(0, 0);
        b->position[frame] = vec2(0, (float)(1e-5 * exp(2 * frame * DT)));
        distance[frame] = trajectory_distance(a, b, frame);
    }
    assert_near(measured(0, FRAMES).rate, 2, 1e-6);
}

/* From 1e-6 m by a factor of 2 a frame: 0.1 m is passed in frame 17, as 2^17 = 131072. */
TEST(what_is_saturated_does_not_count) {
    fill(1e-6, 60 * log(2));
    Growth growth = measured(0, FRAMES);
    assert_true(growth.saturated && growth.last == 16 && growth.end == 17 && growth.count == 17);
    assert_near(growth_doubling(&growth, DT), 1, 1e-9);
    assert_near(growth.from, 1e-6, 1e-18);
    assert_near(growth.to, 65536e-6, 1e-12);
    growth = measured(20, FRAMES);
    assert_true(growth.saturated && growth.first == -1 && growth.end == 20 && growth.count == 0 && isnan(growth.rate));
}

/* A scatter of s up and down in turns is one of s, whatever the rate. */
TEST(the_scatter_is_that_of_the_logarithm) {
    fill(1e-6, 2);
    for (int frame = 0; frame < FRAMES; frame++) distance[frame] *= exp(frame % 2 == 0 ? 0.1 : -0.1);
    assert_near(measured(0, FRAMES).scatter, 0.1, 1e-4);
}

/* In 101 frames of 10 ms: ln 2 = 0.69 a second doubles once. */
TEST(verdicts) {
    static const struct {
        double rate, shifted;
        GrowthVerdict verdict;
    } cases[] = {{2, 2, GROWTH_SAME},       {2, 1.01, GROWTH_SAME},     {2, 3.99, GROWTH_SAME},
                 {2, 0.99, GROWTH_FASTER},  {2, 4.01, GROWTH_SLOWER},   {2, 0, GROWTH_FASTER},
                 {2, -2, GROWTH_FASTER},    {-2, 2, GROWTH_SLOWER},     {0.6, 0.8, GROWTH_SLOWER},
                 {0.8, 0.6, GROWTH_FASTER}, {0.6, 0.1, GROWTH_NEITHER}, {-1, -2, GROWTH_NEITHER},
                 {NAN, 2, GROWTH_UNKNOWN},  {2, NAN, GROWTH_UNKNOWN}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        Growth growth = {.first = 50, .last = 150, .rate = cases[i].rate};
        Growth shifted = {.first = 50, .last = 150, .rate = cases[i].shifted};
        if (growth_compare(&growth, &shifted, 0.01) != cases[i].verdict)
            fail_msg("%g against %g", cases[i].rate, cases[i].shifted);
    }
}

static void expect_table(const DistanceTable *table, const char *expected) {
    Error error = {0};
    const char *path = temporary_path("distance.csv");
    assert_ok(distance_table_write(table, path, &error), error);
    assert_file(path, expected);
}

TEST(tables) {
    const double of_both[] = {0, 0.125, 3e-9}, shifted[] = {1e-6, 0.25, NAN};
    expect_table(&(DistanceTable){3, 0.5, of_both, shifted},
                 "frame,time,distance,shifted_distance\n0,0,0,1e-06\n1,0.5,0.125,0.25\n2,1,3e-09,\n");
    expect_table(&(DistanceTable){2, 0.5, of_both, NULL},
                 "frame,time,distance,shifted_distance\n0,0,0,\n1,0.5,0.125,\n");
    assert_false(distance_table_write(&(DistanceTable){2, 0.5, of_both, NULL}, "/nowhere/distance.csv", &error));
    assert_error(error, ERROR_SYSTEM, "/nowhere/distance.csv");
}

RUN_TESTS(NULL, NULL)
