/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of sain: the same bits however often it was interrupted. */
#include "testing.h"

#include "base/file.h"
#include "learning/sain_training.h"

#include <unistd.h>

/* Stops at the report of that number. */
static bool stop_at(void *context, double done, double total) {
    (void)done;
    (void)total;
    return --*(int *)context > 0;
}

static bool train(Scene *const *scenes, const char *state, RelationNetworks *networks, const Progress *progress,
                  Error *error) {
    const RelationTraining training = {.scenes = scenes,
                                       .scene_count = 1,
                                       .launches = 2,
                                       .rounds = 2,
                                       .steps = 4,
                                       .batch = 64,
                                       .saved = 3,
                                       .seed = 4,
                                       .command = "test",
                                       .state_path = state};
    return relation_training_run(&training, networks, progress, error);
}

static void assert_same(const RelationNetworks *a, const RelationNetworks *b) {
    for (int f = 0; f < RELATION_FORMS; f++) {
        const RelationNetwork *x = &a->forms[f], *y = &b->forms[f];
        assert_memory_equal(x->relation->weights[0], y->relation->weights[0],
                            (size_t)network_parameter_count(x->relation) * sizeof(float));
        assert_memory_equal(x->object->weights[0], y->object->weights[0],
                            (size_t)network_parameter_count(x->object) * sizeof(float));
        assert_memory_equal(x->relation->input.offset, y->relation->input.offset, RELATION_PAIR_INPUTS * sizeof(float));
        assert_memory_equal(x->pair_high, y->pair_high, sizeof x->pair_high);
        assert_memory_equal(x->limit, y->limit, sizeof x->limit);
    }
}

static void an_interrupted_training_has_the_same_bits(void **state) {
    (void)state;
    Error error = {0};
    Scene *scene = scene_read(SOURCE_DIR "/scenes/single.yaml", &error);
    assert_ok(scene != NULL, error);
    RelationNetworks whole, resumed;
    const char *path = temporary_path("whole.part");
    assert_ok(train(&scene, path, &whole, NULL, &error), error);
    path = temporary_path("resumed.part");
    int interrupted = 0, reports = 5;
    for (;; interrupted++, reports += 4) {
        int left = reports;
        const Progress progress = {stop_at, &left};
        Error stopped = {0};
        if (train(&scene, path, &resumed, &progress, &stopped)) break;
        assert_int_equal(stopped.kind, ERROR_INTERRUPTED);
        assert_int_equal(access(path, F_OK), 0);
        relation_networks_destroy(&resumed);
    }
    assert_true(interrupted > 2);
    assert_same(&whole, &resumed);
    relation_networks_destroy(&whole);
    relation_networks_destroy(&resumed);
    scene_destroy(scene);
}

static void a_state_of_another_training_is_refused(void **state) {
    (void)state;
    Error error = {0};
    const char *path = temporary_path("other.part");
    Scene *scene = scene_read(SOURCE_DIR "/scenes/single.yaml", &error);
    RelationNetworks networks;
    assert_ok(file_write_soon(path, "x", 1, &error), error);
    assert_refused(train(&scene, path, &networks, NULL, &error), path);
    relation_networks_destroy(&networks);
    scene_destroy(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(an_interrupted_training_has_the_same_bits),
                                       cmocka_unit_test(a_state_of_another_training_is_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
