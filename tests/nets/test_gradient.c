/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks of rows: forward, backward and their bits. (That slopes are finite differences is a law of every loss:
   learning/derivatives, sain_loss, window_fit.) */
#include "networks.h"
#include "owned.h"

#include "nets/kernels.h"

enum { USED_ROWS = 5 }; /* of the block */

/* A network, its parameters in double, a block of inputs, and a loss: sum over rows and outputs of c y +
   y^2. */
typedef struct Case {
    Network *network;
    NetworkBlock *block;
    int count, outputs;
    double *parameters, *factors; /* c [outputs, BLOCK_ROWS] */
} Case;

static Case make_case(int layers, const int *widths, const Activation *activations) {
    Error error = {0};
    Case made = {.network = make_network(layers, widths, activations), .outputs = widths[layers]};
    made.block = network_block_create(made.network, &error);
    assert_ok(made.block != NULL, error);
    made.count = network_parameter_count(made.network);
    made.parameters = malloc((size_t)made.count * sizeof(double));
    made.factors = malloc((size_t)made.outputs * BLOCK_ROWS * sizeof(double));
    assert_true(made.parameters != NULL && made.factors != NULL);
    uint32_t sequence = 7;
    for (int p = 0; p < made.count; p++) made.parameters[p] = next_number(&sequence);
    for (int i = 0; i < widths[0] * BLOCK_ROWS; i++) made.block->values[0][i] = next_number(&sequence);
    for (int i = 0; i < made.outputs * BLOCK_ROWS; i++) made.factors[i] = next_number(&sequence);
    return made;
}

static void free_case(Case *made) {
    network_block_destroy(made->block);
    network_destroy(made->network);
    free(made->parameters);
    free(made->factors);
}

OWNED_VALUE(Case, free_case)

static double loss(Case *made) {
    network_forward(made->block, made->parameters);
    const double *y = made->block->values[made->network->layers];
    double sum = 0;
    for (int k = 0; k < made->outputs; k++)
        for (int r = 0; r < USED_ROWS; r++) {
            int i = k * BLOCK_ROWS + r;
            sum += made->factors[i] * y[i] + y[i] * y[i];
        }
    return sum;
}

static void add_gradient(Case *made, double *gradient) {
    loss(made);
    int layers = made->network->layers;
    const double *y = made->block->values[layers];
    for (int i = 0; i < made->outputs * BLOCK_ROWS; i++)
        made->block->deltas[layers - 1][i] = i % BLOCK_ROWS < USED_ROWS ? made->factors[i] + 2 * y[i] : 0;
    network_backward(made->block, made->parameters);
    network_add_gradient(made->block, gradient);
}

/* Where a sum is exactly 0, the slope taken is 0. */
TEST(the_rectifiers_slope_at_its_kink_is_zero) {
    OWN(Case) made = make_case(2, (const int[]){2, 2, 1}, (const Activation[]){ACTIVATION_RELU, ACTIVATION_LINEAR});
    double gradient[16] = {0};
    for (int p = 0; p < 6; p++) made.parameters[p] = 0; /* weights and biases of the hidden layer */
    add_gradient(&made, gradient);
    for (int p = 0; p < 8; p++) assert_true(gradient[p] == 0);
    assert_true(gradient[8] != 0); /* the output's bias */
}

/* Training and inference are the same function, one in double, the other in float32. */
TEST(forward_agrees_with_predict) {
    OWN(Case)
    made = make_case(3, (const int[]){4, 6, 5, 2},
                     (const Activation[]){ACTIVATION_TANH, ACTIVATION_SIGMOID, ACTIVATION_LINEAR});
    for (int p = 0; p < made.count; p++) made.parameters[p] = (double)made.network->weights[0][p];
    network_forward(made.block, made.parameters);
    for (int r = 0; r < BLOCK_ROWS; r++) {
        float input[4], scratch[12], output[2];
        for (int i = 0; i < 4; i++) input[i] = (float)made.block->values[0][i * BLOCK_ROWS + r];
        network_predict(made.network, input, scratch, output);
        for (int k = 0; k < 2; k++) assert_near(made.block->values[3][k * BLOCK_ROWS + r], output[k], 1e-6);
    }
}

static void gradient_by(const Kernels *kernels, Case *made, double *gradient) {
    const int layers = made->network->layers;
    kernels->forward(made->block, made->parameters);
    const double *y = made->block->values[layers];
    for (int i = 0; i < made->outputs * BLOCK_ROWS; i++) made->block->deltas[layers - 1][i] = made->factors[i] + y[i];
    kernels->backward(made->block, made->parameters);
    kernels->add_gradient(made->block, gradient);
}

TEST(all_instruction_sets_give_the_same_bits) {
    OWN(Case)
    made = make_case(4, (const int[]){10, 9, 7, 5, 2},
                     (const Activation[]){ACTIVATION_SIGMOID, ACTIVATION_TANH, ACTIVATION_RELU, ACTIVATION_LINEAR});
    double expected[256] = {0};
    assert_true(made.count <= 256);
    gradient_by(&kernels_scalar, &made, expected);
    const double *y = made.block->values[1];
    const double expected_dot = kernels_scalar.dot(y, y + BLOCK_ROWS);
    const Kernels *list[KERNELS_MAX + 1];
    kernels_list(list);
    for (int k = 0; list[k] != NULL; k++) {
        double gradient[256] = {0};
        gradient_by(list[k], &made, gradient);
        assert_memory_equal(gradient, expected, sizeof gradient);
        assert_true(list[k]->dot(y, y + BLOCK_ROWS) == expected_dot);
    }
}

RUN_TESTS(NULL, NULL)
