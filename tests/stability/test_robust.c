/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The purpose of the method `robust`: scenes in which the engine fails with ten sweeps and robust holds for a
   minute. */
#include "stability/trial.h"

#include "collision/uniform.h"

static VerdictReading judge(const Scene *scene, const char *text, bool stands, const EnergyLog *converged) {
    Error error = {0};
    Method method;
    VerdictReading reading;
    assert_ok(method_parse(&method, text, &error), error);
    assert_ok(verdict_run(&reading, scene, &method, stands, converged, &error), error);
    return reading;
}

static Scene *read_scene(const char *name, const SceneSetting *settings, int count) {
    Error error = {0};
    char path[512];
    snprintf(path, sizeof path, "%s/scenes/stability/%s.yaml", SOURCE_DIR, name);
    Scene *scene = scene_read_with(path, settings, count, &error);
    assert_ok(scene != NULL, error);
    return scene;
}

static void converge(EnergyLog *log, const Scene *scene) {
    Error error = {0};
    Method reference;
    assert_ok(method_parse(&reference, "reference", &error), error);
    assert_ok(energy_log_run(log, scene, &reference, &error), error);
}

/* The engine fails, robust settles. */
static void assert_only_robust_settles(const char *name, const SceneSetting *settings, int count) {
    Scene *scene = read_scene(name, settings, count);
    EnergyLog converged = {0};
    converge(&converged, scene);
    assert_true(scene->frames == (int)lroundf(60 / scene->dt));
    assert_false(verdict_holds(judge(scene, "engine:k=10", true, &converged).verdict));
    assert_verdict(judge(scene, "robust", true, &converged), VERDICT_SETTLES);
    energy_log_free(&converged);
    scene_destroy(scene);
}

static void twenty_boxes_settle(void **state) {
    (void)state;
    assert_only_robust_settles("stack_height", (SceneSetting[]){{"height", 20}}, 1);
}

static void two_hundred_to_one_settles(void **state) {
    (void)state;
    assert_only_robust_settles("heavy_on_one", (SceneSetting[]){{"ratio", 200}}, 1);
}

static void fifty_to_one_settles_on_nine(void **state) {
    (void)state;
    assert_only_robust_settles("heavy_on_nine", (SceneSetting[]){{"ratio", 50}}, 1);
}

static void ten_boxes_settle_at_30_hz(void **state) {
    (void)state;
    assert_only_robust_settles("time_step", (SceneSetting[]){{"rate", 30}, {"height", 10}}, 2);
}

/* Impulses that push overlapping boxes apart must not be used as a warm start. */
static void an_overlapping_stack_does_not_explode(void **state) {
    (void)state;
    Scene *scene = read_scene("overlap", NULL, 0);
    EnergyLog converged = {0};
    converge(&converged, scene);
    assert_verdict(judge(scene, "robust", false, &converged), VERDICT_SETTLES);
    energy_log_free(&converged);
    scene_destroy(scene);
}

static void assert_strike_does_not_explode(float x, float spin, float mass) {
    const SceneSetting settings[] = {{"x", (double)x}, {"spin", (double)spin}, {"mass", (double)mass}};
    Scene *scene = read_scene("random_bombs", settings, 3);
    EnergyLog converged = {0};
    converge(&converged, scene);
    const VerdictReading reading = judge(scene, "robust", false, &converged);
    if (reading.verdict >= VERDICT_EXPLODES)
        fail_msg("x %g, spin %g, mass %g: %g J", (double)x, (double)spin, (double)mass, reading.value);
    energy_log_free(&converged);
    scene_destroy(scene);
}

/* A box that is hit may slide, tip or fly: neither the impulses that would hold it in place nor those of the impact
   itself are a valid warm start for the next step. */
static void stacks_that_bombs_strike_do_not_explode(void **state) {
    (void)state;
    uint32_t seed = 1;
    assert_strike_does_not_explode(0, 10, 50);
    for (int trial = 0; trial < 15; trial++) {
        const float x = uniform(&seed, -1, 1), spin = uniform(&seed, 0, 20);
        assert_strike_does_not_explode(x, spin, uniform(&seed, 10, 200));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(twenty_boxes_settle),
                                       cmocka_unit_test(two_hundred_to_one_settles),
                                       cmocka_unit_test(fifty_to_one_settles_on_nine),
                                       cmocka_unit_test(ten_boxes_settle_at_30_hz),
                                       cmocka_unit_test(an_overlapping_stack_does_not_explode),
                                       cmocka_unit_test(stacks_that_bombs_strike_do_not_explode)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
