/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of sain. */
#include "made.h"
#include "sain_networks.h"

TEST(a_file_keeps_every_bit) {
    uint32_t seed = 8;
    OWN(SainNetworks) written, read;
    make_sain_networks(&written, &seed, 2);
    const char *path = temporary_path("sain.npz");
    assert_ok(sain_networks_write(&written, path, &error), error);
    assert_ok(sain_networks_read(&read, path, &error), error);
    assert_string_equal(read.command, "test");
    for (int f = 0; f < SAIN_FORMS; f++) {
        const SainNetwork *a = &written.forms[f], *b = &read.forms[f];
        const size_t relation = (size_t)network_parameter_count(a->relation) * sizeof(float),
                     object = (size_t)network_parameter_count(a->object) * sizeof(float);
        assert_memory_equal(a->relation->weights[0], b->relation->weights[0], relation);
        assert_memory_equal(a->object->weights[0], b->object->weights[0], object);
        assert_memory_equal(a->pair_low, b->pair_low, sizeof a->pair_low);
        assert_memory_equal(a->body_high, b->body_high, sizeof a->body_high);
        assert_memory_equal(a->limit, b->limit, sizeof a->limit);
    }
}

static void refuse(const char *path, const char *reason) {
    Error error = {0};
    SainNetworks networks;
    assert_refused(sain_networks_read(&networks, path, &error), reason);
    assert_non_null(strstr(error.message, path));
}

TEST(other_files_are_refused) {
    const int widths[] = {10, 10, 2};
    OWN(Network) *pair = network_sized(2, widths);
    const char *path = temporary_path("pair.npz");
    assert_ok(network_write(pair, path, &error), error);
    refuse(path, "kind");
}

TEST(numbers_out_of_range_are_refused) {
    uint32_t seed = 8;
    OWN(SainNetworks) networks;
    const char *path = temporary_path("bad.npz");
    make_sain_networks(&networks, &seed, 1);
    float *const bad[] = {networks.forms[0].relation->weights[0] + 5, networks.forms[2].object->input.scale + 1,
                          networks.forms[1].limit, networks.forms[1].pair_high};
    static const float values[] = {NAN, 0, -1, INFINITY};
    static const char *const names[] = {"on_pair_weights", "shuffled_body_scale", "off_limit", "off_pair_high"};
    for (int i = 0; i < 4; i++) {
        const float kept = *bad[i];
        *bad[i] = values[i];
        assert_ok(sain_networks_write(&networks, path, &error), error);
        refuse(path, names[i]);
        *bad[i] = kept;
    }
}

RUN_TESTS(NULL, NULL)
