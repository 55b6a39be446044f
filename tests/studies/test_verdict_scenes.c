/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Verdicts on runs of small scenes: what stands has not fallen, what moves has not settled. */
#include "made.h"
#include "studies/trial.h"

static Scene *scene_of_text(const char *bodies, int frames) {
    char text[2000];
    snprintf(text, sizeof text, "gravity: [0, -10]\ndt: 1/60\niterations: 10\nframes: %d\nbodies:\n%s", frames, bodies);
    return scene_from(write_bytes(temporary_path("scene.yaml"), text, strlen(text)));
}

static VerdictReading run_of(const char *bodies, int frames, const char *text) {
    OWN(Scene) *scene = scene_of_text(bodies, frames);
    const Method method = method_named(text);
    const VerdictRun run = verdict_run_of(scene);
    VerdictReading reading;
    Error error = {0};
    assert_ok(verdict_run(&reading, scene, &method, &run, &error), error);
    return reading;
}

#define GROUND "  - {static: true, size: [400, 20], position: [0, -10], friction: "

/* The boxes of the upper half fall freely while the lower ones give way to the slop, and touch again after it. */
TEST(a_pile_that_gives_way_below_has_not_fallen) {
    static const char stack[] = GROUND "0.2}\n  - {pattern: stack, count: 11, spacing: [0, 0.1], mass: 1, "
                                       "size: [0.1, 0.1], position: [0, 0.05]}\n";
    const VerdictReading reading = run_of(stack, 600, "interior");
    assert_verdict(reading, VERDICT_SETTLES);
    assert_int_equal(reading.count.fell, 0);
    assert_verdict(run_of(stack, 600, "engine"), VERDICT_FALLS); /* it does */
}

/* 36,000 frames of 10 m/s^2: 6 km/s, 1800 km below. */
TEST(free_fall_is_no_explosion) {
    assert_reading(run_of("  - {static: true, size: [2, 1], position: [0, -0.5]}\n"
                          "  - {mass: 1, size: [1, 1], position: [5, 0.5]}\n",
                          36000, "engine"),
                   VERDICT_FALLS, 1, 39, 2.17, 0.01, "m");
}

/* However light it is. */
TEST(what_slides_for_ever_moves) {
    const VerdictReading reading =
        run_of(GROUND "0}\n  - {mass: 0.000001, size: [1, 1], position: [-100, 0.5], friction: 0, "
                      "velocity: [14, 0]}\n",
               600, "engine");
    assert_reading(reading, VERDICT_MOVES, 1, 600, 14, 1e-3, "m/s");
}

/* The bomb starts in the box. */
TEST(a_refused_launch_is_no_failed_method) {
    OWN(Scene) *scene =
        scene_of_text(GROUND "0.2}\n  - {mass: 1, size: [1, 1], position: [0, 0.5]}\n"
                             "bomb: {x: 0, y: 0.5, size: [1, 1], mass: 1, velocity: [0, 0], frame: 5}\n",
                      20);
    const Method method = method_named("engine");
    const VerdictRun run = verdict_run_of(scene);
    VerdictReading reading;
    assert_refused(verdict_run(&reading, scene, &method, &run, &error), "the bomb would start ");
    assert_int_equal(error.failure, FAILURE_NONE);
}

RUN_TESTS(NULL, NULL)
