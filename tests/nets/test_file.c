/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "net_files.h"
#include "owned.h"
#include "networks.h"

static Network *example(void) {
    Network *network =
        make_network(2, (const int[]){3, 4, 2}, (const Activation[]){ACTIVATION_TANH, ACTIVATION_SIGMOID});
    for (int i = 0; i < 3; i++) network->input.offset[i] = 0.1f * (float)i, network->input.scale[i] = (float)i + 0.3f;
    network->output.offset[1] = -7.7f, network->output.scale[1] = 1e-3f;
    strcpy(network->inputs, "x y angle \xc3\xa4");
    strcpy(network->outputs, "vx vy");
    strcpy(network->target, "net");
    strcpy(network->command, "twinbox train data.npz -o net.npz");
    return network;
}

static const char *write_network(const Network *network) {
    Error error = {0};
    const char *path = temporary_path("net.npz");
    assert_ok(network_write(network, path, &error), error);
    return path;
}

static bool is_read(const char *path, Error *error) {
    Network *network = network_read(path, error);
    network_destroy(network);
    return network != NULL;
}

TEST(files_keep_every_bit) {
    OWN(Network) *network = example(), *read = network_read(write_network(network), &error);
    assert_ok(read != NULL, error);
    assert_int_equal(read->layers, 2);
    assert_memory_equal(read->widths, network->widths, 3 * sizeof(int));
    assert_memory_equal(read->activations, network->activations, 2 * sizeof(Activation));
    /* One block: weights, biases, normalisations and the mean. */
    assert_memory_equal(read->weights[0], network->weights[0],
                        (size_t)(network->output_mean + 2 - network->weights[0]) * sizeof(float));
    assert_string_equal(read->inputs, network->inputs);
    assert_string_equal(read->outputs, network->outputs);
    assert_string_equal(read->target, "net");
    assert_string_equal(read->command, network->command);
}

TEST(every_array_is_needed_and_checked) {
    OWN(Network) *network = example();
    assert_file_is_checked(is_read, write_network(network), "network", NETWORK_VERSION);
}

TEST(numbers_out_of_range_are_refused) {
    OWN(Network) *network = example();
    struct {
        float *number, bad;
        const char *name;
    } cases[] = {{&network->weights[1][0], INFINITY, "weights_1: number 0 is inf; it must be finite"},
                 {&network->biases[1][1], -INFINITY, "biases_1: number 1 is -inf"},
                 {&network->input.scale[1], 0, "input_scale: number 1 is 0; it must be finite and greater than 0"},
                 {&network->output.scale[0], -1, "output_scale: number 0 is -1"},
                 {&network->output.scale[0], INFINITY, "output_scale: number 0 is inf"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        float kept = *cases[i].number;
        *cases[i].number = cases[i].bad;
        refuse_file(is_read, write_network(network), cases[i].name);
        *cases[i].number = kept;
    }
}

TEST(sizes_and_words_that_do_not_fit_are_refused) {
    static const int32_t negative[] = {2, -1}, zero[] = {0, 1}, huge[] = {2, INT32_MAX},
                         many[10] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1}, wider[] = {3, 1}, deeper[] = {2, 1, 1};
    static const struct {
        NpzArray changed;
        const char *text;
    } cases[] = {{{"widths", NPZ_INT32, 1, {2}, negative}, "widths[1] is -1"},
                 {{"widths", NPZ_INT32, 1, {2}, zero}, "widths[0] is 0"},
                 {{"widths", NPZ_INT32, 1, {2}, huge}, "widths[1] is 2147483647"},
                 {{"widths", NPZ_INT32, 1, {1}, many}, "widths has 1 numbers"},
                 {{"widths", NPZ_INT32, 1, {10}, many}, "widths has 10 numbers"},
                 {{"widths", NPZ_INT32, 1, {2}, wider}, "weights_0"},
                 {{"widths", NPZ_INT32, 1, {3}, deeper}, "has no array 'weights_1'"},
                 {{"activations", NPZ_TEXT, 0, {0}, "softmax"}, "activation 0"},
                 {{"activations", NPZ_TEXT, 0, {0}, ""}, "0 activations for 1 layers"},
                 {{"activations", NPZ_TEXT, 0, {0}, "linear linear"}, "more activations"}};
    OWN(Network) *network = make_network(1, (const int[]){2, 1}, (const Activation[]){ACTIVATION_LINEAR});
    NetArrays arrays = read_arrays(write_network(network));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        refuse_file(is_read, write_with(&arrays, cases[i].changed), cases[i].text);
    free_arrays(&arrays);
}

TEST(every_activation_has_its_word) {
    const Activation all[] = {ACTIVATION_LINEAR, ACTIVATION_SIGMOID, ACTIVATION_TANH, ACTIVATION_RELU};
    OWN(Network) *network = make_network(4, (const int[]){2, 2, 2, 2, 2}, all);
    NetArrays arrays = read_arrays(write_network(network));
    OWN(Network) *read = network_read(write_text(&arrays, "activations", "linear sigmoid tanh relu"), &error);
    assert_ok(read != NULL, error);
    assert_memory_equal(read->activations, all, sizeof all);
    for (size_t i = 0; i < arrays.count; i++)
        if (strcmp(arrays.items[i].name, "activations") == 0)
            assert_string_equal(arrays.items[i].data, "linear sigmoid tanh relu");
    free_arrays(&arrays);
}

RUN_TESTS(NULL, NULL)
