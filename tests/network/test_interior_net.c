/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of interior-net, and the logarithm and power that its kernels take from bits. */
#include "testing.h"

#include "network/interior_net.h"
#include "npz/npz.h"

#include <math.h>

static void what_is_written_is_read_again(void **state) {
    (void)state;
    Error error = {0};
    InteriorNet net = {.command = "twinbox train"}, read;
    for (int i = 0; i < INTERIOR_NET_WEIGHTS; i++) net.weights[i] = (double)((float)(i - 20) / 7);
    const char *path = temporary_path("net.npz");
    assert_ok(interior_net_write(&net, path, &error), error);
    assert_ok(interior_net_read(&read, path, &error), error);
    assert_string_equal(read.command, "twinbox train");
    assert_memory_equal(read.weights, net.weights, sizeof net.weights);
}

static const char *write_file(int32_t version, const char *kind, int64_t hidden, float number) {
    Error error = {0};
    const char *path = temporary_path("hostile.npz");
    float numbers[64];
    for (int i = 0; i < 64; i++) numbers[i] = i == 5 ? number : 0;
    const NpzArray arrays[] = {
        {.name = "version", .type = NPZ_INT32, .data = &version},
        {.name = "kind", .type = NPZ_TEXT, .data = kind},
        {.name = "command", .type = NPZ_TEXT, .data = "none"},
        {"hidden_weights", NPZ_FLOAT32, 2, {hidden, INTERIOR_NET_INPUTS}, numbers},
        {"output_weights", NPZ_FLOAT32, 2, {INTERIOR_NET_OUTPUTS, INTERIOR_NET_HIDDEN}, numbers},
        {"hidden_biases", NPZ_FLOAT32, 2, {INTERIOR_NET_GLOBALS, INTERIOR_NET_HIDDEN}, numbers},
        {"output_biases", NPZ_FLOAT32, 2, {INTERIOR_NET_GLOBALS, INTERIOR_NET_OUTPUTS}, numbers}};
    assert_ok(npz_write(path, arrays, sizeof arrays / sizeof *arrays, &error), error);
    return path;
}

static void refuse(const char *path, const char *text) {
    Error error = {0};
    InteriorNet net;
    assert_refused(interior_net_read(&net, path, &error), text);
}

static void hostile_files_are_refused(void **state) {
    (void)state;
    InteriorNet net;
    Error error = {0};
    const int hidden = INTERIOR_NET_HIDDEN;
    assert_ok(interior_net_read(&net, write_file(1, "interior-net", hidden, 3), &error), error);
    refuse(write_file(2, "interior-net", hidden, 0), "version 2");
    refuse(write_file(1, "network", hidden, 0), "not a file of kind 'interior-net'");
    refuse(write_file(1, "interior-net", hidden + 1, 0), "hidden_weights");
    refuse(write_file(1, "interior-net", hidden, NAN), "number 5");
    refuse(write_file(1, "interior-net", hidden, INFINITY), "number 5");
    refuse("/dev/null", "/dev/null");
}

/* Exact at powers of two, straight lines between them, each the other's inverse. */
static void logarithm_and_power_are_straight_lines(void **state) {
    (void)state;
    for (int k = -300; k <= 300; k++) {
        assert_true(interior_net_log2(ldexp(1, k)) == k);
        assert_true(interior_net_power2(k) == ldexp(1, k));
        assert_true(interior_net_log2(ldexp(1.25, k)) == k + 0.25);
        assert_true(interior_net_power2(k + 0.75) == ldexp(1.75, k));
        assert_near(interior_net_power2(interior_net_log2(k * 0.37 + 200)), k * 0.37 + 200, 1e-8);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_written_is_read_again),
                                       cmocka_unit_test(hostile_files_are_refused),
                                       cmocka_unit_test(logarithm_and_power_are_straight_lines)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
