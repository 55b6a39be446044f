/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "networks.h"

#include <math.h>

static void predict(const Network *network, const float *input, float *output) {
    float *scratch = malloc(2 * (size_t)network_scratch_width(network) * sizeof *scratch);
    assert_non_null(scratch);
    network_predict(network, input, scratch, output);
    free(scratch);
}

static void a_new_network_is_zero_with_identity_normalisation(void **state) {
    (void)state;
    Error error = {0};
    Network *network = network_create(2, (const int[]){3, 5, 2}, &error);
    assert_ok(network != NULL, error);
    const float input[3] = {1, -2, 3};
    float output[2] = {7, 7};
    predict(network, input, output);
    assert_int_equal(network_parameter_count(network), 5 * 4 + 2 * 6);
    assert_int_equal(network_scratch_width(network), 5);
    assert_true(output[0] == 0 && output[1] == 0);
    network_destroy(network);
}

/* hidden = tanh(2 x - y + 0.25), output = (3 hidden - 1) / 4 + 10 with x, y = (inputs - (1, 2)) * (0.5, 3) */
static void two_layers_in_closed_form(void **state) {
    (void)state;
    Network *network =
        make_network(2, (const int[]){2, 1, 1}, (const Activation[]){ACTIVATION_TANH, ACTIVATION_LINEAR});
    const float numbers[] = {2, -1, 0.25f, 3, -1};
    memcpy(network->weights[0], numbers, sizeof numbers);
    network->input.offset[0] = 1, network->input.offset[1] = 2;
    network->input.scale[0] = 0.5f, network->input.scale[1] = 3;
    network->output.offset[0] = 10, network->output.scale[0] = 4;
    const float input[2] = {2, 2.25f};
    float output;
    predict(network, input, &output);
    double hidden = tanh(2 * 0.5 - 0.75 + 0.25);
    assert_near(output, (3 * hidden - 1) / 4 + 10, 1e-6);
    network_destroy(network);
}

/* weights[j, i] goes from input i to output j. */
static void weights_are_stored_row_by_row(void **state) {
    (void)state;
    Network *network = make_network(1, (const int[]){3, 2}, (const Activation[]){ACTIVATION_LINEAR});
    const float numbers[] = {1, 10, 100, 1000, 10000, 100000, 0.5f, 0.25f}, input[3] = {1, 2, 3};
    memcpy(network->weights[0], numbers, sizeof numbers);
    float output[2];
    predict(network, input, output);
    assert_true(output[0] == 321.5f && output[1] == 321000.25f);
    network_destroy(network);
}

/* From the bias on, inputs rising, in float32: 0.5 is lost in 1e8, the 1 that comes after it is not. Any
   other order, or a wider sum, gives 0, 0.5 or 1.5. */
static void sums_start_from_the_bias_and_rise(void **state) {
    (void)state;
    Network *network = make_network(1, (const int[]){3, 1}, (const Activation[]){ACTIVATION_LINEAR});
    const float numbers[] = {1e8f, -1e8f, 1, 0.5f}, input[3] = {1, 1, 1};
    memcpy(network->weights[0], numbers, sizeof numbers);
    float output;
    predict(network, input, &output);
    assert_true(output == 1);
    network_destroy(network);
}

static float activated(Activation activation, float x) {
    Network *network = make_network(1, (const int[]){1, 1}, &activation);
    network->weights[0][0] = 1, network->biases[0][0] = 0;
    float output;
    predict(network, &x, &output);
    network_destroy(network);
    return output;
}

/* Values of the functions to 17 digits, from their series; sigmoid(-x) = 1 - sigmoid(x). */
static void activations_are_the_double_function_rounded(void **state) {
    (void)state;
    assert_true(activated(ACTIVATION_SIGMOID, 0) == 0.5f);
    assert_true(activated(ACTIVATION_SIGMOID, 1) == (float)0.73105857863000488);
    assert_true(activated(ACTIVATION_SIGMOID, -1) == (float)0.26894142136999512);
    assert_true(activated(ACTIVATION_SIGMOID, 1000) == 1 && activated(ACTIVATION_SIGMOID, -1000) == 0);
    assert_true(activated(ACTIVATION_TANH, 1) == (float)0.76159415595576489);
    assert_true(activated(ACTIVATION_TANH, -0.5f) == (float)-0.46211715726000975);
    assert_true(activated(ACTIVATION_LINEAR, -3.25f) == -3.25f);
    for (int i = -2000; i <= 2000; i++) {
        float x = (float)i / 128;
        assert_true(activated(ACTIVATION_SIGMOID, x) == (float)(1.0 / (1.0 + exp(-(double)x))));
        assert_true(activated(ACTIVATION_TANH, x) == (float)tanh((double)x));
    }
}

static void a_copy_has_numbers_of_its_own(void **state) {
    (void)state;
    Network *network =
        make_network(2, (const int[]){3, 4, 2}, (const Activation[]){ACTIVATION_SIGMOID, ACTIVATION_TANH});
    network->output.offset[1] = 5, network->input.scale[2] = 3;
    strcpy(network->inputs, "x y z");
    Error error = {0};
    Network *copy = network_copy(network, &error);
    assert_ok(copy != NULL, error);
    const float input[3] = {0.5f, -0.25f, 1};
    float before[2], after[2];
    predict(network, input, before);
    network->weights[1][0] += 1, network->output.offset[1] = 0;
    predict(copy, input, after);
    assert_memory_equal(before, after, sizeof before);
    assert_string_equal(copy->inputs, "x y z");
    network_destroy(copy);
    network_destroy(network);
}

static void assert_refused(int layers, const int *widths, const char *text) {
    Error error = {0};
    assert_null(network_create(layers, widths, &error));
    assert_error(error, ERROR_INPUT, text);
}

static void impossible_shapes_are_refused(void **state) {
    (void)state;
    const int many[] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    assert_refused(0, (const int[]){3}, "0 layers");
    assert_refused(9, many, "9 layers");
    assert_refused(2, (const int[]){3, 0, 2}, "width 0 of layer 1");
    assert_refused(2, (const int[]){-3, 4, 2}, "width -3 of layer 0");
    assert_refused(1, (const int[]){3, 4097}, "width 4097 of layer 1");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_new_network_is_zero_with_identity_normalisation),
        cmocka_unit_test(two_layers_in_closed_form),
        cmocka_unit_test(weights_are_stored_row_by_row),
        cmocka_unit_test(sums_start_from_the_bias_and_rise),
        cmocka_unit_test(activations_are_the_double_function_rounded),
        cmocka_unit_test(a_copy_has_numbers_of_its_own),
        cmocka_unit_test(impossible_shapes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
