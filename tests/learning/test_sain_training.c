/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of sain: what it is scored on, what is left out, what a stopped one keeps. */
#include "trainings.h"
#include "owned.h"

#include "learning/sain_training.h"
#include "methods/reference.h"

static Scene *scene;

/* Of the first round. */
static void keep_score(void *context, const SainScore *score) {
    if (score->round == 0) *(SainScore *)context = *score;
}

static SainScore scored;

static bool train(SainNetwork *network, const Progress *progress, Error *error) {
    const SainTraining training = {.scenes = &scene,
                                   .scene_count = 1,
                                   .launches = 2,
                                   .rounds = 2,
                                   .steps = 4,
                                   .batch = 64,
                                   .seed = 4,
                                   .on_score = keep_score,
                                   .context = &scored};
    return sain_training_run(&training, network, progress, error);
}

static int reports;

static bool count_reports(void *context, double done, double total) {
    (void)context, (void)done, (void)total;
    reports++;
    return true;
}

/* In the last report there is a network; in the first, launches are recorded. */
TEST(a_stopped_training_keeps_its_network_once_it_has_one) {
    OWN(SainNetwork) network;
    scene = scene_named("single");
    assert_ok(train(&network, &(Progress){count_reports, NULL}, &error), error);
    sain_network_destroy(&network);
    int left = reports;
    assert_ok(train(&network, &(Progress){stop_at, &left}, &error), error);
    sain_network_destroy(&network);
    left = 1;
    assert_false(train(&network, &(Progress){stop_at, &left}, &error));
    assert_error(error, ERROR_INTERRUPTED, "launches: error: stopped after");
    scene_destroy(scene);
}

TEST(scores_are_of_held_out_launches) {
    OWN(SainNetwork) network;
    scene = scene_named("single");
    assert_ok(train(&network, NULL, &error), error);
    /* Without a correction its error is the correction itself: that of launches which were not trained on. */
    for (int held_out = 0; held_out < 2; held_out++) {
        const SainLaunches launches = {
            .scenes = &scene, .scene_count = 1, .launches = 1, .rounds = held_out ? 1 : 2, .held_out = held_out == 1};
        OWN(RecordedSteps) steps = {0};
        SainSamples samples = {0};
        assert_ok(sain_launches_record(&launches, &steps, NULL, &error), error);
        assert_ok(sain_samples_add(&samples, &steps, true, &error), error);
        double sum = 0;
        for (size_t i = 0; i < samples.count; i++)
            for (int o = 0; o < SAIN_OUTPUTS; o++)
                sum += (double)samples.items[i].target[o] * (double)samples.items[i].target[o];
        const double error_without = sqrt(sum / (double)samples.count);
        assert_true((fabs(error_without - scored.held_out.without) < 1e-9) == (held_out == 1));
        sain_samples_free(&samples);
    }
    scene_destroy(scene);
}

/* A box in a V that its friction holds apart from: what is trained on has a solution, what is left out is counted. */
TEST(problems_without_a_solution_are_left_out_and_counted) {
    scene = scene_from(SOURCE_DIR "/tests/methods/scenes/wedge_launches.yaml");
    const SainLaunches launches = {.scenes = &scene, .scene_count = 1, .launches = 3, .rounds = 1};
    OWN(RecordedSteps) problems = {0};
    SainSamples samples = {.unconverged = 1};
    OWN(Reference) reference = {0};
    assert_ok(sain_launches_record(&launches, &problems, NULL, &error), error);
    for (size_t i = 0; i < problems.count; i++) {
        const ReferenceAim aim = {1e-6, 120, true, false};
        assert_ok(reference_solve_to(&reference, &problems.items[i].problem, &aim, &error), error);
        assert_true(reference.residual <= 1e-6);
    }
    assert_int_equal(problems.unconverged, 3 * 2); /* of each launch frames 30 and 60: the box wedges at frame 26 */
    assert_ok(sain_samples_add(&samples, &problems, false, &error), error);
    assert_int_equal(samples.unconverged, 1 + 3 * 2);
    sain_samples_free(&samples);
    scene_destroy(scene);
}

/* Only a network that is being trained may fail. */
TEST(a_failed_step_of_the_engine_is_refused) {
    scene = scene_named("single");
    scene->gravity.y = -INFINITY;
    scene->overlaps_allowed = true; /* the launches are not tried before */
    const SainLaunches launches = {.scenes = &scene, .scene_count = 1, .launches = 1, .rounds = 1};
    OWN(RecordedSteps) problems = {0};
    assert_refused(sain_launches_record(&launches, &problems, NULL, &error), "NaN or infinite");
    scene_destroy(scene);
}

RUN_TESTS(NULL, NULL)
