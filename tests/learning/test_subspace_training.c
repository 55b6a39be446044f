/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A small training: the same bits for any number of threads and however often it is interrupted; rows and components are
   those of the recorded launches. */
#include "testing.h"

#include "learning/subspace_training.h"

#include <math.h>
#include <omp.h>

static Scene *short_scene(void) {
    Error error = {0};
    Scene *scene = scene_read(SOURCE_DIR "/scenes/single.yaml", &error);
    assert_ok(scene != NULL, error);
    scene->frames = 40;
    return scene;
}

static SubspaceTraining small(const char *state) {
    return (SubspaceTraining){
        .launches = 3, .epochs = 2, .batches = 3, .hidden = 16, .seed = 1, .command = "train", .state_path = state};
}

static void assert_same_bits(const SubspaceNet *a, const SubspaceNet *b) {
    const char *paths[2] = {temporary_path("a.npz"), temporary_path("b.npz")};
    char bytes[2][60000];
    size_t sizes[2];
    Error error = {0};
    assert_ok(subspace_net_write(a, paths[0], &error) && subspace_net_write(b, paths[1], &error), error);
    for (int i = 0; i < 2; i++) {
        FILE *file = fopen(paths[i], "rb");
        assert_non_null(file);
        sizes[i] = fread(bytes[i], 1, sizeof bytes[i], file);
        fclose(file);
    }
    assert_true(sizes[0] > 1000 && sizes[0] < sizeof bytes[0] && sizes[0] == sizes[1]);
    assert_memory_equal(bytes[0], bytes[1], sizes[0]);
}

/* Stops after the first epoch: recording and the start are 0.11 of the whole. */
static bool stop_later(void *context, double done, double total) {
    (void)context;
    return done / total < 0.12;
}

static void the_bits_do_not_depend_on_threads_or_interruptions(void **state) {
    (void)state;
    Scene *scene = short_scene();
    Error error = {0};
    SubspaceTraining training = small(temporary_path("one.part"));
    omp_set_num_threads(1);
    SubspaceNet *one = subspace_train(scene, &training, NULL, &error);
    assert_ok(one != NULL, error);
    training.state_path = temporary_path("two.part");
    omp_set_num_threads(2);
    const Progress progress = {stop_later, NULL};
    assert_null(subspace_train(scene, &training, &progress, &error));
    assert_int_equal(error.kind, ERROR_INTERRUPTED);
    error = (Error){0};
    SubspaceNet *two = subspace_train(scene, &training, NULL, &error);
    assert_ok(two != NULL, error);
    assert_same_bits(one, two);
    subspace_net_destroy(one);
    subspace_net_destroy(two);
    scene_destroy(scene);
}

/* All of them are kept, so nothing is lost but the rounding of floats; the first state lies one step before. */
static void rows_are_the_recorded_poses(void **state) {
    (void)state;
    Scene *scene = short_scene();
    Error error = {0};
    Launch launches[2];
    PoseRows rows;
    assert_ok(launches_for_training(scene, 2, launches, &error), error);
    assert_ok(subspace_record(&rows, scene, SUBSPACE_OFFLINE, launches, 2, NULL, &error), error);
    assert_int_equal(rows.states, scene->frames + 2);
    assert_int_equal(rows.numbers, 8);
    const Scene launched = launch_scene(scene, &launches[1]);
    const BodyDef bomb = scene_bomb_body(&launched);
    assert_near(pose_row(&rows, 1, 1)[4], bomb.position.x, 0);
    assert_near(pose_row(&rows, 1, 0)[5], bomb.position.y - scene->dt * bomb.velocity.y, 1e-5);
    assert_near(pose_row(&rows, 1, 0)[1], 4, 0);
    assert_near(pose_row(&rows, 1, 1)[7], sqrt(2.0 / 12), 1e-6);
    SubspaceTraining training = small(temporary_path("floor.part"));
    SubspaceNet *net = subspace_train(scene, &training, NULL, &error);
    assert_ok(net != NULL, error);
    SubspaceScore score;
    assert_ok(subspace_score(net, &net->predictors[0], &rows, &score, &error), error);
    assert_near(score.floor.rms, 0, 1e-5);
    assert_near(score.floor.frames, scene->frames, 0);
    assert_true(score.linear.rms > 0.01);
    subspace_net_destroy(net);
    pose_rows_free(&rows);
    scene_destroy(scene);
}

static void too_few_frames_are_refused(void **state) {
    (void)state;
    Scene *scene = short_scene();
    Error error = {0};
    scene->frames = 20;
    const SubspaceTraining training = small(temporary_path("few.part"));
    assert_refused(subspace_train(scene, &training, NULL, &error), "frames with the bomb; training needs 34");
    scene_destroy(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_bits_do_not_depend_on_threads_or_interruptions),
                                       cmocka_unit_test(rows_are_the_recorded_poses),
                                       cmocka_unit_test(too_few_frames_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
