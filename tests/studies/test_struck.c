/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What studies show of a struck scene, beside the converged run. */
#include "made.h"

#include "studies/stability.h"

TEST(a_study_shows_what_a_run_does) {
    const Method engine = method_named("engine"), reference = method_named("reference");
    static const Verdict stands[] = {VERDICT_STANDS, VERDICT_FALLS, VERDICT_COLLAPSES};
    for (int own = 0; own < 3; own++) {
        const VerdictReading struck = {.verdict = stands[own], .struck = true};
        for (int truth = 0; truth < 3; truth++) {
            assert_int_equal(stability_compare(&struck, stands[truth], &engine), stands[own]);
            assert_int_equal(stability_compare(&struck, stands[truth], &reference), stands[own]);
        }
        assert_true(verdict_holds(stands[own]) == (own == 0));
        assert_int_equal(stability_compare(&struck, VERDICT_UNDECIDED, &engine), stands[own]);
        assert_int_equal(stability_compare(&struck, VERDICT_UNDECIDED, &reference), VERDICT_UNDECIDED);
    }
    const VerdictReading unknown = {
        .verdict = VERDICT_STANDS, .struck = true, .fallbacks = {.not_converged = 1, .residual = 1}};
    assert_int_equal(stability_compare(&unknown, VERDICT_STANDS, &reference), VERDICT_UNDECIDED);
    for (Verdict unsound = VERDICT_HANGS; unsound < VERDICTS; unsound++) {
        const VerdictReading reading = {.verdict = unsound, .struck = true};
        assert_int_equal(stability_compare(&reading, VERDICT_COLLAPSES, &engine), unsound);
        assert_int_equal(stability_compare(&reading, VERDICT_UNDECIDED, &reference), unsound);
    }
}

/* A box whose centre is this far past the edge that it lies on, and a bomb far from it. */
static Verdict truth_at(float past, int frames) {
    BodyDef bodies[] = {{.size = {10, 2}, .fixed = true, .friction = 0.5f, .position = {-5, -1}},
                        {.size = {1, 1}, .mass = 1, .friction = 0.5f, .position = {past, 0.5f}}};
    Scene scene = scene_of_bodies(bodies, 2, frames);
    scene.bomb = (SceneBomb){.present = true, .frame = 1, .size = {1, 1}, .mass.value = 1, .x.value = -8, .y = 0.5f};
    ConvergedRun run = {0};
    Error error = {0};
    assert_ok(stability_truth(&scene, &run, &error), error);
    assert_int_equal(run.steps, BORDER_SEEDS * frames);
    assert_int_equal(run.fallbacks.not_converged, 0);
    assert_true(bodies[1].position.x == past && scene.warm_starting);
    return run.truth;
}

/* Rigid boxes: the centre decides. On the edge, a micrometre does. */
TEST(near_the_edge_nothing_is_judged) {
    assert_int_equal(truth_at(-1e-4f, 600), VERDICT_STANDS);
    assert_int_equal(truth_at(1e-4f, 600), VERDICT_FALLS); /* by itself: the bomb touches nothing */
    assert_int_equal(truth_at(0, 600), VERDICT_UNDECIDED);
}

RUN_TESTS(NULL, NULL)
