/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small complete trainings: determinism, and what a stopped training keeps. */
#include "impacts.h"
#include "owned.h"

#include "learning/scene_training.h"

#include <omp.h>

enum { ROUNDS = 2, SWEEPS = 4 };

typedef struct Scores {
    int count;
    SceneNetScore items[ROUNDS];
} Scores;

static void note(void *context, const SceneNetScore *score) {
    Scores *scores = context;
    assert_in_range(scores->count, 0, ROUNDS - 1);
    scores->items[scores->count++] = *score;
}

static SceneNet *train(const Scene *scene, Scores *scores, const Progress *progress, Error *error) {
    const SceneTraining training = {.launches = 10,
                                    .rounds = ROUNDS,
                                    .epochs = 6,
                                    .sweeps = SWEEPS,
                                    .momentum = true,
                                    .widths = small_widths,
                                    .seed = 2,
                                    .on_score = note,
                                    .context = scores};
    *scores = (Scores){0};
    return scene_training_run(scene, &training, progress, error);
}

TEST(the_network_is_for_its_scene_and_the_same_for_any_threads) {
    OWN(Scene) *scene = scene_named("stack");
    Scores scores[2];
    SceneNet *networks[2];
    const int threads = omp_get_max_threads();
    for (int i = 0; i < 2; i++) {
        omp_set_num_threads(1 + i);
        networks[i] = train(scene, &scores[i], NULL, &error);
        assert_ok(networks[i] != NULL, error);
        assert_int_equal(scores[i].count, ROUNDS);
    }
    omp_set_num_threads(threads);
    assert_int_equal(networks[0]->parameter_count, networks[1]->parameter_count);
    assert_memory_equal(networks[0]->parameters, networks[1]->parameters, networks[0]->parameter_count * sizeof(float));
    for (int i = 0; i < ROUNDS; i++) {
        const SceneNetScore *one = &scores[0].items[i], *two = &scores[1].items[i];
        assert_int_equal(one->round, i);
        assert_int_equal(one->samples, two->samples);
        assert_true(one->train == two->train && one->held_out == two->held_out && one->momentum == two->momentum);
        assert_true(isfinite(one->train) && isfinite(one->held_out) && one->held_out != one->train);
        assert_true(one->momentum == scores[0].items[0].momentum && one->momentum > 0);
    }
    assert_true(scores[0].items[1].samples > scores[0].items[0].samples);
    assert_string_equal(networks[0]->scene, "stack");
    assert_int_equal(networks[0]->sweeps, SWEEPS);
    assert_near(networks[0]->bomb_inv_mass, 1 / 50.0, 1e-9);
    for (int i = 0; i < scene_net_inputs(networks[0]); i++) /* the range of the samples, with a margin */
        assert_true(networks[0]->low[i] < networks[0]->high[i]);
    for (int i = 0; i < 2; i++) scene_net_destroy(networks[i]);
}

/* Stops at a fraction of the total; progress never decreases. */
typedef struct Stop {
    double at, last;
    int calls_after; /* the stop */
} Stop;

static bool stop_share(void *context, double done, double total) {
    Stop *stop = context;
    assert_true(done >= stop->last && done <= total * (1 + 1e-9));
    stop->calls_after += stop->last >= stop->at * total;
    stop->last = done;
    return done < stop->at * total;
}

/* Stopped in the first fit, in the launches after it, in the second fit. */
TEST(a_stopped_training_keeps_the_rounds_so_far) {
    OWN(Scene) *scene = scene_named("stack");
    static const double at[] = {0.27, 0.67, 0.87};
    for (int i = 0; i < 3; i++) {
        error = (Error){0};
        Scores scores;
        Stop stop = {.at = at[i]};
        OWN(SceneNet) *network = train(scene, &scores, &(Progress){stop_share, &stop}, &error);
        assert_ok(network != NULL, error);
        assert_int_equal(error.kind, ERROR_NONE);
        assert_int_equal(stop.calls_after, 0);
        assert_int_equal(scores.count, i < 2 ? 1 : 2);
        for (size_t p = 0; p < network->parameter_count; p++) assert_true(isfinite(network->parameters[p]));
    }
}

TEST(a_training_stopped_before_the_first_network_fails) {
    OWN(Scene) *scene = scene_named("stack");
    Scores scores;
    Stop stop = {.at = 0.1};
    assert_null(train(scene, &scores, &(Progress){stop_share, &stop}, &error));
    assert_error(error, ERROR_INTERRUPTED, "launches: error: stopped after");
}

RUN_TESTS(NULL, NULL)
