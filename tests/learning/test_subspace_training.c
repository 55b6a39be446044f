/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A small training: the same bits for any number of threads and however often it is interrupted; rows and components
   are those of the recorded launches. */
#include "trainings.h"
#include "owned.h"

#include "learning/subspace_training.h"

#include <omp.h>

static Scene *short_scene(void) {
    Scene *scene = scene_named("single");
    scene->frames = 40;
    return scene;
}

static SubspaceTraining small(const char *state) {
    return (SubspaceTraining){
        .launches = 3, .epochs = 2, .batches = 3, .hidden = 16, .seed = 1, .command = "train", .state_path = state};
}

static Scene *scene;

static bool train(void *context, const char *path, const Progress *progress, Error *error) {
    const SubspaceTraining training = small(path);
    return (*(SubspaceNet **)context = subspace_train(scene, &training, progress, error)) != NULL;
}

/* A report for each launch that is recorded, then one before each epoch. */
TEST(the_bits_do_not_depend_on_threads_or_interruptions) {
    OWN(SubspaceNet) * one, *two;
    scene = short_scene();
    omp_set_num_threads(1);
    assert_ok(train(&one, temporary_path("one.part"), NULL, &error), error);
    omp_set_num_threads(2);
    assert_true(train_in_parts(train, &two, temporary_path("two.part"), 3 + SUBSPACE_HELD_OUT + 1, 1) > 1);
    assert_memory_equal(&one->shape, &two->shape, sizeof one->shape);
    const SubspacePredictor *last = &one->predictors[one->shape.predictor_count - 1];
    assert_memory_equal(one->block, two->block,
                        (size_t)(last->last.biases + last->last.lanes - one->block) * sizeof(float));
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
    SubspaceTraining training = small(temporary_path("floor.part"));
    OWN(SubspaceNet) *net = subspace_train(scene, &training, NULL, &error);
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
    SubspaceTraining training = small(temporary_path("scored.part"));
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
    const SubspaceTraining training = small(temporary_path("few.part"));
    assert_refused(subspace_train(scene, &training, NULL, &error), "frames with the bomb; training needs 34");
    scene_destroy(scene);
}

RUN_TESTS(NULL, NULL)
