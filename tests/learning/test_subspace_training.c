/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A small training: the same bits for any number of threads; rows and components are those of the recorded launches. */
#include "trainings.h"
#include "owned.h"

#include "learning/subspace_training.h"

#include <omp.h>

static Scene *short_scene(void) {
    Scene *scene = scene_named("single");
    scene->frames = 40;
    return scene;
}

static const SubspaceTraining small = {.launches = 3, .epochs = 2, .batches = 3, .hidden = 16, .seed = 1};

static Scene *scene;

static bool same_weights(const SubspaceNet *one, const SubspaceNet *two) {
    const SubspacePredictor *last = &one->predictors[one->shape.predictor_count - 1];
    assert_memory_equal(&one->shape, &two->shape, sizeof one->shape);
    return memcmp(one->block, two->block,
                  (size_t)(last->last.biases + last->last.lanes - one->block) * sizeof(float)) == 0;
}

/* A report for each launch that is recorded, then one before each epoch: the stopped training has none. */
TEST(the_bits_depend_on_no_threads_and_a_stopped_training_keeps_what_it_has) {
    OWN(SubspaceNet) * one, *two, *stopped;
    int left = small.launches + SUBSPACE_HELD_OUT + 1;
    scene = short_scene();
    omp_set_num_threads(1);
    one = subspace_train(scene, &small, NULL, &error);
    omp_set_num_threads(2);
    two = subspace_train(scene, &small, NULL, &error);
    stopped = subspace_train(scene, &small, &(Progress){stop_at, &left}, &error);
    assert_ok(one != NULL && two != NULL && stopped != NULL, error);
    assert_true(same_weights(one, two) && !same_weights(one, stopped));
    scene_destroy(scene);
}

/* All of them are kept, so nothing is lost but the rounding of floats; the first state lies one step before. */
TEST(rows_are_the_recorded_poses) {
    Launch launches[2];
    PoseRows rows;
    scene = short_scene();
    assert_ok(launches_for_training(scene, 2, launches, &error), error);
    assert_ok(subspace_record(&rows, scene, launches, 2, NULL, &error), error);
    assert_int_equal(rows.states, scene->frames + 2);
    assert_int_equal(rows.numbers, 8);
    const Scene launched = launch_scene(scene, &launches[1]);
    const BodyDef bomb = scene_bomb_body(&launched);
    assert_near(pose_row(&rows, 1, 1)[4], bomb.position.x, 0);
    assert_near(pose_row(&rows, 1, 0)[5], bomb.position.y - scene->dt * bomb.velocity.y, 1e-5);
    assert_near(pose_row(&rows, 1, 0)[1], 4, 0);
    assert_near(pose_row(&rows, 1, 1)[7], sqrt(2.0 / 12), 1e-6);
    OWN(SubspaceNet) *net = subspace_train(scene, &small, NULL, &error);
    assert_ok(net != NULL, error);
    SubspaceScore score;
    assert_ok(subspace_score(net, &net->predictors[0], &rows, &score, &error), error);
    assert_near(score.floor.rms, 0, 1e-5);
    assert_near(score.floor.frames, scene->frames, 0);
    assert_true(score.linear.rms > 0.01);
    pose_rows_free(&rows);
    scene_destroy(scene);
}

static void keep_score(void *context, const SubspaceScore *score, double loss) {
    (void)loss;
    *(SubspaceScore *)context = *score;
}

/* Errors are those of the network on the launches for scoring, not on those that it was trained on. */
TEST(scores_are_of_held_out_launches) {
    scene = short_scene();
    SubspaceScore told, found[2];
    SubspaceTraining training = small;
    training.on_score = keep_score;
    training.context = &told;
    OWN(SubspaceNet) *net = subspace_train(scene, &training, NULL, &error);
    assert_ok(net != NULL, error);
    for (int held_out = 0; held_out < 2; held_out++) {
        Launch launches[SUBSPACE_HELD_OUT];
        const int count = held_out ? SUBSPACE_HELD_OUT : training.launches;
        PoseRows rows;
        assert_ok((held_out ? launches_for_scoring : launches_for_training)(scene, count, launches, &error), error);
        assert_ok(subspace_record(&rows, scene, launches, count, NULL, &error), error);
        const SubspacePredictor *last = &net->predictors[net->shape.predictor_count - 1];
        assert_ok(subspace_score(net, last, &rows, &found[held_out], &error), error);
        pose_rows_free(&rows);
    }
    assert_near(told.net.rms, found[1].net.rms, 0);
    assert_near(told.floor.rms, found[1].floor.rms, 0);
    assert_true(told.net.rms != found[0].net.rms);
    scene_destroy(scene);
}

TEST(too_few_frames_are_refused) {
    scene = short_scene();
    scene->frames = 20;
    assert_refused(subspace_train(scene, &small, NULL, &error), "frames with the bomb; training needs 34");
    scene_destroy(scene);
}

RUN_TESTS(NULL, NULL)
