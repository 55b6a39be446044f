/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figures of runs written by hand. */
#include "testing.h"

#include "study/run_log.h"
#include "study/statistics.h"

#include <math.h>

enum { FRAMES = 10, BODIES = 3 };

/* A ground and two boxes; the bomb comes after step 2 and touches in step 5; impact 2 frames, then after. */
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
    double energy[FRAMES + 1], penetration[FRAMES + 1];
    Phase phase[FRAMES + 1];
} Handmade;

static RunLog log_by_hand(Handmade *made) {
    for (int frame = 0; frame <= FRAMES; frame++) {
        for (int body = 0; body < BODIES; body++) made->position[frame * BODIES + body] = vec2((float)body, 0);
        made->energy[frame] = 100;
        made->penetration[frame] = 0.01;
        made->phase[frame] = frame < 5 ? PHASE_REST : frame < 7 ? PHASE_IMPACT : PHASE_AFTER;
    }
    return (RunLog){.bodies = BODIES,
                    .frames = FRAMES,
                    .touch = 5,
                    .launch_frame = 2,
                    .end_frame = FRAMES,
                    .position = made->position,
                    .energy = made->energy,
                    .penetration = made->penetration,
                    .phase = made->phase};
}

static void equal_runs_have_nothing_to_tell(void **state) {
    (void)state;
    Handmade a, b;
    const Scene scene = scene_by_hand();
    const RunLog log = log_by_hand(&a), converged = log_by_hand(&b);
    RunFigures figures = run_figures(&log, &converged, &scene);
    for (int phase = 0; phase < PHASES; phase++) {
        assert_near(figures.energy[phase], 0, 0);
        assert_near(figures.penetration[phase], 0.01, 0);
    }
    assert_near(figures.drift, 0, 0);
    assert_near(figures.moved, 0, 0);
}

static void differences_are_measured_where_they_are(void **state) {
    (void)state;
    Handmade a, b;
    const Scene scene = scene_by_hand();
    const RunLog log = log_by_hand(&a), converged = log_by_hand(&b);
    a.energy[5] = 104;                               /* impact: (4 + 0) / 2 */
    a.energy[10] = 108;                              /* after: 8 / 4 */
    a.penetration[6] = 0.3;                          /* impact */
    a.position[4 * BODIES + 1] = vec2(1.03f, 0.04f); /* just before the touch: 0.05 of one box of two */
    a.position[10 * BODIES + 1] = vec2(1.6f, 0);     /* 0.6 m in the end */
    a.position[10 * BODIES + 2] = vec2(2.4f, 0);     /* 0.4 m: has not moved */
    a.position[10 * BODIES + 0] = vec2(9, 0);        /* the ground does not count */
    RunFigures figures = run_figures(&log, &converged, &scene);
    assert_near(figures.energy[PHASE_IMPACT], 2, 1e-12);
    assert_near(figures.energy[PHASE_AFTER], 2, 1e-12);
    assert_near(figures.energy[PHASE_REST], 0, 0);
    assert_near(figures.penetration[PHASE_IMPACT], 0.3, 0);
    assert_near(figures.penetration[PHASE_AFTER], 0.01, 0);
    assert_near(figures.drift, 0.025, 1e-6);
    assert_near(figures.moved, 1, 0);
}

/* Moved is counted from where the boxes were when the bomb came. */
static void what_moved_before_the_launch_has_not_moved(void **state) {
    (void)state;
    Handmade a, b;
    const Scene scene = scene_by_hand();
    const RunLog log = log_by_hand(&a), converged = log_by_hand(&b);
    for (int frame = 2; frame <= FRAMES; frame++) a.position[frame * BODIES + 1] = vec2(7, 0);
    assert_near(run_figures(&log, &converged, &scene).moved, 0, 0);
}

static void a_run_that_broke_off_has_moved_everything(void **state) {
    (void)state;
    Handmade a, b;
    const Scene scene = scene_by_hand();
    RunLog log = log_by_hand(&a), converged = log_by_hand(&b);
    log.frames = 3;
    log.touch = 0;
    RunFigures figures = run_figures(&log, &converged, &scene);
    assert_near(figures.moved, 2, 0);
    assert_true(isnan(figures.energy[PHASE_IMPACT]));
    assert_true(isnan(figures.penetration[PHASE_AFTER]));
    assert_near(figures.energy[PHASE_REST], 0, 0);
    assert_true(isnan(figures.drift));
}

/* A box of 3 kg, 2 m up, at 4 m/s and 6 rad/s: 3 (16 / 2 + 10 2) + 3 (1 + 1) / 12 36 / 2 = 93 J. */
static void energy_is_kinetic_and_potential(void **state) {
    (void)state;
    Error error = {0};
    BodyDef box = {.size = {1, 1}, .mass = 3, .position = {5, 2}, .velocity = {0, 4}, .angular_velocity = 6};
    Scene scene = {.dt = 0.5f, .frames = 1, .body_count = 1, .bodies = &box, .gravity = {0, -10}};
    World *world = scene_world(&scene, &error);
    assert_ok(world != NULL, error);
    RunLog log = {0};
    assert_true(run_log_begin(&log, &scene, world));
    assert_near(log.energy[0], 3 * (8 + 20) + 0.5 * 0.5 * 36, 1e-4);
    run_log_free(&log);
    world_destroy(world);
}

static void quantiles_lie_between_the_values(void **state) {
    (void)state;
    double values[] = {5, 1, 4, 2, 3};
    assert_near(statistics_mean(values, 5), 3, 0);
    assert_near(statistics_quantile(values, 5, 0.5), 3, 0);
    assert_near(statistics_quantile(values, 5, 0.25), 2, 0);
    assert_near(statistics_quantile(values, 5, 0.95), 4.8, 1e-12);
    assert_near(statistics_quantile(values, 1, 0.95), 1, 0);
    assert_true(isnan(statistics_quantile(values, 0, 0.5)) && isnan(statistics_mean(values, 0)));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(equal_runs_have_nothing_to_tell),
                                       cmocka_unit_test(differences_are_measured_where_they_are),
                                       cmocka_unit_test(what_moved_before_the_launch_has_not_moved),
                                       cmocka_unit_test(a_run_that_broke_off_has_moved_everything),
                                       cmocka_unit_test(energy_is_kinetic_and_potential),
                                       cmocka_unit_test(quantiles_lie_between_the_values)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
