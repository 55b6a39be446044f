/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "networks.h"
#include "owned.h"

#include "nets/kernels.h"

static void predict(const Network *network, const float *input, float *output) {
    FREED float *scratch = malloc(2 * (size_t)network_scratch_width(network) * sizeof *scratch);
    assert_non_null(scratch);
    network_predict(network, input, scratch, output);
}

TEST(a_new_network_is_zero_with_identity_normalisation) {
    OWN(Network) *network = network_sized(2, (const int[]){3, 5, 2});
    const float input[3] = {1, -2, 3};
    float output[2] = {7, 7};
    predict(network, input, output);
    assert_int_equal(network_parameter_count(network), 5 * 4 + 2 * 6);
    assert_int_equal(network_scratch_width(network), 5);
    assert_true(output[0] == 0 && output[1] == 0);
}

/* hidden = tanh(2 x - y + 0.25), output = (3 hidden - 1) / 4 + 10 with x, y = (inputs - (1, 2)) * (0.5, 3) */
TEST(two_layers_in_closed_form) {
    OWN(Network) *network =
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
}

/* From the bias on, inputs rising, in float32: 0.5 is lost in 1e8, the 1 that comes after it is not. Any
   other order, or a wider sum, gives 0, 0.5 or 1.5. */
TEST(sums_start_from_the_bias_and_rise) {
    OWN(Network) *network = make_network(1, (const int[]){3, 1}, (const Activation[]){ACTIVATION_LINEAR});
    const float numbers[] = {1e8f, -1e8f, 1, 0.5f}, input[3] = {1, 1, 1};
    memcpy(network->weights[0], numbers, sizeof numbers);
    float output;
    predict(network, input, &output);
    assert_true(output == 1);
}

static bool same_bits(float a, float b) { return (isnan(a) && isnan(b)) || memcmp(&a, &b, sizeof a) == 0; }

/* Buffers of a batch of `rows`, and its inputs row by row. */
typedef struct Batch {
    int rows, ins, outs;
    float *row_inputs, *inputs, *outputs, *scratch;
} Batch;

static Batch make_batch(const Network *network, int rows) {
    Batch batch = {.rows = rows, .ins = network->widths[0], .outs = network->widths[network->layers]};
    const size_t inputs_size = (size_t)(rows * batch.ins) * sizeof(float);
    batch.row_inputs = malloc(inputs_size);
    batch.inputs = malloc(inputs_size);
    batch.outputs = malloc((size_t)(rows * batch.outs) * sizeof(float));
    batch.scratch = malloc(network_batch_scratch(network) * sizeof(float));
    assert_true(batch.row_inputs && batch.inputs && batch.outputs && batch.scratch);
    const float special[] = {NAN, INFINITY, -INFINITY, 1e38f, -0.0f};
    uint32_t sequence = 3;
    for (int r = 0; r < rows; r++)
        for (int i = 0; i < batch.ins; i++) {
            float x = 4 * (float)next_number(&sequence);
            if (r % 16 == 15 && i == r % batch.ins) x = special[r / 16 % 5];
            batch.row_inputs[r * batch.ins + i] = x;
            batch.inputs[i * rows + r] = x;
        }
    return batch;
}

static void free_batch(Batch *batch) {
    free(batch->row_inputs);
    free(batch->inputs);
    free(batch->outputs);
    free(batch->scratch);
}

static void assert_as_row_by_row(const Network *network, const Batch *batch) {
    float output[8];
    for (int r = 0; r < batch->rows; r++) {
        network_predict(network, batch->row_inputs + r * batch->ins, batch->scratch, output);
        for (int k = 0; k < batch->outs; k++)
            if (!same_bits(output[k], batch->outputs[k * batch->rows + r]))
                fail_msg("row %d of %d, output %d: %a, not %a", r, batch->rows, k, batch->outputs[k * batch->rows + r],
                         output[k]);
    }
}

static void check_batches(int layers, const int *widths, const Activation *activations) {
    OWN(Network) *network = make_network(layers, widths, activations);
    for (int i = 0; i < widths[0]; i++) network->input.offset[i] = 0.1f * (float)i, network->input.scale[i] = 0.7f;
    for (int k = 0; k < widths[layers]; k++) network->output.offset[k] = -0.3f, network->output.scale[k] = 0.11f;
    const int rows[] = {1, 2, 3, 63, 64, 65, 200};
    const Kernels *list[KERNELS_MAX + 1];
    kernels_list(list);
    for (size_t n = 0; n < sizeof rows / sizeof rows[0]; n++) {
        Batch batch = make_batch(network, rows[n]);
        network_predict_batch(network, batch.inputs, batch.scratch, batch.outputs, batch.rows);
        assert_as_row_by_row(network, &batch);
        for (int k = 0; list[k] != NULL; k++) {
            memset(batch.outputs, 0x55, (size_t)(batch.rows * batch.outs) * sizeof(float));
            for (int first = 0; first < batch.rows; first += TILE_ROWS) {
                int left = batch.rows - first;
                list[k]->predict(network, batch.inputs, batch.scratch, batch.outputs, batch.rows, first,
                                 left < TILE_ROWS ? left : TILE_ROWS);
            }
            assert_as_row_by_row(network, &batch);
        }
        free_batch(&batch);
    }
}

TEST(a_batch_has_the_bits_of_single_rows_whatever_the_instructions) {
    const Activation l = ACTIVATION_LINEAR, s = ACTIVATION_SIGMOID, t = ACTIVATION_TANH, r = ACTIVATION_RELU;
    check_batches(2, (const int[]){10, 10, 2}, (const Activation[]){s, s});
    check_batches(3, (const int[]){10, 8, 8, 6}, (const Activation[]){s, s, l});
    check_batches(3, (const int[]){3, 37, 1, 5}, (const Activation[]){t, l, t});
    check_batches(1, (const int[]){1, 1}, (const Activation[]){t});
    check_batches(3, (const int[]){10, 9, 7, 3}, (const Activation[]){r, r, l});
    check_batches(1, (const int[]){1, 1}, (const Activation[]){r});
}

TEST(a_copy_has_numbers_of_its_own) {
    OWN(Network) *network =
        make_network(2, (const int[]){3, 4, 2}, (const Activation[]){ACTIVATION_SIGMOID, ACTIVATION_TANH});
    network->output.offset[1] = 5, network->input.scale[2] = 3;
    strcpy(network->inputs, "x y z");
    OWN(Network) *copy = network_copy(network, &error);
    assert_ok(copy != NULL, error);
    const float input[3] = {0.5f, -0.25f, 1};
    float before[2], after[2];
    predict(network, input, before);
    network->weights[1][0] += 1, network->output.offset[1] = 0;
    predict(copy, input, after);
    assert_memory_equal(before, after, sizeof before);
    assert_string_equal(copy->inputs, "x y z");
}

static void refuse(int layers, const int *widths, const char *text) {
    Error error = {0};
    assert_refused(network_create(layers, widths, &error), text);
}

TEST(impossible_shapes_are_refused) {
    const int many[] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    refuse(0, (const int[]){3}, "0 layers");
    refuse(9, many, "9 layers");
    refuse(2, (const int[]){3, 0, 2}, "width 0 of layer 1");
    refuse(2, (const int[]){-3, 4, 2}, "width -3 of layer 0");
    refuse(1, (const int[]){3, 4097}, "width 4097 of layer 1");
}

RUN_TESTS(NULL, NULL)
