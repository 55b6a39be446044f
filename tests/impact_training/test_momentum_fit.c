/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "impact_training/momentum_fit.h"

#include <omp.h>

static Scene *read_scene(const char *name) {
    char path[512];
    snprintf(path, sizeof path, "%s/scenes/%s.yaml", SOURCE_DIR, name);
    Error error = {0};
    Scene *scene = scene_read(path, &error);
    assert_ok(scene != NULL, error);
    return scene;
}

typedef struct Scores {
    int count;
    double plain[4], by_hand[4], learned[4];
} Scores;

static void note(void *context, int sweeps, double plain, double by_hand, double learned) {
    (void)sweeps;
    Scores *scores = context;
    scores->plain[scores->count] = plain;
    scores->by_hand[scores->count] = by_hand;
    scores->learned[scores->count++] = learned;
}

static MomentumSchedules fit(const Scene *scene, Scores *scores, const Progress *progress) {
    MomentumFitOptions options = {.generations = 6, .seed = 1, .on_schedule = note, .context = scores};
    assert_true(parse_range("2:4:1", 10, &options.bomb_x));
    MomentumSchedules schedules;
    Error error = {0};
    assert_ok(momentum_fit(&schedules, scene, &options, progress, &error), error);
    return schedules;
}

static void learned_factors_beat_hand_tuned_ones(void **state) {
    (void)state;
    Scene *scene = read_scene("stack");
    Scores scores = {0};
    MomentumSchedules schedules = fit(scene, &scores, NULL);
    assert_int_equal(schedules.count, 4);
    assert_int_equal(scores.count, 4);
    for (int i = 0; i < 4; i++) {
        assert_true(scores.by_hand[i] < scores.plain[i]);
        assert_true(scores.learned[i] < scores.by_hand[i]);
    }
    momentum_schedules_free(&schedules);
    scene_destroy(scene);
}

static void same_bits_for_any_number_of_threads(void **state) {
    (void)state;
    Scene *scene = read_scene("stack");
    Scores scores[2] = {{0}};
    MomentumSchedules schedules[2];
    int threads = omp_get_max_threads();
    for (int i = 0; i < 2; i++) {
        omp_set_num_threads(1 + 2 * i);
        schedules[i] = fit(scene, &scores[i], NULL);
    }
    omp_set_num_threads(threads);
    for (int i = 0; i < 4; i++)
        assert_memory_equal(schedules[0].factors[i], schedules[1].factors[i],
                            (size_t)schedules[0].sweeps[i] * sizeof(float));
    for (int i = 0; i < 2; i++) momentum_schedules_free(&schedules[i]);
    scene_destroy(scene);
}

static bool stop_after_the_recording(void *context, double done, double total) {
    (void)context;
    return done < 0.51 * total;
}

static void a_stopped_fit_keeps_the_best_so_far(void **state) {
    (void)state;
    Scene *scene = read_scene("stack");
    Scores scores = {0};
    MomentumSchedules schedules = fit(scene, &scores, &(Progress){stop_after_the_recording, NULL});
    assert_int_equal(schedules.count, 4);
    assert_near(scores.learned[3], scores.by_hand[3], 0);
    momentum_schedules_free(&schedules);
    scene_destroy(scene);
}

static bool stop_at_once(void *context, double done, double total) {
    (void)context, (void)done, (void)total;
    return false;
}

static void a_scene_without_impacts_is_refused(void **state) {
    (void)state;
    Scene *scene = read_scene("stack");
    MomentumSchedules schedules;
    MomentumFitOptions options = {.generations = 1};
    Error error = {0};
    assert_true(parse_range("2:4:1", 10, &options.bomb_x));
    assert_false(momentum_fit(&schedules, scene, &options, &(Progress){stop_at_once, NULL}, &error));
    assert_error(error, ERROR_INTERRUPTED, "stopped");
    error = (Error){0};
    assert_true(parse_range("4000:4002:1", 10, &options.bomb_x));
    scene->frames = 20;
    assert_refused(momentum_fit(&schedules, scene, &options, NULL, &error), "no launch");
    error = (Error){0};
    scene->bomb.present = false;
    assert_refused(momentum_fit(&schedules, scene, &options, NULL, &error), "no bomb");
    scene_destroy(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(learned_factors_beat_hand_tuned_ones), cmocka_unit_test(same_bits_for_any_number_of_threads),
        cmocka_unit_test(a_stopped_fit_keeps_the_best_so_far), cmocka_unit_test(a_scene_without_impacts_is_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
