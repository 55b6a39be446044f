/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "datasets.h"

#include "learning/pair_training_internal.h"

/* Samples of a dataset for a network without hidden layers, and a loss of them. */
typedef struct Case {
    Dataset *dataset;
    Network *network;
    Samples *train, *test;
    Loss *mse;
} Case;

static Case make_case(Dataset *dataset, int outputs, OutputScale scale) {
    Error error = {0};
    Case made = {.dataset = dataset, .network = network_sized(1, (const int[]){PAIR_INPUTS, outputs})};
    made.network->activations[0] = outputs == 2 ? ACTIVATION_SIGMOID : ACTIVATION_LINEAR;
    samples_fit_normalisation(dataset, scale, made.network);
    made.train = samples_create(dataset, made.network, false, &error);
    made.test = samples_create(dataset, made.network, true, &error);
    made.mse = loss_create(made.network, LOSS_MSE, &error);
    assert_ok(made.train != NULL && made.test != NULL && made.mse != NULL, error);
    return made;
}

static void free_case(Case *made) {
    loss_destroy(made->mse);
    samples_destroy(made->test);
    samples_destroy(made->train);
    network_destroy(made->network);
    dataset_destroy(made->dataset);
}

OWNED_VALUE(Case, free_case)

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
TEST(two_outputs_are_relative_and_min_max) {
    OWN(Case) made = make_case(small_dataset(), 2, SCALE_MINMAX);
    const Samples *train = made.train, *test = made.test;
    assert_true(train->rows == 4 && test->rows == 1 && train->blocks == 1);
    for (int r = 0; r < 4; r++) assert_near(train->y[r], r / 3.0, 1e-6);
    assert_near(test->y[0], 2, 1e-6);
    for (int r = 0; r < 4; r++) assert_true(train->y[BLOCK_ROWS + r] == 0);
    assert_true(made.network->output.offset[1] == 0 && made.network->output.scale[1] == 1);
}

/* Input 0, 2, 4, 6 has mean 3 and deviation sqrt 5; the test row must not count. */
TEST(inputs_are_standardised_by_the_rows_trained_on) {
    OWN(Case) made = make_case(small_dataset(), 2, SCALE_MINMAX);
    const Samples *train = made.train, *test = made.test;
    for (int r = 0; r < 4; r++) assert_near(train->x[r], (2 * r - 3) / sqrt(5), 1e-6);
    assert_near(test->x[0], (8 - 3) / sqrt(5), 1e-6);
    /* A constant column. */
    assert_true(made.network->input.offset[1] == 0.1f && made.network->input.scale[1] == 1);
    assert_true(train->x[BLOCK_ROWS] == 0 && train->x[BLOCK_ROWS + 3] == 0);
}

/* A box at rest has velocities of 1e-10 m/s beside positions of metres: no scale of 1e11, or the first step of another
   run would reach the network as 1e10. A column that varies by more than the rounding of 6 m has its own. */
TEST(rounding_errors_are_no_input) {
    Dataset *dataset = small_dataset();
    for (int r = 0; r < 5; r++) {
        dataset->inputs[r * PAIR_INPUTS + 2] = 1e-10f * (float)(r % 2);
        dataset->inputs[r * PAIR_INPUTS + 3] = 1e-5f * (float)(r % 2);
    }
    OWN(Case) made = make_case(dataset, 2, SCALE_MINMAX);
    assert_true(made.network->input.scale[2] == 1);
    assert_near(made.network->input.scale[3], 2e5, 1);
}

TEST(six_outputs_are_all_changes_standardised) {
    Dataset *dataset = make_dataset(1000);
    uint32_t sequence = 5;
    for (int i = 0; i < 1000 * PAIR_CHANGES; i++)
        dataset->changes[i] = 100 + (float)(i % 6 + 1) * next_number(&sequence);
    OWN(Case) made = make_case(dataset, 6, SCALE_STANDARD);
    const Samples *train = made.train;
    Network *network = made.network;
    assert_int_equal(train->blocks, 7);
    double mean[6], zero[6] = {0};
    samples_mean(train, mean);
    for (int k = 0; k < 6; k++) {
        assert_near(mean[k], 0, 1e-4);
        assert_near(network->output.offset[k], 100, 1);
        assert_near(1 / network->output.scale[k], (k + 1) / sqrt(3), 0.1); /* of the uniform distribution */
    }
    assert_near(loss_of_constant(made.mse, train, zero), 1, 1e-4);
}

/* A normalised target, set as the bias of a linear layer, is returned by network_predict() as the original change. */
TEST(normalisation_is_undone_by_prediction) {
    Dataset *dataset = make_dataset(50);
    uint32_t sequence = 9;
    for (int i = 0; i < 50 * PAIR_CHANGES; i++) dataset->changes[i] = 3 + next_number(&sequence);
    OWN(Case) made = make_case(dataset, 6, SCALE_STANDARD);
    const Samples *train = made.train;
    Network *network = made.network;
    for (int row = 0, r = 0; row < 50; row++) {
        if (row % 5 == 4) continue;
        float scratch[2 * PAIR_INPUTS], output[6];
        for (int k = 0; k < 6; k++) network->biases[0][k] = train->y[k * BLOCK_ROWS + r];
        network_predict(network, dataset->inputs + row * PAIR_INPUTS, scratch, output);
        for (int k = 0; k < 6; k++) assert_near(output[k], dataset->changes[row * PAIR_CHANGES + k], 1e-6);
        r++;
    }
}

/* The mean squared error of the constant 1/2 is 5/36 on 0, 1/3, 2/3, 1 and 9/4 on the test row's 2; the other output is
   exact. */
TEST(the_constant_predictor_has_the_variance) {
    OWN(Case) made = make_case(small_dataset(), 2, SCALE_MINMAX);
    const Samples *train = made.train, *test = made.test;
    double mean[2];
    samples_mean(train, mean);
    assert_near(mean[0], 0.5, 1e-7);
    assert_near(loss_of_constant(made.mse, train, mean), 5.0 / 72, 1e-7);
    assert_near(loss_of_constant(made.mse, test, mean), 9.0 / 8, 1e-6);
}

/* Changes of 0, 1, 2, 3 m/s, scaled by 1/3; the errors of the constant are 0.1, 0.9, 1.9, 2.9 m/s. Up to 0.3 m/s the
   loss is the square, beyond it 0.6 |e| - 0.09; in the network's units a ninth of that. */
TEST(the_smooth_loss_is_linear_beyond_its_threshold) {
    OWN(Case) made = make_case(small_dataset(), 2, SCALE_MINMAX);
    const Samples *train = made.train;
    Loss *smooth = loss_create(made.network, LOSS_SMOOTH_L1, &error);
    assert_ok(smooth != NULL, error);
    const double constant[2] = {0.1 / 3, 0};
    const double expected = 0.1 * 0.1 + 0.6 * (0.9 + 1.9 + 2.9) - 3 * 0.09;
    assert_near(loss_of_constant(smooth, train, constant), expected / 9 / 8, 1e-7);
    /* A network that predicts the constant. */
    double parameters[22] = {[20] = -log(1 / constant[0] - 1), [21] = -1000};
    assert_near(loss_value(smooth, train, NULL, parameters), expected / 9 / 8, 1e-7);
    /* All errors within the threshold: equal to mse. */
    made.network->output.scale[0] = made.network->output.scale[1] = 100;
    Loss *wide = loss_create(made.network, LOSS_SMOOTH_L1, &error);
    assert_ok(wide != NULL, error);
    assert_true(loss_of_constant(wide, train, constant) == loss_of_constant(made.mse, train, constant));
    loss_destroy(wide);
    loss_destroy(smooth);
}

/* A network of zeros predicts 1/2 through its sigmoid: its loss is that of the constant, also over many chunks and a
   partly filled block. */
TEST(loss_of_a_constant_network_is_that_of_the_constant) {
    const double parameters[22] = {0}, half[2] = {0.5, 0.5};
    OWN(Case) made = make_case(make_taught_dataset(10007), 2, SCALE_MINMAX);
    assert_int_equal(network_parameter_count(made.network), 22);
    double expected = loss_of_constant(made.mse, made.train, half);
    assert_true(expected > 0.01);
    assert_near(loss_value(made.mse, made.train, NULL, parameters), expected, 1e-12);
}

RUN_TESTS(NULL, NULL)
