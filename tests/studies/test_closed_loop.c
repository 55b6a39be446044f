/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "made.h"

#include "studies/closed_loop.h"
#include "studies/rollout.h"

OWNED_VALUE(RunLog, run_log_free)

OWNED_VALUE(ConvergedLogs, converged_logs_free)

OWNED_VALUE(Rollout, rollout_free)

static ClosedLoop run(const char *text, const Scene *scene) {
    Error error = {0};
    ClosedLoop result;
    OWN(ConvergedLogs) converged = {0};
    Scene launched = *scene;
    const Method method = method_named(text);
    launched.frames = CLOSED_LOOP_FRAMES;
    assert_ok(closed_loop_log_converged(&converged, &launched, &error), error);
    assert_ok(closed_loop_run(&method, scene, &converged, 1, &result, &error), error);
    return result;
}

/* The reference equals itself; it conserves momentum; friction and inelastic impacts only dissipate energy. */
TEST(the_converged_run_equals_itself) {
    OWN(Scene) *scene = scene_named("single");
    ClosedLoop result = run("reference", scene);
    assert_near(result.frames_until_apart, CLOSED_LOOP_FRAMES, 0);
    assert_near(result.momentum_error, 0, 0);
    assert_true(result.energy_ratio >= 1 && result.energy_ratio < 1.001);
    assert_true(result.penetration_max > 0);
}

/* With one sweep and no warm start a stack of ten sinks. */
TEST(a_poor_method_diverges_before_a_good_one) {
    OWN(Scene) *scene = scene_named("stack");
    ClosedLoop poor = run("engine:k=1,warm=off", scene), good = run("interior", scene);
    assert_true(poor.frames_until_apart > 1 && poor.frames_until_apart < 40);
    assert_true(good.frames_until_apart > 2 * poor.frames_until_apart);
    assert_true(poor.penetration_max > good.penetration_max);
}

/* The deepest contact is that of the launch that has it, whichever comes last. */
TEST(the_deepest_contact_is_that_of_any_launch) {
    OWN(Scene) *scene = scene_named("stack");
    const Method method = method_named("engine:k=1,warm=off");
    Scene launches[2] = {*scene, *scene};
    ConvergedLogs converged[2] = {0};
    ClosedLoop one[2], both[2];
    launches[1].bomb.mass.value = 1;
    for (int i = 0; i < 2; i++) {
        launches[i].frames = CLOSED_LOOP_FRAMES;
        assert_ok(closed_loop_log_converged(&converged[i], &launches[i], &error), error);
        assert_ok(closed_loop_run(&method, &launches[i], &converged[i], 1, &one[i], &error), error);
    }
    assert_true(one[0].penetration_max != one[1].penetration_max);
    for (int i = 0; i < 2; i++) {
        const Scene order[] = {launches[i], launches[1 - i]};
        const ConvergedLogs logs[] = {converged[i], converged[1 - i]};
        assert_ok(closed_loop_run(&method, order, logs, 2, &both[i], &error), error);
        assert_true(both[i].penetration_max == fmax(one[0].penetration_max, one[1].penetration_max));
        assert_true(both[i].energy_ratio == fmax(one[0].energy_ratio, one[1].energy_ratio));
    }
    for (int i = 0; i < 2; i++) converged_logs_free(&converged[i]);
}

/* The energy that a late bomb brings is not counted as created by the method. A light one brings nothing, and comes
   after the heavy box has lost its height of 3.5 m. */
TEST(energy_counts_from_the_bomb_on) {
    for (int light = 0; light < 2; light++) {
        OWN(Scene) *scene = scene_named("single");
        scene->bomb.frame = light ? 120 : 30;
        if (light) scene->bomb.mass.value = 0.001f;
        const ClosedLoop result = run("engine", scene);
        assert_true(result.energy_ratio >= 1 && result.energy_ratio < 1.001);
    }
}

/* The log of the engine, moved by a centimetre more in each frame. */
TEST(runs_have_parted_at_a_tenth_of_a_metre) {
    OWN(Scene) *scene = scene_named("single");
    OWN(RunLog) engine = {0};
    OWN(Rollout) rollout = {0};
    LaunchLoop loop;
    const Method method = method_named("engine");
    scene->frames = 40;
    assert_ok(closed_loop_log(&engine, "engine", scene, &error), error);
    for (int frame = 0; frame <= engine.frames; frame++)
        engine.position[frame * engine.bodies + 1].x += 0.01f * ((float)frame - 0.5f);
    assert_ok(closed_loop_launch(&rollout, &method, scene, &engine, NULL, &loop, &error), error);
    assert_near(loop.frames_engine, 11, 0);
}

/* avbd moves bodies without equal and opposite impulses. */
TEST(momentum_is_that_of_a_step) {
    OWN(Scene) *scene = scene_named("stack");
    OWN(Rollout) rollout = {0};
    const Method method = method_named("avbd:k=2");
    OWN(Stepper) *stepper = stepper_of(scene, &method);
    const ClosedLoop result = run("avbd:k=2", scene);
    scene->frames = CLOSED_LOOP_FRAMES;
    assert_ok(rollout_run(&rollout, stepper, scene, NULL, NULL, &error), error);
    assert_true(rollout.log.momentum_error > 0);
    assert_near(result.momentum_error, rollout.log.momentum_error / rollout.log.frames, 1e-12);
}

/* The interior method is close to the converged run of the pyramid for longer than to the engine's. */
TEST(runs_are_compared_with_the_engine_and_with_the_converged_run) {
    OWN(Scene) *scene = scene_named("pyramid");
    scene->frames = 60;
    OWN(RunLog) engine = {0};
    OWN(ConvergedLogs) converged = {0};
    OWN(Rollout) rollout = {0};
    LaunchLoop loop;
    const Method method = method_named("interior");
    assert_ok(closed_loop_log(&engine, "engine", scene, &error), error);
    assert_ok(closed_loop_log_converged(&converged, scene, &error), error);
    assert_ok(closed_loop_launch(&rollout, &method, scene, &engine, &converged, &loop, &error), error);
    assert_true(loop.frames_engine < loop.frames_converged && loop.frames_converged <= 60);
    assert_int_equal(loop.steps, 60);
    assert_true(loop.energy_most >= loop.energy_put_in && loop.penetration > 0);
    assert_ok(closed_loop_launch(&rollout, &method, scene, &engine, NULL, &loop, &error), error);
    assert_true(isnan(loop.frames_converged) && loop.frames_engine < 60);
    assert_ok(closed_loop_launch(&rollout, &method, scene, NULL, &converged, &loop, &error), error);
    assert_true(isnan(loop.frames_engine) && loop.frames_converged > 1);
}

/* With enough sweeps a method takes the steps of the converged run, if that has its contacts. */
TEST(a_method_that_converges_follows_the_run_with_its_contacts) {
    static const struct {
        const char *few, *many;
    } sweeps[] = {{"engine:k=10", "engine:k=3000"}, {"momentum:k=10", "momentum:k=4000"}};
    OWN(Scene) *scene = scene_named("stack");
    OWN(ConvergedLogs) own = {0};
    assert_ok(closed_loop_log_converged(&own, scene, &error), error);
    const ConvergedLogs others = {{own.with[true], own.with[false]}};
    for (size_t i = 0; i < sizeof sweeps / sizeof *sweeps; i++) {
        OWN(Rollout) rollout = {0};
        LaunchLoop poor, good, elsewhere;
        const Method few = method_named(sweeps[i].few), many = method_named(sweeps[i].many);
        assert_ok(closed_loop_launch(&rollout, &few, scene, NULL, &own, &poor, &error), error);
        assert_ok(closed_loop_launch(&rollout, &many, scene, NULL, &own, &good, &error), error);
        assert_ok(closed_loop_launch(&rollout, &many, scene, NULL, &others, &elsewhere, &error), error);
        assert_true(good.frames_converged > 3 * poor.frames_converged);
        assert_true(good.frames_converged > 3 * elsewhere.frames_converged);
    }
}

/* The converged run tells when another parts from it, up to its first unconverged step. */
TEST(launches_that_part_after_an_unconverged_step_do_not_count) {
    enum { LAUNCHES = 3 };
    OWN(Scene) *scene = scene_named("stack");
    scene->frames = CLOSED_LOOP_FRAMES;
    const Scene launches[LAUNCHES] = {*scene, *scene, *scene};
    ConvergedLogs converged[LAUNCHES] = {0};
    ClosedLoop all, some, none;
    const Method method = method_named("engine:k=1");
    for (int i = 0; i < LAUNCHES; i++) assert_ok(closed_loop_log_converged(&converged[i], scene, &error), error);
    assert_ok(closed_loop_run(&method, launches, converged, LAUNCHES, &all, &error), error);
    assert_int_equal(all.unconverged, 0);

    const int parts = (int)all.frames_until_apart;
    assert_true(parts > 2 && parts < 100);
    converged[0].with[false].first_unconverged = parts;
    converged[1].with[false].first_unconverged = parts + 1;
    assert_ok(closed_loop_run(&method, launches, converged, LAUNCHES, &some, &error), error);
    assert_int_equal(some.unconverged, 1);
    assert_near(some.frames_until_apart, parts, 0);

    for (int i = 0; i < LAUNCHES; i++) converged[i].with[false].first_unconverged = 1;
    assert_ok(closed_loop_run(&method, launches, converged, LAUNCHES, &none, &error), error);
    assert_int_equal(none.unconverged, LAUNCHES);
    assert_true(isnan(none.frames_until_apart));
    for (int i = 0; i < LAUNCHES; i++) converged_logs_free(&converged[i]);
}

RUN_TESTS(NULL, NULL)
