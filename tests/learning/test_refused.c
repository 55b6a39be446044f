/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "datasets.h"

#include "learning/pair_training_internal.h"

#include <float.h>

static void refuse(const Dataset *dataset, TrainingOptions options, const char *text) {
    Error error = {0};
    assert_refused(training_run(dataset, &options, NULL, &error), text);
}

TEST(invalid_options_are_refused) {
    static const struct {
        const char *optimizer;
        int iterations, layers, widths[3];
        const char *text;
    } cases[] = {
        {"magic", 1, 2, {10, 4, 2}, "'magic' is not an optimizer; known: adam, bfgs, gd, lm"},
        {"adam", -1, 2, {10, 4, 2}, "iterations: error: must be 0 or more (got -1)"},
        {"adam", 1, 2, {9, 4, 2}, "the first width must be 10, the inputs of a pair (got 9)"},
        {"adam", 1, 2, {10, 4, 3}, "the last width must be 2 (relative velocity) or 6 (both bodies) (got 3)"},
        {"adam", 1, 2, {10, 0, 2}, "width 0"},
        {"adam", 1, 0, {10, 4, 2}, "weight layers (got 0)"},
        {"lm", 1, 2, {10, 20, 2}, "as many target values as weights (got 160 and 262)"}, /* 80 rows of 2 */
        {"lm", 1, 2, {10, 200, 2}, "at most 2000 weights (got 2602)"},
    };
    Dataset *dataset = make_taught_dataset(100);
    TrainingOptions options;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        options = small(cases[i].optimizer, cases[i].iterations);
        options.layers = cases[i].layers;
        memcpy(options.widths, cases[i].widths, sizeof cases[i].widths);
        refuse(dataset, options, cases[i].text);
    }
    Network *start = network_sized(2, (const int[]){PAIR_INPUTS, 5, 2});
    options = small("adam", 0);
    options.start = start;
    refuse(dataset, options, "trained on other inputs");
    strcpy(start->inputs, pair_views[PAIR_RELATIVE].inputs);
    strcpy(start->target, "net");
    refuse(dataset, options, "trained for another target (net)");
    strcpy(start->target, "pair");
    refuse(dataset, options, "other widths");
    network_destroy(start);
    dataset->launch_test[4] = 0;
    refuse(dataset, small("adam", 1), "one training row and one test row (got 100 and 0)");
    dataset_destroy(dataset);
}

/* The change of b relative to a overflows float32. */
TEST(infinite_loss_is_an_error) {
    Dataset *dataset = make_taught_dataset(100);
    dataset->changes[0] = -FLT_MAX, dataset->changes[3] = FLT_MAX;
    for (int i = 0; optimizers[i] != NULL; i++) refuse(dataset, small(optimizers[i]->name, 3), "iteration 0");
    dataset_destroy(dataset);
}

/* Words, the weight of a law, and the outputs. */
TEST(options_that_contradict_each_other_are_refused) {
    static const struct {
        const char *optimizer, *hidden, *activation, *scale, *loss;
        double cone;
        int outputs;
        const char *text;
    } cases[] = {
        {"adam", "linear", NULL, NULL, NULL, 0, 2,
         "hidden: error: 'linear' is not a valid value; known: sigmoid, tanh, relu"},
        {"adam", NULL, "tanh", NULL, NULL, 0, 2,
         "output activation: error: 'tanh' is not a valid value; known: sigmoid, linear"},
        {"adam", NULL, NULL, "none", NULL, 0, 2, "scale: error: 'none' is not a valid value; known: minmax, standard"},
        {"adam", NULL, NULL, "standard", NULL, 0, 2, "scale: error: standard needs linear outputs"},
        {"adam", NULL, "sigmoid", "standard", NULL, 0, 6, "scale: error: standard needs linear outputs"},
        {"adam", NULL, NULL, NULL, "l1", 0, 2, "loss: error: 'l1' is not a valid value; known: mse, smooth-l1"},
        {"lm", NULL, NULL, NULL, "smooth-l1", 0, 2, "lm: error: needs loss mse and no laws"},
        {"lm", NULL, NULL, NULL, NULL, 1, 6, "lm: error: needs loss mse and no laws"},
        {"adam", NULL, NULL, NULL, NULL, 1, 2, "laws: error: need a network with 6 outputs, such as 10-8-8-6 (got 2)"},
        {"adam", NULL, NULL, NULL, NULL, -1, 6, "laws: error: the weight of cone must be 0 or more (got -1)"},
        {"adam", NULL, NULL, NULL, NULL, NAN, 6, "the weight of cone must be 0 or more (got nan)"},
        {"adam", NULL, NULL, NULL, NULL, INFINITY, 6, "the weight of cone must be 0 or more (got inf)"},
    };
    Dataset *dataset = make_pushed_dataset(100);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        TrainingOptions options = small(cases[i].optimizer, 1);
        options.hidden = cases[i].hidden;
        options.output_activation = cases[i].activation;
        options.scale = cases[i].scale;
        options.loss = cases[i].loss;
        options.laws.of[LAW_CONE] = cases[i].cone;
        options.widths[2] = cases[i].outputs;
        refuse(dataset, options, cases[i].text);
    }
    TrainingOptions options = small("adam", 1);
    options.widths[2] = PAIR_CHANGES;
    options.laws.of[LAW_CONE] = 1;
    dataset->target = TARGET_NET;
    refuse(dataset, options, "laws: error: need a dataset with target pair in world axes (got target net");
    dataset->target = TARGET_PAIR;
    dataset->context = NULL;
    refuse(dataset, options, "laws: error: the dataset has no context; record it again with --context");
    options.laws.of[LAW_CONE] = 0;
    Network *network = training_run(dataset, &options, NULL, &error);
    assert_ok(network != NULL, error);
    network_destroy(network);
    dataset_destroy(dataset);
}

/* A start network keeps its activations and output scaling. */
TEST(options_that_contradict_the_start_network_are_refused) {
    Dataset *dataset = make_taught_dataset(100);
    TrainingOptions options = small("adam", 1);
    options.hidden = "tanh";
    Network *start = training_run(dataset, &options, NULL, &error);
    assert_ok(start != NULL, error);
    options.start = start;
    options.output_activation = "sigmoid";
    Network *same = training_run(dataset, &options, NULL, &error);
    assert_ok(same != NULL, error);
    assert_int_equal(same->activations[0], ACTIVATION_TANH);
    network_destroy(same);
    options.hidden = "sigmoid";
    refuse(dataset, options, "hidden: error: the start network has a hidden activation other than sigmoid");
    options.hidden = NULL;
    options.output_activation = "linear";
    refuse(dataset, options, "output activation: error: the start network's is not linear");
    options.output_activation = NULL;
    options.scale = "minmax";
    refuse(dataset, options, "scale: error: the start network keeps its own");
    network_destroy(start);
    dataset_destroy(dataset);
}

/* Ten equal inputs: the loss of a linear layer has curvature 10 along their sum, so a step of gradient descent at rate
   1/2 multiplies the distance from the minimum by -4. From 1 it exceeds the largest float, 2^128, in about 64 steps. */
TEST(divergence_names_its_iteration) {
    Dataset *dataset = make_taught_dataset(100);
    for (int i = 0; i < 100 * PAIR_INPUTS; i++) dataset->inputs[i] = dataset->inputs[i / PAIR_INPUTS * PAIR_INPUTS];
    TrainingOptions options = {.layers = 1,
                               .widths = {PAIR_INPUTS, 2},
                               .optimizer = "gd",
                               .iterations = 1000,
                               .seed = 1,
                               .output_activation = "linear"};
    assert_refused(training_run(dataset, &options, NULL, &error),
                   "training: error: diverged: NaN or infinite in iteration ");
    int iteration = 0;
    assert_int_equal(sscanf(strstr(error.message, "iteration "), "iteration %d", &iteration), 1);
    assert_in_range(iteration, 60, 70);
    options.iterations = iteration - 1; /* still finite */
    error = (Error){0};
    Network *network = training_run(dataset, &options, NULL, &error);
    assert_ok(network != NULL, error);
    network_destroy(network);
    dataset_destroy(dataset);
}

RUN_TESTS(NULL, NULL)
