/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures of synthetic logs. */
#include "made.h"

#include "studies/closed_loop.h"
#include "studies/rollout.h"
#include "studies/statistics.h"

OWNED_VALUE(RunLog, run_log_free)

enum { FRAMES = 10, BODIES = 3 };

/* A ground and two boxes; the bomb is added after step 2 and touches in step 5; 2 impact frames. */
static const BodyDef defs[BODIES] = {
    {.size = {100, 20}, .fixed = true}, {.size = {1, 1}, .mass = 1}, {.size = {1, 1}, .mass = 1}};
static Scene scene_by_hand(void) {
    Scene scene = {.dt = 0.5f, .frames = FRAMES, .body_count = BODIES, .bodies = (BodyDef *)defs, .gravity = {0, -10}};
    scene.bomb.present = true;
    scene.bomb.frame = 2;
    return scene;
}

typedef struct Handmade {
    Vec2 position[(FRAMES + 1) * BODIES];
    LoggedFrame at[FRAMES + 1];
} Handmade;

static RunLog log_by_hand(Handmade *made) {
    for (int frame = 0; frame <= FRAMES; frame++) {
        for (int body = 0; body < BODIES; body++) made->position[frame * BODIES + body] = vec2((float)body, 0);
        made->at[frame] = (LoggedFrame){100, 0.01,
                                        frame < 5   ? PHASE_REST
                                        : frame < 7 ? PHASE_IMPACT
                                                    : PHASE_AFTER,
                                        vec2(0, 0)};
    }
    return (RunLog){.bodies = BODIES,
                    .frames = FRAMES,
                    .touch = 5,
                    .launch_frame = 2,
                    .end_frame = FRAMES,
                    .position = made->position,
                    .at = made->at};
}

/* The converged run is one until frame 5, the first of the impact. */
TEST(nothing_is_compared_with_steps_that_did_not_converge) {
    Handmade a, b;
    const Scene scene = scene_by_hand();
    const RunLog log = log_by_hand(&a);
    RunLog converged = log_by_hand(&b);
    a.at[5].energy += 4;
    a.at[8].penetration = 0.5;
    for (int frame = 6; frame <= FRAMES; frame++) a.at[frame].energy += 1000;
    converged.unconverged = 2;
    converged.first_unconverged = 6;
    RunMeasures measures = run_measures(&log, &converged, &scene);
    assert_near(measures.energy[PHASE_REST], 0, 0);
    assert_near(measures.energy[PHASE_IMPACT], 4, 0);
    assert_true(isnan(measures.energy[PHASE_AFTER]));
    assert_near(measures.penetration[PHASE_AFTER], 0.5, 0);
    assert_near(measures.drift, 0, 0);
    converged.first_unconverged = 4; /* before the touch, where drift is measured */
    measures = run_measures(&log, &converged, &scene);
    assert_true(isnan(measures.drift) && isnan(measures.energy[PHASE_IMPACT]));
}

/* A box in a V that its friction holds apart from. */
TEST(steps_that_did_not_converge_are_counted) {
    OWN(Scene) *scene = scene_from(SOURCE_DIR "/tests/methods/scenes/wedge_launches.yaml");
    OWN(RunLog) log = {0};
    assert_ok(closed_loop_log(&log, "reference", scene, &error), error);
    assert_in_range(log.unconverged, 10, 50);
    assert_int_equal(log.unconverged, scene->frames + 1 - log.first_unconverged);
    assert_ok(closed_loop_log(&log, "engine", scene, &error), error);
    assert_int_equal(log.unconverged, 0);
}

TEST(differences_are_assigned_to_their_phase) {
    Handmade a, b;
    const Scene scene = scene_by_hand();
    const RunLog log = log_by_hand(&a), converged = log_by_hand(&b);
    a.at[5].energy = 104;                            /* impact: (4 + 0) / 2 */
    a.at[10].energy = 108;                           /* after: 8 / 4 */
    a.at[6].penetration = 0.3;                       /* impact */
    a.position[4 * BODIES + 1] = vec2(1.03f, 0.04f); /* just before the touch: 0.05 of one box of two */
    a.position[10 * BODIES + 1] = vec2(1.6f, 0);     /* 0.6 m in the end */
    a.position[10 * BODIES + 2] = vec2(2.4f, 0);     /* 0.4 m: has not moved */
    a.position[10 * BODIES + 0] = vec2(9, 0);        /* the ground does not count */
    RunMeasures measures = run_measures(&log, &converged, &scene);
    assert_near(measures.energy[PHASE_IMPACT], 2, 1e-12);
    assert_near(measures.energy[PHASE_AFTER], 2, 1e-12);
    assert_near(measures.energy[PHASE_REST], 0, 0);
    assert_near(measures.penetration[PHASE_IMPACT], 0.3, 0);
    assert_near(measures.penetration[PHASE_AFTER], 0.01, 0);
    assert_near(measures.drift, 0.025, 1e-6);
    assert_near(measures.moved, 1, 0);
    /* 0.05, 0.6 and 0.4 m, of two boxes in ten frames, and two coordinates. */
    assert_near(measures.rollout_mse, (0.0025 + 0.36 + 0.16) / 40, 1e-7);
}

/* One run's bomb touches in step 5, the other's in 7: the drift is that of step 4, whichever came first. */
TEST(drift_ends_before_the_first_touch) {
    for (int first = 0; first < 2; first++) {
        Handmade a, b;
        const Scene scene = scene_by_hand();
        RunLog log = log_by_hand(&a), converged = log_by_hand(&b);
        *(first == 0 ? &log.touch : &converged.touch) = 7;
        a.position[4 * BODIES + 1] = vec2(1.5f, 0);
        for (int frame = 5; frame <= FRAMES; frame++) a.position[frame * BODIES + 1] = vec2(9, 0);
        assert_near(run_measures(&log, &converged, &scene).drift, 0.25, 1e-6);
    }
}

/* Both runs lose the same, each step more. */
TEST(energy_is_compared_at_the_same_frame) {
    Handmade a, b;
    const Scene scene = scene_by_hand();
    const RunLog log = log_by_hand(&a), converged = log_by_hand(&b);
    for (int frame = 0; frame <= FRAMES; frame++) a.at[frame].energy = b.at[frame].energy = -frame * frame;
    const RunMeasures measures = run_measures(&log, &converged, &scene);
    for (int phase = 0; phase < PHASES; phase++) assert_near(measures.energy[phase], 0, 0);
}

TEST(motion_before_the_launch_is_not_counted) {
    Handmade a, b;
    const Scene scene = scene_by_hand();
    const RunLog log = log_by_hand(&a), converged = log_by_hand(&b);
    for (int frame = 2; frame <= FRAMES; frame++) a.position[frame * BODIES + 1] = vec2(7, 0);
    assert_near(run_measures(&log, &converged, &scene).moved, 0, 0);
}

TEST(in_a_run_that_ended_early_all_boxes_moved) {
    Handmade a, b;
    const Scene scene = scene_by_hand();
    RunLog log = log_by_hand(&a), converged = log_by_hand(&b);
    log.frames = 3;
    log.touch = 0;
    RunMeasures measures = run_measures(&log, &converged, &scene);
    assert_near(measures.moved, 2, 0);
    assert_true(isnan(measures.energy[PHASE_IMPACT]));
    assert_true(isnan(measures.penetration[PHASE_AFTER]));
    assert_near(measures.energy[PHASE_REST], 0, 0);
    assert_true(isnan(measures.drift));
}

TEST(runs_part_where_a_body_or_the_bomb_is_away) {
    Handmade a, b;
    RunLog log = log_by_hand(&a), other = log_by_hand(&b);
    assert_int_equal(run_log_apart(&log, &other, 0.1, FRAMES), FRAMES); /* never */
    a.at[9].bomb = vec2(0, 0.2f);
    assert_int_equal(run_log_apart(&log, &other, 0.1, FRAMES), 9);
    a.position[7 * BODIES + 2] = vec2(2.05f, 0); /* near enough */
    b.position[8 * BODIES + 1] = vec2(1, -0.2f);
    assert_int_equal(run_log_apart(&log, &other, 0.1, FRAMES), 8);
    log.frames = 3; /* NaN in step 4 */
    assert_int_equal(run_log_apart(&log, &other, 0.1, FRAMES), 4);
    assert_int_equal(run_log_apart(&log, &other, 0.1, 2), 2);
}

/* Two steps: one creates 0.5 N s and falls back, the other clamps an impulse to its cone, which is no fallback. */
TEST(momentum_and_fallbacks_are_added) {
    BodyDef box = {.size = {1, 1}, .mass = 1};
    const Scene scene = {.dt = 0.5f, .frames = 2, .body_count = 1, .bodies = &box};
    OWN(World) *world = world_of(&scene);
    OWN(RunLog) log = {0};
    assert_true(run_log_begin(&log, &scene, world));
    for (int frame = 1; frame <= 2; frame++) {
        ContactProblem problem;
        ContactSolution *solution;
        assert_ok(world_begin_step(world, scene.dt, &problem, &solution, &error), error);
        solution->velocities[0] = (BodyVelocity){vec2(1, 0), 0};
        solution->momentum_error = frame == 1 ? 0.5f : 0;
        solution->fallbacks = (Fallbacks){.beyond_training = frame == 1, .outside_cone = frame == 2};
        assert_ok(world_end_step(world, &error), error);
        run_log_step(&log, &scene, world, frame, PHASE_REST);
    }
    assert_near(log.momentum_error, 0.5, 0);
    assert_int_equal(log.fallen_back, 1);
    assert_near(log.at[2].bomb.x, 0, 0); /* a scene without a bomb */
    assert_true(run_log_begin(&log, &scene, world));
    assert_near(log.momentum_error, 0, 0);
    assert_int_equal(log.fallen_back, 0);
}

/* A box of 3 kg, 2 m up, at 4 m/s and 6 rad/s: 3 (16 / 2 + 10 2) + 3 (1 + 1) / 12 36 / 2 = 93 J. */
TEST(energy_is_kinetic_and_potential) {
    BodyDef box = {.size = {1, 1}, .mass = 3, .position = {5, 2}, .velocity = {0, 4}, .angular_velocity = 6};
    Scene scene = {.dt = 0.5f, .frames = 1, .body_count = 1, .bodies = &box, .gravity = {0, -10}};
    OWN(World) *world = world_of(&scene);
    OWN(RunLog) log = {0};
    assert_true(run_log_begin(&log, &scene, world));
    assert_near(log.at[0].energy, 3 * (8 + 20) + 0.5 * 0.5 * 36, 1e-4);
}

TEST(quantiles_are_interpolated) {
    double values[] = {5, 1, 4, 2, 3};
    assert_near(statistics_mean(values, 5), 3, 0);
    assert_near(statistics_quantile(values, 5, 0.5), 3, 0);
    assert_near(statistics_quantile(values, 5, 0.25), 2, 0);
    assert_near(statistics_quantile(values, 5, 0.95), 4.8, 1e-12);
    assert_near(statistics_quantile(values, 1, 0.95), 1, 0);
    assert_true(isnan(statistics_quantile(values, 0, 0.5)) && isnan(statistics_mean(values, 0)));
}

RUN_TESTS(NULL, NULL)
