/* SPDX-License-Identifier: GPL-3.0-or-later */
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

/* How many values of rectified layers are above 0. */
static int count_active(const Case *made) {
    int count = 0;
    for (int l = 0; l < made->network->layers; l++) {
        if (made->network->activations[l] != ACTIVATION_RELU) continue;
        for (int j = 0; j < made->network->widths[l + 1]; j++)
            for (int r = 0; r < USED_ROWS; r++) count += made->block->values[l + 1][j * BLOCK_ROWS + r] > 0;
    }
    return count;
}

/* Central differences: their error is of the order of step^2, below 1e-8 here. Across the kink of a rectifier they
   would be wrong: as many values are active on both sides of each step. Slopes that are not 0 are counted, or a lost
   term would go unseen; below its kink a rectifier has none. */
static void check_gradient(int layers, const int *widths, const Activation *activations) {
    OWN(Case) made = make_case(layers, widths, activations);
    FREED double *gradient = calloc((size_t)made.count, sizeof *gradient);
    assert_non_null(gradient);
    add_gradient(&made, gradient);
    const double step = 1e-5;
    const int active = count_active(&made);
    int slopes = 0;
    for (int p = 0; p < made.count; p++) {
        double kept = made.parameters[p];
        made.parameters[p] = kept + step;
        double above = loss(&made);
        assert_int_equal(count_active(&made), active);
        made.parameters[p] = kept - step;
        double slope = (above - loss(&made)) / (2 * step);
        assert_int_equal(count_active(&made), active);
        made.parameters[p] = kept;
        assert_near(gradient[p], slope, 1e-8);
        slopes += fabs(slope) > 1e-6;
    }
    assert_true(active > 0 ? slopes > made.count / 2 : slopes == made.count);
}

/* Each input is shifted in one row. */
TEST(slopes_of_the_inputs_are_the_finite_difference) {
    const int widths[] = {3, 5, 2};
    const Activation activations[] = {ACTIVATION_TANH, ACTIVATION_LINEAR};
    const double step = 1e-5;
    OWN(Case) made = make_case(2, widths, activations);
    FREED double *gradient = calloc((size_t)made.count, sizeof *gradient);
    static double slopes[3 * BLOCK_ROWS];
    assert_non_null(gradient);
    add_gradient(&made, gradient);
    network_backward_to_inputs(made.block, made.parameters, slopes);
    for (int i = 0; i < 3; i++)
        for (int r = 0; r < BLOCK_ROWS; r += 7) {
            double *input = &made.block->values[0][i * BLOCK_ROWS + r];
            const double kept = *input;
            *input = kept + step;
            const double above = loss(&made);
            *input = kept - step;
            const double slope = (above - loss(&made)) / (2 * step);
            *input = kept;
            assert_near(slopes[i * BLOCK_ROWS + r], slope, 1e-8);
            assert_true((fabs(slope) > 1e-6) == (r < USED_ROWS));
        }
}

TEST(backward_is_the_finite_difference) {
    const Activation linear = ACTIVATION_LINEAR, sigmoid = ACTIVATION_SIGMOID, tangent = ACTIVATION_TANH,
                     relu = ACTIVATION_RELU;
    check_gradient(1, (const int[]){3, 2}, (const Activation[]){linear});
    check_gradient(1, (const int[]){3, 2}, (const Activation[]){sigmoid});
    check_gradient(1, (const int[]){3, 2}, (const Activation[]){tangent});
    check_gradient(2, (const int[]){10, 10, 2}, (const Activation[]){sigmoid, sigmoid});
    check_gradient(2, (const int[]){4, 5, 3}, (const Activation[]){tangent, linear});
    check_gradient(3, (const int[]){10, 8, 8, 6}, (const Activation[]){sigmoid, sigmoid, linear});
    check_gradient(4, (const int[]){2, 3, 4, 1, 2}, (const Activation[]){tangent, linear, sigmoid, tangent});
    check_gradient(1, (const int[]){3, 2}, (const Activation[]){relu});
    check_gradient(2, (const int[]){10, 10, 2}, (const Activation[]){relu, sigmoid});
    check_gradient(2, (const int[]){4, 5, 3}, (const Activation[]){relu, linear});
    check_gradient(3, (const int[]){10, 8, 8, 6}, (const Activation[]){relu, relu, linear});
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

TEST(gradients_add_up) {
    OWN(Case) made = make_case(2, (const int[]){3, 4, 2}, (const Activation[]){ACTIVATION_TANH, ACTIVATION_LINEAR});
    double once[64] = {0}, twice[64] = {0};
    assert_true(made.count <= 64);
    add_gradient(&made, once);
    add_gradient(&made, twice);
    add_gradient(&made, twice);
    for (int p = 0; p < made.count; p++) assert_true(twice[p] == 2 * once[p]);
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

TEST(dot_sums_every_row_once) {
    double a[BLOCK_ROWS], b[BLOCK_ROWS];
    for (int r = 0; r < BLOCK_ROWS; r++) a[r] = r + 1, b[r] = r;
    /* sum of r^2 + r for r < n = (n - 1) n (n + 1) / 3 */
    assert_true(network_block_dot(a, b) == (BLOCK_ROWS - 1.0) * BLOCK_ROWS * (BLOCK_ROWS + 1.0) / 3);
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
