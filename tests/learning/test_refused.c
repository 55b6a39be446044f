/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "datasets.h"

#include <float.h>

static void refuse(const Dataset *dataset, TrainingOptions options, const char *text) {
    Error error = {0};
    assert_refused(training_run(dataset, &options, NULL, &error), text);
}

static void invalid_options_are_refused(void **state) {
    (void)state;
    Dataset *dataset = make_taught_dataset(100);
    TrainingOptions options = small("magic", 1);
    refuse(dataset, options, "'magic' is not an optimizer; known: adam, bfgs, gd, lm");
    options = small("adam", -1);
    refuse(dataset, options, "iterations: error: must be 0 or more (got -1)");
    options = small("adam", 1);
    options.widths[0] = 9;
    refuse(dataset, options, "the first width must be 10, the inputs of a pair (got 9)");
    options = small("adam", 1);
    options.widths[2] = 3;
    refuse(dataset, options, "the last width must be 2 (relative velocity) or 6 (both bodies) (got 3)");
    options = small("adam", 1);
    options.widths[1] = 0;
    refuse(dataset, options, "width 0");
    options = small("adam", 1);
    options.layers = 0;
    refuse(dataset, options, "weight layers (got 0)");
    options = small("lm", 1);
    options.widths[1] = 20; /* 262 parameters, 80 rows of 2 */
    refuse(dataset, options, "as many target values as weights (got 160 and 262)");
    options.widths[1] = 200;
    refuse(dataset, options, "at most 2000 weights (got 2602)");
    Error error = {0};
    Network *start = network_create(2, (const int[]){PAIR_INPUTS, 5, 2}, &error);
    assert_ok(start != NULL, error);
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
static void infinite_loss_is_an_error(void **state) {
    (void)state;
    Dataset *dataset = make_taught_dataset(100);
    dataset->changes[0] = -FLT_MAX, dataset->changes[3] = FLT_MAX;
    refuse(dataset, small("adam", 3), "iteration 0");
    refuse(dataset, small("bfgs", 3), "iteration 0");
    refuse(dataset, small("gd", 3), "iteration 0");
    refuse(dataset, small("lm", 3), "iteration 0");
    dataset_destroy(dataset);
}

static void invalid_network_config_is_refused(void **state) {
    (void)state;
    Dataset *dataset = make_taught_dataset(100);
    TrainingOptions options = small("adam", 1);
    options.hidden = "linear";
    refuse(dataset, options, "hidden: error: 'linear' is not a valid value; known: sigmoid, tanh, relu");
    options = small("adam", 1);
    options.output_activation = "tanh";
    refuse(dataset, options, "output activation: error: 'tanh' is not a valid value; known: sigmoid, linear");
    options = small("adam", 1);
    options.scale = "none";
    refuse(dataset, options, "scale: error: 'none' is not a valid value; known: minmax, standard");
    options.scale = "standard";
    refuse(dataset, options, "scale: error: standard needs linear outputs");
    options.widths[2] = PAIR_CHANGES;
    options.output_activation = "sigmoid";
    refuse(dataset, options, "scale: error: standard needs linear outputs");
    dataset_destroy(dataset);
}

static void invalid_losses_are_refused(void **state) {
    (void)state;
    Dataset *dataset = make_pushed_dataset(100);
    TrainingOptions options = small("adam", 1);
    options.loss = "l1";
    refuse(dataset, options, "loss: error: 'l1' is not a valid value; known: mse, smooth-l1");
    options = small("lm", 1);
    options.loss = "smooth-l1";
    refuse(dataset, options, "lm: error: needs loss mse and no laws");
    options = small("adam", 1);
    options.laws.of[LAW_CONE] = 1;
    refuse(dataset, options, "laws: error: need a network with 6 outputs, such as 10-8-8-6 (got 2)");
    options.widths[2] = PAIR_CHANGES;
    options.optimizer = "lm";
    refuse(dataset, options, "lm: error: needs loss mse and no laws");
    options.optimizer = "adam";
    options.laws.of[LAW_CONE] = -1;
    refuse(dataset, options, "laws: error: the weight of cone must be 0 or more (got -1)");
    options.laws.of[LAW_CONE] = NAN;
    refuse(dataset, options, "the weight of cone must be 0 or more (got nan)");
    options.laws.of[LAW_CONE] = INFINITY;
    refuse(dataset, options, "the weight of cone must be 0 or more (got inf)");
    options.laws.of[LAW_CONE] = 1;
    dataset->target = TARGET_NET;
    refuse(dataset, options, "laws: error: need a dataset with target pair in world axes (got target net");
    dataset->target = TARGET_PAIR;
    free(dataset->context);
    dataset->context = NULL;
    refuse(dataset, options, "laws: error: the dataset has no context; record it again with --context");
    options.laws.of[LAW_CONE] = 0;
    Error error = {0};
    Network *network = training_run(dataset, &options, NULL, &error);
    assert_ok(network != NULL, error);
    network_destroy(network);
    dataset_destroy(dataset);
}

/* A start network keeps its activations and output scaling. */
static void options_that_contradict_the_start_network_are_refused(void **state) {
    (void)state;
    Error error = {0};
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
static void divergence_names_its_iteration(void **state) {
    (void)state;
    Error error = {0};
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(invalid_options_are_refused),
        cmocka_unit_test(invalid_network_config_is_refused),
        cmocka_unit_test(invalid_losses_are_refused),
        cmocka_unit_test(options_that_contradict_the_start_network_are_refused),
        cmocka_unit_test(divergence_names_its_iteration),
        cmocka_unit_test(infinite_loss_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
