/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is written is read; what holds no network of scene-net, or an impossible one, is refused with place and
   reason. */
#include "net_files.h"
#include "owned.h"
#include "scene_net_layers.h"

static SceneNet *example(void) {
    uint32_t seed = 1;
    SceneNet *network = make_scene_net(&five_shape, five_slots, &seed);
    network->gate = 0.1f;
    network->bomb_inv_mass = 0.02f;
    network->sweeps = 3;
    network->factors[0] = 0, network->factors[1] = 0.7f, network->factors[2] = 2;
    network->cap[2] = 0;
    strcpy(network->scene, "pyramid \xc3\xa4");
    strcpy(network->command, "twinbox train pyramid.yaml -o net.npz");
    return network;
}

/* The block holds all arrays, the packed ones too; its last is pair_slots. */
static void assert_same(const SceneNet *a, const SceneNet *b) {
    const size_t pairs = (size_t)(a->body_count * a->body_count) + 1;
    const char *block = a->block, *other = b->block;
    assert_true(a->body_count == b->body_count && a->bomb == b->bomb && a->slot_count == b->slot_count);
    assert_int_equal((char *)a->pair_slots - block, (char *)b->pair_slots - other);
    assert_memory_equal(block, other, (size_t)((char *)(a->pair_slots + pairs) - block));
    assert_int_equal(a->parameter_count, b->parameter_count);
    assert_memory_equal(&a->bomb_inv_mass, &b->bomb_inv_mass, sizeof a->bomb_inv_mass);
    assert_memory_equal(&a->gate, &b->gate, sizeof a->gate);
    assert_int_equal(a->sweeps, b->sweeps);
    assert_memory_equal(a->factors, b->factors, sizeof a->factors);
    assert_string_equal(a->scene, b->scene);
    assert_string_equal(a->command, b->command);
    assert_ptr_equal(a->kernels, b->kernels);
}

static SceneNet *written_and_read(const SceneNet *network) {
    Error error = {0};
    const char *path = temporary_path("net.npz");
    assert_ok(scene_net_write(network, path, &error), error);
    SceneNet *read = scene_net_read(path, &error);
    assert_ok(read != NULL, error);
    return read;
}

TEST(files_keep_every_bit) {
    const int sweeps[] = {3, 0, SCENE_NET_SWEEPS_MAX};
    OWN(SceneNet) *network = example();
    for (int i = 0; i < 3; i++) {
        network->sweeps = sweeps[i];
        for (int f = 3; f < SCENE_NET_SWEEPS_MAX; f++) network->factors[f] = f < sweeps[i] ? 0.01f * (float)f : 0;
        for (int f = sweeps[i]; f < 3; f++) network->factors[f] = 0;
        OWN(SceneNet) *read = written_and_read(network);
        assert_same(read, network);
    }
}

static bool is_read(const char *path, Error *error) {
    SceneNet *network = scene_net_read(path, error);
    scene_net_destroy(network);
    return network != NULL;
}

/* Two slots between two bodies. */
static NetArrays two_slots(void) {
    Error error = {0};
    uint32_t seed = 1;
    OWN(SceneNet) *network =
        make_scene_net(&(SceneNetShape){2, 1, 2, 16, 16, 16, 32}, (const Slot[]){{0, 1, 4}, {0, 1, 6}}, &seed);
    const char *path = temporary_path("two.npz");
    assert_ok(scene_net_write(network, path, &error), error);
    return read_arrays(path);
}

TEST(sizes_and_slots_out_of_bounds_are_refused) {
    static const int32_t itself[2] = {1, 1}, beyond[2] = {1, 2}, falls[2] = {0, -1};
    static const uint32_t twice[2] = {4, 4};
    static const struct {
        const char *name;
        int32_t number;
        const char *text;
    } scalars[] = {{"bomb", 2, "2 bodies, of which 2 is the bomb"},
                   {"bomb", -1, "of which -1 is the bomb"},
                   {"body_count", 3, "array 'state_rows' has shape (6, 16); expected (12, up to 1024)"},
                   {"body_count", INT32_MIN, "state_rows"},
                   {"body_count", INT32_MAX, "state_rows"},
                   {"sweeps", -1, "sweeps is -1; expected 0 to 64"},
                   {"sweeps", 65, "sweeps is 65; expected 0 to 64"},
                   {"sweeps", INT32_MAX, "sweeps is 2147483647"},
                   {"sweeps", 2, "array 'factors' has shape (0); expected (2)"}};
    static const struct {
        NpzArray changed;
        const char *text;
    } slots[] = {{{"slot_a", NPZ_INT32, 1, {2}, itself}, "slot 0"},
                 {{"slot_a", NPZ_INT32, 1, {2}, falls}, "slot 1"},
                 {{"slot_b", NPZ_INT32, 1, {2}, beyond}, "slot 1"},
                 {{"slot_feature", NPZ_UINT32, 1, {2}, twice}, "slot 1"},
                 {{"scene", NPZ_TEXT, 0, {0}, "\33[2J"}, "control character U+001B"}};
    NetArrays arrays = two_slots();
    for (size_t i = 0; i < sizeof scalars / sizeof *scalars; i++)
        refuse_file(is_read, write_int(&arrays, scalars[i].name, scalars[i].number), scalars[i].text);
    for (size_t i = 0; i < sizeof slots / sizeof *slots; i++)
        refuse_file(is_read, write_with(&arrays, slots[i].changed), slots[i].text);
    free_arrays(&arrays);
}

RUN_TESTS(NULL, NULL)
