/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What stands of a struck scene, and how studies judge it by the converged run. */
#include "made.h"
#include "studies/trial.h"

#include "studies/stability.h"

enum { ROW = 4 };

/* A row of boxes that a bomb strikes; `fall` of them turn by a right angle, the next slides by 0.3 m. */
static VerdictReading struck_row(int fall, bool slides, bool moves, char words[TRAJECTORY_VERDICT_SIZE]) {
    Error error = {0};
    BodyDef defs[ROW + 1] = {{.size = {100, 20}, .fixed = true, .position = {0, -10}}};
    Body bodies[ROW + 2] = {trial_ground};
    ContactPoint contacts[ROW];
    Scene scene = {.gravity = {0, -10}, .dt = 1.0f / 60, .frames = 200, .body_count = ROW + 1, .bodies = defs};
    scene.bomb = (SceneBomb){.present = true, .frame = 10, .size = {1, 1}, .mass.value = 1};
    for (int i = 1; i <= ROW; i++) {
        defs[i] = (BodyDef){.size = {1, 1}, .mass = 1, .position = {(float)(2 * i), 0.5f}};
        bodies[i] = trial_box;
        bodies[i].position = defs[i].position;
        contacts[i - 1] = (ContactPoint){.a = 0, .b = i, .normal = {0, 1}};
    }
    bodies[ROW + 1] = trial_box;
    bodies[ROW + 1].position = vec2(-3, 0.5f);
    bodies[ROW + 1].velocity.x = 5; /* the bomb rolls on: it need not rest */
    SimulateVerdict verdict = {.scene = &scene, .method = "engine"};
    VerdictRun run = verdict_run_of(&scene);
    run.no_energy = true; /* what falls here is turned by hand */
    assert_ptr_equal(run.struck, &scene);
    assert_ok(verdict_watch_begin(&verdict.watch, &run, bodies, ROW + 1, &error), error);
    for (int frame = 1; frame <= 200; frame++) {
        for (int i = 1; i <= fall; i++)
            if (frame == 30 + 30 * i) bodies[i].angle = 1.5707964f;
        if (frame == 50 && slides) bodies[fall + 1].position.x += 0.3f;
        bodies[ROW].velocity.x = moves && frame > 190 ? 1 : 0;
        const int bomb = frame > 10 ? ROW + 1 : -1;
        if (bomb >= 0) contacts[ROW - 1] = (ContactPoint){.a = 0, .b = ROW, .normal = {0, 1}};
        const VerdictStep step = {frame, frame < 10 ? ROW + 1 : ROW + 2, ROW, bomb, bodies, contacts};
        if (bomb >= 0) verdict.watch.bodies[bomb].touched = true;
        assert_ok(verdict_watch_step(&verdict.watch, &step, &error), error);
    }
    assert_true(simulate_verdict_end(&verdict, &error));
    simulate_verdict_words(&verdict, words);
    simulate_verdict_free(&verdict);
    return verdict.reading;
}

TEST(what_stands_is_counted) {
    char words[TRAJECTORY_VERDICT_SIZE];
    assert_verdict(struck_row(0, false, false, words), VERDICT_STANDS);
    assert_string_equal(words, "stands");
    assert_verdict(struck_row(0, true, true, words), VERDICT_STANDS);
    assert_string_equal(words, "stands; 1 of 4 moved by 0.3 m; still moves at the end");
    assert_reading(struck_row(1, false, false, words), VERDICT_FALLS, 1, 60, 1, 0, "boxes");
    assert_string_equal(words, "falls: 1 of 4 boxes fell, first at 1 s");
    assert_reading(struck_row(2, true, false, words), VERDICT_COLLAPSES, 1, 60, 2, 0, "boxes");
    assert_string_equal(words, "collapses: 2 of 4 boxes fell, first at 1 s; 1 more moved by 0.3 m");
}

TEST(a_study_compares_with_the_truth) {
    const Method engine = method_named("engine"), reference = method_named("reference");
    static const Verdict stands[] = {VERDICT_STANDS, VERDICT_FALLS, VERDICT_COLLAPSES};
    for (int own = 0; own < 3; own++) {
        const VerdictReading struck = {.verdict = stands[own], .struck = true};
        for (int truth = 0; truth < 3; truth++) {
            const Verdict wanted = own < truth ? VERDICT_TOO_FEW : own > truth ? VERDICT_TOO_MANY : VERDICT_AGREES;
            assert_int_equal(stability_compare(&struck, stands[truth], &engine), wanted);
            assert_int_equal(stability_compare(&struck, stands[truth], &reference), stands[own]);
            assert_true(verdict_holds(wanted) == (own == truth));
        }
        assert_int_equal(stability_compare(&struck, VERDICT_UNDECIDED, &engine), VERDICT_UNDECIDED);
        assert_int_equal(stability_compare(&struck, VERDICT_SETTLES, &engine), stands[own]);
    }
    const VerdictReading unknown = {
        .verdict = VERDICT_STANDS, .struck = true, .fallbacks = {.not_converged = 1, .residual = 1}};
    assert_int_equal(stability_compare(&unknown, VERDICT_UNDECIDED, &reference), VERDICT_UNDECIDED);
    const VerdictReading explodes = {.verdict = VERDICT_EXPLODES}, early = {.verdict = VERDICT_FALLS};
    assert_int_equal(stability_compare(&explodes, VERDICT_COLLAPSES, &engine), VERDICT_EXPLODES);
    assert_int_equal(stability_compare(&early, VERDICT_COLLAPSES, &engine), VERDICT_FALLS);
}

/* A box whose centre is this far past the edge that it lies on, and a bomb far from it. */
static Verdict truth_at(float past, int frames) {
    BodyDef bodies[] = {{.size = {10, 2}, .fixed = true, .friction = 0.5f, .position = {-5, -1}},
                        {.size = {1, 1}, .mass = 1, .friction = 0.5f, .position = {past, 0.5f}}};
    Scene scene = scene_of_bodies(bodies, 2, frames);
    scene.bomb = (SceneBomb){.present = true, .frame = 1, .size = {1, 1}, .mass.value = 1, .x.value = -8, .y = 0.5f};
    const VerdictRun judged = verdict_run_of(&scene);
    Verdict truth;
    Convergence convergence = {0};
    Error error = {0};
    assert_ok(stability_truth(&scene, &judged, &truth, &convergence, &error), error);
    assert_int_equal(convergence.steps, (BORDER_SEEDS - 1) * frames);
    assert_int_equal(convergence.fallbacks.not_converged, 0);
    assert_true(bodies[1].position.x == past && scene.warm_starting);
    return truth;
}

/* Rigid boxes: the centre decides. On the edge, a micrometre does. */
TEST(near_the_edge_nothing_is_judged) {
    assert_int_equal(truth_at(-1e-4f, 600), VERDICT_STANDS);
    assert_int_equal(truth_at(1e-4f, 600), VERDICT_COLLAPSES);
    assert_int_equal(truth_at(0, 600), VERDICT_UNDECIDED);
}

RUN_TESTS(NULL, NULL)
