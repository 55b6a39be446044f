/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of gns. */
#include "owned.h"

#include "base/npz.h"
#include "nets/kinds.h"

TEST(what_is_written_is_read_again) {
    OWN(GnsNet) net, read;
    const char *path = temporary_path("net.npz");
    assert_ok(gns_net_create(&net, 32, 3, &error), error);
    for (int i = 0; i < net.layout.parameters; i++) net.parameters[i] = (float)(i - 100) / 7;
    net.scales = (GnsScales){0.5f, 2, 3, 4, 5};
    net.gravity[0] = 1, net.gravity[1] = -9.81f;
    strcpy(net.command, "twinbox train");
    assert_ok(gns_net_write(&net, path, &error), error);
    assert_ok(gns_net_read(&read, path, &error), error);
    assert_string_equal(read.command, "twinbox train");
    assert_int_equal(read.layout.width, 32);
    assert_int_equal(read.layout.rounds, 3);
    assert_memory_equal(&read.scales, &net.scales, sizeof net.scales);
    assert_memory_equal(&read.gravity, &net.gravity, sizeof net.gravity);
    assert_memory_equal(read.parameters, net.parameters, (size_t)net.layout.parameters * sizeof *net.parameters);
}

typedef struct File {
    const char *kind;
    int32_t version, width, rounds;
    int extra;
    float scale, number;
} File;

static const char *write_file(File of) {
    Error error = {0};
    const char *path = temporary_path("hostile.npz");
    const int32_t shape[2] = {of.width, of.rounds};
    const float scales[5] = {of.scale, 1, 1, 1, 1}, gravity[2] = {0, -10};
    const GnsLayout layout = gns_layout(16, 1);
    FREED float *parameters = calloc((size_t)layout.parameters + 1, sizeof *parameters);
    assert_non_null(parameters);
    parameters[7] = of.number;
    const NpzArray arrays[] = {{.name = "version", .type = NPZ_INT32, .data = &of.version},
                               {.name = "kind", .type = NPZ_TEXT, .data = of.kind},
                               {.name = "command", .type = NPZ_TEXT, .data = "none"},
                               {"shape", NPZ_INT32, 1, {2}, shape},
                               {"scales", NPZ_FLOAT32, 1, {5}, scales},
                               {"gravity", NPZ_FLOAT32, 1, {2}, gravity},
                               {"parameters", NPZ_FLOAT32, 1, {layout.parameters + of.extra}, parameters}};
    assert_ok(npz_write(path, arrays, sizeof arrays / sizeof *arrays, &error), error);
    return path;
}

static void refuse(const char *path, const char *text) {
    Error error = {0};
    OWN(GnsNet) net;
    assert_refused(gns_net_read(&net, path, &error), text);
}

TEST(hostile_files_are_refused) {
    GnsNet net;
    assert_ok(gns_net_read(&net, write_file((File){"gns", GNS_VERSION, 16, 1, 0, 1, 0}), &error), error);
    gns_net_free(&net);
    refuse(write_file((File){"gns", 1, 16, 1, 0, 1, 0}), "version 1");
    refuse(write_file((File){"network", GNS_VERSION, 16, 1, 0, 1, 0}), "not a file of kind 'gns'");
    refuse(write_file((File){"gns", GNS_VERSION, 20, 1, 0, 1, 0}), "the width is 20");
    refuse(write_file((File){"gns", GNS_VERSION, 1 << 20, 1, 0, 1, 0}), "the width is 1048576");
    refuse(write_file((File){"gns", GNS_VERSION, -16, 1, 0, 1, 0}), "the width is -16");
    refuse(write_file((File){"gns", GNS_VERSION, 16, 11, 0, 1, 0}), "11 rounds");
    refuse(write_file((File){"gns", GNS_VERSION, 16, 0, 0, 1, 0}), "0 rounds");
    refuse(write_file((File){"gns", GNS_VERSION, 16, 2, 0, 1, 0}), "parameters");
    refuse(write_file((File){"gns", GNS_VERSION, 16, 1, 1, 1, 0}), "parameters");
    refuse(write_file((File){"gns", GNS_VERSION, 16, 1, 0, 0, 0}), "greater than 0");
    refuse(write_file((File){"gns", GNS_VERSION, 16, 1, 0, 1, NAN}), "number 7");
    refuse(write_file((File){"gns", GNS_VERSION, 16, 1, 0, 1, INFINITY}), "number 7");
    refuse("/dev/null", "/dev/null");
}

RUN_TESTS(NULL, NULL)
