/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of sain: the same bits however often it was interrupted. */
#include "trainings.h"

#include "learning/sain_training.h"

static Scene *scene;

static bool train(void *context, const char *path, const Progress *progress, Error *error) {
    RelationNetworks *networks = context;
    const RelationTraining training = {.scenes = &scene,
                                       .scene_count = 1,
                                       .launches = 2,
                                       .rounds = 2,
                                       .steps = 4,
                                       .batch = 64,
                                       .saved = 3,
                                       .seed = 4,
                                       .command = "test",
                                       .state_path = path};
    const bool ok = relation_training_run(&training, networks, progress, error);
    if (!ok) relation_networks_destroy(networks);
    return ok;
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

TEST(an_interrupted_training_has_the_same_bits) {
    RelationNetworks whole, resumed;
    scene = scene_named("single");
    assert_ok(train(&whole, temporary_path("whole.part"), NULL, &error), error);
    assert_true(train_in_parts(train, &resumed, temporary_path("resumed.part"), 5, 4) > 2);
    assert_same(&whole, &resumed);
    relation_networks_destroy(&whole);
    relation_networks_destroy(&resumed);
    scene_destroy(scene);
}

RUN_TESTS(NULL, NULL)
