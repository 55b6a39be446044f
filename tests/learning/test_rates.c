/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rates of trainings, and the ranges that one of them sets. The first step of Adam moves every weight by its rate,
   whatever the slope; of two steps the second is as long as its rate for weights whose slopes are alike. */
#include "trainings.h"
#include "owned.h"

#include "learning/gns_training.h"
#include "learning/sain_training.h"
#include "learning/scene_training.h"
#include "learning/subspace_training.h"

/* The largest change of a weight. */
static double largest_change(const float *a, const float *b, size_t count) {
    double largest = 0;
    for (size_t i = 0; i < count; i++) largest = fmax(largest, fabs((double)a[i] - (double)b[i]));
    return largest;
}

/* To 0 in equal steps: the second of two at half the rate. */
TEST(the_rate_of_gns_falls) {
    GnsNet nets[2];
    for (int i = 0; i < 2; i++) {
        Scene *scenes[] = {scene_named("single")};
        scenes[0]->frames = 40;
        const GnsTraining training = {.width = 16,
                                      .rounds = 1,
                                      .steps = 1 + i,
                                      .batch = 2,
                                      .launches = 2,
                                      .radius = 0.6f,
                                      .noise = 0.05f,
                                      .rate = 0.002,
                                      .seed = 3,
                                      .scenes = scenes,
                                      .scene_count = 1};
        assert_ok(gns_training_run(&training, &nets[i], NULL, &error), error);
    }
    const double change =
        largest_change(nets[0].parameters, nets[1].parameters, (size_t)nets[0].layout.parameters) / 0.002;
    assert_in_range(100 * change, 40, 51);
    for (int i = 0; i < 2; i++) gns_net_free(&nets[i]);
}

/* By the square of what is left: the second of two at a quarter. */
TEST(the_rate_of_subspace_falls_faster) {
    OWN(Scene) *scene = scene_named("single");
    SubspaceNet *nets[2];
    scene->frames = 40;
    for (int i = 0; i < 2; i++) {
        const SubspaceTraining training = {.launches = 3, .epochs = 1, .batches = 1 + i, .hidden = 16, .seed = 1};
        nets[i] = subspace_train(scene, &training, NULL, &error);
        assert_ok(nets[i] != NULL, error);
    }
    const SubspaceLayer *one = &nets[0]->predictors[0].second, *two = &nets[1]->predictors[0].second;
    const double change = largest_change(one->rows, two->rows, (size_t)one->from * (size_t)one->lanes) / 1e-2;
    assert_in_range(1000 * change, 200, 256);
    for (int i = 0; i < 2; i++) subspace_net_destroy(nets[i]);
}

typedef struct Biases {
    const SainNetwork *network;
    int rounds;
    float last[2][SAIN_OUTPUTS]; /* after each round */
} Biases;

static void keep_biases(void *context, const SainScore *score) {
    Biases *biases = context;
    const Network *object = biases->network->object;
    (void)score;
    memcpy(biases->last[biases->rounds++], object->biases[object->layers - 1], sizeof *biases->last);
}

TEST(each_round_of_sain_begins_with_half_the_rate) {
    OWN(Scene) *scene = scene_named("single");
    OWN(SainNetwork) network;
    Biases biases = {.network = &network};
    const SainTraining training = {.scenes = &scene,
                                   .scene_count = 1,
                                   .launches = 2,
                                   .rounds = 2,
                                   .steps = 1,
                                   .batch = 64,
                                   .seed = 4,
                                   .on_score = keep_biases,
                                   .context = &biases};
    static const float none[SAIN_OUTPUTS];
    assert_ok(sain_training_run(&training, &network, NULL, &error), error);
    assert_int_equal(biases.rounds, 2);
    const double first = largest_change(biases.last[0], none, SAIN_OUTPUTS),
                 second = largest_change(biases.last[1], biases.last[0], SAIN_OUTPUTS);
    assert_near(first, 0.003, 0.003 * 0.02); /* weights decay, too */
    assert_near(second, 0.0015, 0.0015 * 0.02);
}

static void keep_count(void *context, const SceneNetScore *score) { *(int *)context = score->samples; }

/* Rounds after the first have half the rate. One batch has all samples. */
TEST(later_rounds_of_scene_net_have_half_the_rate) {
    OWN(Scene) *scene = scene_named("stack");
    SceneNet *networks[2];
    int samples = 0;
    for (int i = 0; i < 2; i++) {
        const SceneTraining training = {.launches = 2,
                                        .rounds = 1 + i,
                                        .epochs = 1,
                                        .sweeps = 2,
                                        .widths = {.state = 16, .present = 16, .warm = 16, .hidden = 16},
                                        .seed = 2,
                                        .on_score = keep_count,
                                        .context = &samples};
        networks[i] = scene_training_run(scene, &training, NULL, &error);
        assert_ok(networks[i] != NULL, error);
    }
    static const float none[SCENE_NET_WIDTH_MAX];
    const float *first = networks[0]->first.biases, *second = networks[1]->first.biases;
    assert_in_range(samples, 1, 32);
    assert_near(largest_change(first, none, 16), 3e-3, 3e-5);
    assert_near(largest_change(second, first, 16), 1.5e-3, 1.5e-5);
    for (int i = 0; i < 2; i++) scene_net_destroy(networks[i]);
}

/* A tenth beyond the samples on both sides. */
TEST(ranges_of_scene_net_have_a_margin) {
    OWN(SceneNet) *network = scene_net_read(SOURCE_DIR "/scenes/networks/scene-pyramid_settled.npz", &error);
    assert_ok(network != NULL, error);
    const int count = scene_net_inputs(network);
    float inputs[2][4 * SCENE_NET_WIDTH_MAX];
    SceneNetSample items[2] = {{.inputs = inputs[0]}, {.inputs = inputs[1]}};
    for (int k = 0; k < count; k++) inputs[0][k] = (float)k, inputs[1][k] = (float)k - 10;
    scene_net_set_ranges(network, &(SceneNetSamples){.items = items, .count = 2});
    for (int k = 0; k < count; k++) {
        assert_near(network->low[k], k - 11, 1e-3);
        assert_near(network->high[k], k + 1, 1e-3);
    }
}

RUN_TESTS(NULL, NULL)
