/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "datasets.h"

#include "learning/pair_training_internal.h"

#include <math.h>

static Network *make_network(int outputs, Activation last) {
    Error error = {0};
    Network *network = network_create(1, (const int[]){PAIR_INPUTS, outputs}, &error);
    assert_ok(network != NULL, error);
    network->activations[0] = last;
    return network;
}

/* Five rows: 0 to 3 are training rows, row 4 is the test row. Changes of a's x velocity -0, -1, -2, -3, -6; of b's
   0. */
static Dataset *small_dataset(void) {
    Dataset *dataset = make_dataset(5);
    for (int r = 0; r < 5; r++) {
        dataset->changes[r * PAIR_CHANGES] = r < 4 ? (float)-r : -6;
        dataset->inputs[r * PAIR_INPUTS] = (float)(2 * r);
        dataset->inputs[r * PAIR_INPUTS + 1] = 0.1f;
    }
    return dataset;
}

/* Relative change x: 0, 1, 2, 3 -> 0, 1/3, 2/3, 1; the test row's 6 -> 2. y is constant. */
static void two_outputs_are_relative_and_min_max(void **state) {
    (void)state;
    Error error = {0};
    Dataset *dataset = small_dataset();
    Network *network = make_network(2, ACTIVATION_SIGMOID);
    samples_fit_normalisation(dataset, SCALE_MINMAX, network);
    Samples *train = samples_create(dataset, network, false, &error),
            *test = samples_create(dataset, network, true, &error);
    assert_ok(train != NULL && test != NULL, error);
    assert_true(train->rows == 4 && test->rows == 1 && train->blocks == 1);
    for (int r = 0; r < 4; r++) assert_near(train->y[r], r / 3.0, 1e-6);
    assert_near(test->y[0], 2, 1e-6);
    for (int r = 0; r < 4; r++) assert_true(train->y[BLOCK_ROWS + r] == 0);
    assert_true(network->output.offset[1] == 0 && network->output.scale[1] == 1);
    samples_destroy(test);
    samples_destroy(train);
    network_destroy(network);
    dataset_destroy(dataset);
}

/* Input 0, 2, 4, 6 has mean 3 and deviation sqrt 5; the test row must not count. */
static void inputs_are_standardised_by_the_rows_trained_on(void **state) {
    (void)state;
    Error error = {0};
    Dataset *dataset = small_dataset();
    Network *network = make_network(2, ACTIVATION_SIGMOID);
    samples_fit_normalisation(dataset, SCALE_MINMAX, network);
    Samples *train = samples_create(dataset, network, false, &error),
            *test = samples_create(dataset, network, true, &error);
    assert_ok(train != NULL && test != NULL, error);
    for (int r = 0; r < 4; r++) assert_near(train->x[r], (2 * r - 3) / sqrt(5), 1e-6);
    assert_near(test->x[0], (8 - 3) / sqrt(5), 1e-6);
    /* A constant column. */
    assert_true(network->input.offset[1] == 0.1f && network->input.scale[1] == 1);
    assert_true(train->x[BLOCK_ROWS] == 0 && train->x[BLOCK_ROWS + 3] == 0);
    samples_destroy(test);
    samples_destroy(train);
    network_destroy(network);
    dataset_destroy(dataset);
}

static void six_outputs_are_all_changes_standardised(void **state) {
    (void)state;
    Error error = {0};
    Dataset *dataset = make_dataset(1000);
    uint32_t sequence = 5;
    for (int i = 0; i < 1000 * PAIR_CHANGES; i++)
        dataset->changes[i] = 100 + (float)(i % 6 + 1) * next_number(&sequence);
    Network *network = make_network(6, ACTIVATION_LINEAR);
    samples_fit_normalisation(dataset, SCALE_STANDARD, network);
    Samples *train = samples_create(dataset, network, false, &error);
    assert_ok(train != NULL, error);
    assert_int_equal(train->blocks, 7);
    double mean[6], zero[6] = {0};
    samples_mean(train, mean);
    for (int k = 0; k < 6; k++) {
        assert_near(mean[k], 0, 1e-4);
        assert_near(network->output.offset[k], 100, 1);
        assert_near(1 / network->output.scale[k], (k + 1) / sqrt(3), 0.1); /* of the uniform distribution */
    }
    Loss *loss = loss_create(network, LOSS_MSE, &error);
    assert_ok(loss != NULL, error);
    assert_near(loss_of_constant(loss, train, zero), 1, 1e-4);
    loss_destroy(loss);
    samples_destroy(train);
    network_destroy(network);
    dataset_destroy(dataset);
}

/* A normalised target, set as the bias of a linear layer, is returned by network_predict() as the original change. */
static void normalisation_is_undone_by_prediction(void **state) {
    (void)state;
    Error error = {0};
    Dataset *dataset = make_dataset(50);
    uint32_t sequence = 9;
    for (int i = 0; i < 50 * PAIR_CHANGES; i++) dataset->changes[i] = 3 + next_number(&sequence);
    Network *network = make_network(6, ACTIVATION_LINEAR);
    samples_fit_normalisation(dataset, SCALE_STANDARD, network);
    Samples *train = samples_create(dataset, network, false, &error);
    assert_ok(train != NULL, error);
    for (int row = 0, r = 0; row < 50; row++) {
        if (row % 5 == 4) continue;
        float scratch[2 * PAIR_INPUTS], output[6];
        for (int k = 0; k < 6; k++) network->biases[0][k] = train->y[k * BLOCK_ROWS + r];
        network_predict(network, dataset->inputs + row * PAIR_INPUTS, scratch, output);
        for (int k = 0; k < 6; k++) assert_near(output[k], dataset->changes[row * PAIR_CHANGES + k], 1e-6);
        r++;
    }
    samples_destroy(train);
    network_destroy(network);
    dataset_destroy(dataset);
}

/* The mean squared error of the constant 1/2 is 5/36 on 0, 1/3, 2/3, 1 and 9/4 on the test row's 2; the other output is
   exact. */
static void the_constant_predictor_has_the_variance(void **state) {
    (void)state;
    Error error = {0};
    Dataset *dataset = small_dataset();
    Network *network = make_network(2, ACTIVATION_SIGMOID);
    samples_fit_normalisation(dataset, SCALE_MINMAX, network);
    Samples *train = samples_create(dataset, network, false, &error),
            *test = samples_create(dataset, network, true, &error);
    assert_ok(train != NULL && test != NULL, error);
    double mean[2];
    samples_mean(train, mean);
    assert_near(mean[0], 0.5, 1e-7);
    Loss *loss = loss_create(network, LOSS_MSE, &error);
    assert_ok(loss != NULL, error);
    assert_near(loss_of_constant(loss, train, mean), 5.0 / 72, 1e-7);
    assert_near(loss_of_constant(loss, test, mean), 9.0 / 8, 1e-6);
    loss_destroy(loss);
    samples_destroy(test);
    samples_destroy(train);
    network_destroy(network);
    dataset_destroy(dataset);
}

/* Changes of 0, 1, 2, 3 m/s, scaled by 1/3; the errors of the constant are 0.1, 0.9, 1.9, 2.9 m/s. Up to 0.3 m/s the
   loss is the square, beyond it 0.6 |e| - 0.09; in the network's units a ninth of that. */
static void the_smooth_loss_is_linear_beyond_its_threshold(void **state) {
    (void)state;
    Error error = {0};
    Dataset *dataset = small_dataset();
    Network *network = make_network(2, ACTIVATION_SIGMOID);
    samples_fit_normalisation(dataset, SCALE_MINMAX, network);
    Samples *train = samples_create(dataset, network, false, &error);
    Loss *smooth = loss_create(network, LOSS_SMOOTH_L1, &error), *mse = loss_create(network, LOSS_MSE, &error);
    assert_ok(train != NULL && smooth != NULL && mse != NULL, error);
    const double constant[2] = {0.1 / 3, 0};
    const double expected = 0.1 * 0.1 + 0.6 * (0.9 + 1.9 + 2.9) - 3 * 0.09;
    assert_near(loss_of_constant(smooth, train, constant), expected / 9 / 8, 1e-7);
    /* A network that predicts the constant. */
    double parameters[22] = {[20] = -log(1 / constant[0] - 1), [21] = -1000};
    assert_near(loss_value(smooth, train, NULL, parameters), expected / 9 / 8, 1e-7);
    /* All errors within the threshold: equal to mse. */
    network->output.scale[0] = network->output.scale[1] = 100;
    Loss *wide = loss_create(network, LOSS_SMOOTH_L1, &error);
    assert_ok(wide != NULL, error);
    assert_true(loss_of_constant(wide, train, constant) == loss_of_constant(mse, train, constant));
    loss_destroy(wide);
    loss_destroy(mse);
    loss_destroy(smooth);
    samples_destroy(train);
    network_destroy(network);
    dataset_destroy(dataset);
}

/* A network of zeros predicts 1/2 through its sigmoid: its loss is that of the constant, also over many chunks and a
   partly filled block. */
static void loss_of_a_constant_network_is_that_of_the_constant(void **state) {
    (void)state;
    Error error = {0};
    Dataset *dataset = make_taught_dataset(10007);
    const double parameters[22] = {0}, half[2] = {0.5, 0.5};
    Network *network = make_network(2, ACTIVATION_SIGMOID);
    samples_fit_normalisation(dataset, SCALE_MINMAX, network);
    Samples *train = samples_create(dataset, network, false, &error);
    Loss *loss = loss_create(network, LOSS_MSE, &error);
    assert_ok(train != NULL && loss != NULL, error);
    assert_int_equal(network_parameter_count(network), 22);
    double expected = loss_of_constant(loss, train, half);
    assert_true(expected > 0.01);
    assert_near(loss_value(loss, train, NULL, parameters), expected, 1e-12);
    loss_destroy(loss);
    samples_destroy(train);
    network_destroy(network);
    dataset_destroy(dataset);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_outputs_are_relative_and_min_max),
        cmocka_unit_test(inputs_are_standardised_by_the_rows_trained_on),
        cmocka_unit_test(six_outputs_are_all_changes_standardised),
        cmocka_unit_test(normalisation_is_undone_by_prediction),
        cmocka_unit_test(the_constant_predictor_has_the_variance),
        cmocka_unit_test(the_smooth_loss_is_linear_beyond_its_threshold),
        cmocka_unit_test(loss_of_a_constant_network_is_that_of_the_constant),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
