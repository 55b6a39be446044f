/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "networks.h"

#include "base/npz.h"

#include <math.h>

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

static void files_keep_every_bit(void **state) {
    (void)state;
    Error error = {0};
    Network *network = example();
    const char *path = temporary_path("net.npz");
    assert_ok(network_write(network, path, &error), error);
    Network *read = network_read(path, &error);
    assert_ok(read != NULL, error);
    assert_int_equal(read->layers, 2);
    assert_memory_equal(read->widths, network->widths, 3 * sizeof(int));
    assert_memory_equal(read->activations, network->activations, 2 * sizeof(Activation));
    size_t parameters = (size_t)network_parameter_count(network);
    assert_memory_equal(read->weights[0], network->weights[0], parameters * sizeof(float));
    assert_memory_equal(read->input.offset, network->input.offset, 3 * sizeof(float));
    assert_memory_equal(read->input.scale, network->input.scale, 3 * sizeof(float));
    assert_memory_equal(read->output.offset, network->output.offset, 2 * sizeof(float));
    assert_memory_equal(read->output.scale, network->output.scale, 2 * sizeof(float));
    assert_string_equal(read->inputs, network->inputs);
    assert_string_equal(read->outputs, network->outputs);
    assert_string_equal(read->target, "net");
    assert_string_equal(read->command, network->command);
    network_destroy(read);
    network_destroy(network);
}

static void refuse(const char *path, const char *text) {
    Error error = {0};
    assert_refused(network_read(path, &error), text, path);
}

static void numbers_out_of_range_are_refused(void **state) {
    (void)state;
    Error error = {0};
    Network *network = example();
    const char *path = temporary_path("bad.npz");
    struct {
        float *number, bad;
        const char *name;
    } cases[] = {{&network->weights[0][11], NAN, "weights_0: number 11 is nan"},
                 {&network->weights[1][0], INFINITY, "weights_1: number 0 is inf"},
                 {&network->biases[1][1], -INFINITY, "biases_1: number 1"},
                 {&network->input.offset[2], NAN, "input_offset: number 2"},
                 {&network->input.scale[1], 0, "input_scale: number 1 is 0"},
                 {&network->output.scale[0], -1, "output_scale: number 0 is -1"},
                 {&network->output.scale[0], INFINITY, "output_scale: number 0"},
                 {&network->output_mean[1], NAN, "output_mean: number 1"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        float kept = *cases[i].number;
        *cases[i].number = cases[i].bad;
        assert_ok(network_write(network, path, &error), error);
        *cases[i].number = kept;
        refuse(path, cases[i].name);
    }
    network_destroy(network);
}

/* A valid file of a network 2-1, array by array, for tests that change one. */
static const int32_t version = NETWORK_VERSION, widths[] = {2, 1};
static const float ones[8] = {1, 1, 1, 1, 1, 1, 1, 1};
static const NpzArray valid[] = {
    {"version", NPZ_INT32, 0, {0}, &version},     {"kind", NPZ_TEXT, 0, {0}, "network"},
    {"inputs", NPZ_TEXT, 0, {0}, "x y"},          {"outputs", NPZ_TEXT, 0, {0}, "z"},
    {"target", NPZ_TEXT, 0, {0}, "pair"},         {"command", NPZ_TEXT, 0, {0}, ""},
    {"widths", NPZ_INT32, 1, {2}, widths},        {"activations", NPZ_TEXT, 0, {0}, "linear"},
    {"weights_0", NPZ_FLOAT32, 2, {1, 2}, ones},  {"biases_0", NPZ_FLOAT32, 1, {1}, ones},
    {"input_offset", NPZ_FLOAT32, 1, {2}, ones},  {"input_scale", NPZ_FLOAT32, 1, {2}, ones},
    {"output_offset", NPZ_FLOAT32, 1, {1}, ones}, {"output_scale", NPZ_FLOAT32, 1, {1}, ones},
    {"output_mean", NPZ_FLOAT32, 1, {1}, ones}};
enum { VALID_COUNT = sizeof valid / sizeof valid[0] };

/* Writes the valid file with the array of the same name replaced, or left out where its data is NULL. */
static const char *write_with(NpzArray changed) {
    Error error = {0};
    NpzArray arrays[VALID_COUNT];
    size_t count = 0;
    for (size_t i = 0; i < VALID_COUNT; i++) {
        bool same = strcmp(valid[i].name, changed.name) == 0;
        if (!same || changed.data != NULL) arrays[count++] = same ? changed : valid[i];
    }
    const char *path = temporary_path("changed.npz");
    assert_ok(npz_write(path, arrays, count, &error), error);
    return path;
}

static void the_unchanged_file_is_read(void **state) {
    (void)state;
    Error error = {0};
    Network *network = network_read(write_with(valid[0]), &error);
    assert_ok(network != NULL, error);
    network_destroy(network);
}

static void every_array_is_needed(void **state) {
    (void)state;
    for (size_t i = 0; i < VALID_COUNT; i++)
        refuse(write_with((NpzArray){.name = valid[i].name}),
               strcmp(valid[i].name, "kind") == 0 ? "not a file of kind 'network'" : valid[i].name);
}

static void another_kind_or_version_is_refused(void **state) {
    (void)state;
    const int32_t future = 4, past = 2;
    refuse(write_with((NpzArray){"version", NPZ_INT32, 0, {0}, &future}), "version 4; expected version 3");
    refuse(write_with((NpzArray){"version", NPZ_INT32, 0, {0}, &past}), "version 2; expected version 3");
    refuse(write_with((NpzArray){"kind", NPZ_TEXT, 0, {0}, "dataset"}), "not a file of kind 'network'");
}

static void widths_out_of_range_are_refused(void **state) {
    (void)state;
    const int32_t negative[] = {2, -1}, zero[] = {0, 1}, huge[] = {2, INT32_MAX},
                  many[10] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    refuse(write_with((NpzArray){"widths", NPZ_INT32, 1, {2}, negative}), "widths[1] is -1");
    refuse(write_with((NpzArray){"widths", NPZ_INT32, 1, {2}, zero}), "widths[0] is 0");
    refuse(write_with((NpzArray){"widths", NPZ_INT32, 1, {2}, huge}), "widths[1] is 2147483647");
    refuse(write_with((NpzArray){"widths", NPZ_INT32, 1, {1}, many}), "widths has 1 numbers");
    refuse(write_with((NpzArray){"widths", NPZ_INT32, 1, {10}, many}), "widths has 10 numbers");
}

static void shapes_that_do_not_fit_are_refused(void **state) {
    (void)state;
    const int32_t wider[] = {3, 1}, deeper[] = {2, 1, 1};
    refuse(write_with((NpzArray){"widths", NPZ_INT32, 1, {2}, wider}), "weights_0");
    refuse(write_with((NpzArray){"widths", NPZ_INT32, 1, {3}, deeper}), "has no array 'weights_1'");
    refuse(write_with((NpzArray){"weights_0", NPZ_FLOAT32, 2, {2, 1}, ones}), "weights_0");
    refuse(write_with((NpzArray){"biases_0", NPZ_FLOAT32, 1, {2}, ones}), "biases_0");
    refuse(write_with((NpzArray){"input_scale", NPZ_FLOAT32, 1, {1}, ones}), "input_scale");
    refuse(write_with((NpzArray){"output_offset", NPZ_FLOAT32, 2, {1, 1}, ones}), "output_offset");
}

static void every_activation_has_its_word(void **state) {
    (void)state;
    Error error = {0};
    const Activation all[] = {ACTIVATION_LINEAR, ACTIVATION_SIGMOID, ACTIVATION_TANH, ACTIVATION_RELU};
    const char *const words[] = {"linear", "sigmoid", "tanh", "relu"};
    for (int i = 0; i < 4; i++) {
        Network *network = network_read(write_with((NpzArray){"activations", NPZ_TEXT, 0, {0}, words[i]}), &error);
        assert_ok(network != NULL, error);
        assert_int_equal(network->activations[0], all[i]);
        network_destroy(network);
    }
    Network *network = make_network(4, (const int[]){2, 2, 2, 2, 2}, all);
    const char *path = temporary_path("words.npz");
    assert_ok(network_write(network, path, &error), error);
    Network *read = network_read(path, &error);
    assert_ok(read != NULL, error);
    assert_memory_equal(read->activations, all, sizeof all);
    network_destroy(read);
    network_destroy(network);
}

static void unknown_activations_are_refused(void **state) {
    (void)state;
    refuse(write_with((NpzArray){"activations", NPZ_TEXT, 0, {0}, "softmax"}), "activation 0");
    refuse(write_with((NpzArray){"activations", NPZ_TEXT, 0, {0}, ""}), "0 activations for 1 layers");
    refuse(write_with((NpzArray){"activations", NPZ_TEXT, 0, {0}, "linear linear"}), "more activations");
}

static void damaged_files_are_refused(void **state) {
    (void)state;
    const char *path = write_with(valid[0]);
    assert_int_equal(truncate(path, 700), 0);
    refuse(path, "error:");
    refuse(temporary_path("missing.npz"), "error:");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_keep_every_bit),
        cmocka_unit_test(numbers_out_of_range_are_refused),
        cmocka_unit_test(the_unchanged_file_is_read),
        cmocka_unit_test(every_array_is_needed),
        cmocka_unit_test(another_kind_or_version_is_refused),
        cmocka_unit_test(widths_out_of_range_are_refused),
        cmocka_unit_test(shapes_that_do_not_fit_are_refused),
        cmocka_unit_test(every_activation_has_its_word),
        cmocka_unit_test(unknown_activations_are_refused),
        cmocka_unit_test(damaged_files_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
