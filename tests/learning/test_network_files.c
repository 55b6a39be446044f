/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of all kinds of networks, tried on those that ship: every bit is kept, every array is needed and checked, and
   what no network can have is refused with place and reason. */
#include "nets/net_files.h"
#include "owned.h"

#include "methods/hybrid_memory.h"
#include "methods/sain.h"
#include "nets/kinds.h"
#include "nets/nets.h"

/* Reads a file and writes what it has, unless `to` is NULL. */
typedef bool Copy(const char *from, const char *to, Error *error);

static bool copy_network(const char *from, const char *to, Error *error) {
    OWN(Network) *network = network_read(from, error);
    return network != NULL && (to == NULL || network_write(network, to, error));
}

static bool copy_scene_net(const char *from, const char *to, Error *error) {
    OWN(SceneNet) *network = scene_net_read(from, error);
    return network != NULL && (to == NULL || scene_net_write(network, to, error));
}

static bool copy_sain(const char *from, const char *to, Error *error) {
    OWN(SainNetwork) network;
    return sain_network_read(&network, from, error) && (to == NULL || sain_network_write(&network, to, error));
}

static bool copy_hybrid(const char *from, const char *to, Error *error) {
    OWN(HybridMemory) *memory = hybrid_memory_read(from, error);
    return memory != NULL && (to == NULL || hybrid_memory_write(memory, to, error));
}

static bool copy_gns(const char *from, const char *to, Error *error) {
    OWN(GnsNet) net;
    return gns_net_read(&net, from, error) && (to == NULL || gns_net_write(&net, to, error));
}

static bool copy_subspace(const char *from, const char *to, Error *error) {
    OWN(SubspaceNet) *net = subspace_net_read(from, error);
    return net != NULL && (to == NULL || subspace_net_write(net, to, error));
}

typedef enum Kind { NETWORK, SCENE_NET, SAIN, HYBRID, GNS, SUBSPACE, KINDS } Kind;

static const struct {
    const char *name, *file;
    int32_t version;
    Copy *copy;
} kinds[KINDS] = {[NETWORK] = {"network", "pair-net.npz", NETWORK_VERSION, copy_network},
                  [SCENE_NET] = {"scene-net", "scene-stack.npz", SCENE_NET_NETWORK_VERSION, copy_scene_net},
                  [SAIN] = {"sain", "sain.npz", SAIN_VERSION, copy_sain},
                  [HYBRID] = {"hybrid", "hybrid-pyramid.npz", HYBRID_VERSION, copy_hybrid},
                  [GNS] = {"gns", "gns.npz", GNS_VERSION, copy_gns},
                  [SUBSPACE] = {SUBSPACE_KIND, "subspace-single.npz", SUBSPACE_VERSION, copy_subspace}};

static const char *shipped(Kind kind) { return printed("%s/scenes/networks/%s", SOURCE_DIR, kinds[kind].file); }

static Kind now;
static bool is_read(const char *path, Error *error) { return kinds[now].copy(path, NULL, error); }

TEST(files_keep_every_bit) {
    for (Kind kind = 0; kind < KINDS; kind++) {
        char from[512];
        snprintf(from, sizeof from, "%s", shipped(kind));
        const char *to = temporary_path("copy.npz");
        assert_ok(kinds[kind].copy(from, to, &error), error);
        NetArrays given = read_arrays(from), kept = read_arrays(to);
        assert_int_equal(given.count, kept.count);
        for (size_t i = 0; i < given.count; i++) {
            const NpzArray *a = &given.items[i], *b = &kept.items[i];
            assert_string_equal(a->name, b->name);
            assert_true(a->type == b->type && a->rank == b->rank && items_of(a) == items_of(b));
            const size_t size = a->type == NPZ_UINT8 ? 1 : a->type >= NPZ_INT64 || a->type == NPZ_FLOAT64 ? 8 : 4;
            if (a->type == NPZ_TEXT)
                assert_string_equal(a->data, b->data);
            else
                assert_int_equal(memcmp(a->data, b->data, items_of(a) * (a->type == NPZ_UINT64 ? 8 : size)), 0);
        }
        free_arrays(&given);
        free_arrays(&kept);
    }
}

TEST(every_array_is_needed_and_checked) {
    for (now = 0; now < KINDS; now++) {
        char path[512];
        snprintf(path, sizeof path, "%s", shipped(now));
        assert_file_is_checked(is_read, path, kinds[now].name, kinds[now].version);
    }
}

/* Of one array: number `index` is `number`; or its text is `word`; or its shape is `shape`, where that
   is not 0, all zeros. */
typedef struct Change {
    Kind kind;
    const char *array;
    int index;
    double number;
    const char *word;
    int64_t shape[2];
    const char *text;
} Change;

static void refuse(const Change *change) {
    NetArrays arrays = read_arrays(shipped(change->kind));
    const char *path = NULL;
    for (size_t i = 0; i < arrays.count; i++) {
        NpzArray array = arrays.items[i];
        if (strcmp(array.name, change->array) != 0) continue;
        void *zeros = NULL;
        if (change->word != NULL) {
            array.data = change->word;
        } else if (change->shape[0] > 0 || change->shape[1] > 0) {
            for (int axis = 0; axis < 2; axis++)
                if (change->shape[axis] > 0) array.shape[axis] = change->shape[axis];
            array.data = zeros = calloc(items_of(&array) + 1, 8);
        } else if (array.type == NPZ_FLOAT32) {
            ((float *)array.data)[change->index] = (float)change->number;
        } else {
            ((int32_t *)array.data)[change->index] = (int32_t)change->number;
        }
        path = write_with(&arrays, array);
        free(zeros);
    }
    assert_non_null(path);
    now = change->kind;
    refuse_file(is_read, path, change->text);
    free_arrays(&arrays);
}

TEST(what_no_network_has_is_refused) {
    static const Change changes[] = {
        {NETWORK, "weights_1", 0, INFINITY, .text = "weights_1: number 0 is inf; it must be finite"},
        {NETWORK, "input_scale", 1, 0, .text = "input_scale: number 1 is 0; it must be finite and greater than 0"},
        {NETWORK, "widths", 1, -1, .text = "widths[1] is -1"},
        {NETWORK, "widths", .shape = {10}, .text = "widths has 10 numbers"},
        {NETWORK, "activations", .word = "softmax", .text = "activation 0"},
        {NETWORK, "activations", .word = "linear linear linear", .text = "more activations"},
        {SCENE_NET, "scale", 0, -1e-30, .text = "scale: number 0 is -1e-30; it must be finite and not negative"},
        {SCENE_NET, "factors", 1, -0.1, .text = "factors: number 1 is -0.1; it must be from 0 to 2"},
        {SCENE_NET, "bomb", 0, -1, .text = "of which -1 is the bomb"},
        {SCENE_NET, "body_count", 0, 3, .text = "array 'state_rows' has shape (66, 16); expected (12, up to 1024)"},
        {SCENE_NET, "sweeps", 0, 65, .text = "sweeps is 65; expected 0 to 64"},
        {SCENE_NET, "sweeps", 0, 2, .text = "array 'factors' has shape (14); expected (2)"},
        {SCENE_NET, "slot_a", 1, -1, .text = "slot 1"},
        {SCENE_NET, "slot_a", .shape = {SLOTS_MAX + 1}, .text = "20001 slots"},
        {SCENE_NET, "warm_rows", .shape = {0, 24}, .text = "a width"},
        {SCENE_NET, "scene", .word = "\33[2J", .text = "control character U+001B"},
        {SAIN, "on_body_scale", 1, 0, .text = "on_body_scale"},
        {SAIN, "on_limit", 0, -1, .text = "on_limit"},
        {HYBRID, "tolerance", 0, 0, .text = "tolerance"},
        {HYBRID, "reach", 1, -1, .text = "reach: number 1 is -1"},
        {HYBRID, "launches", 0, -1, .text = "launches is -1; expected at least 0"},
        {HYBRID, "entry_set", 1, 1e6, .text = "entry_set: number 1 is 1000000; expected 0 to "},
        {HYBRID, "set_contacts", 0, 19999, .text = "impulses; the entries have "},
        {HYBRID, "near", 6, -2, .text = "near: number 6 is -2, which is no entry of the same contacts"},
        {HYBRID, "bomb", 0, 1000, .text = "bomb is 1000; expected 0 to "},
        {HYBRID, "body_count", 0, 4, .text = "body_count is 4"},
        {GNS, "shape", 0, 20, .text = "the width is 20"},
        {GNS, "shape", 1, 11, .text = "11 rounds"},
        {GNS, "shape", 1, 2, .text = "parameters"},
        {GNS, "scales", 0, 0, .text = "greater than 0"},
        {SUBSPACE, "low", 3, 5000, .text = "low: number 3 is 5000, above its high"},
        {SUBSPACE, "first_rows_0", 1, INFINITY, .text = "first_rows_0: number 1 is inf; it must be finite"}};
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) refuse(&changes[i]);
}

/* Sizes that agree with each other and are refused all the same. */
TEST(sizes_that_do_not_fit_are_refused) {
    OWN(SubspaceNet) *net = subspace_net_read(shipped(SUBSPACE), &error);
    assert_ok(net != NULL, error);
    const char *path = temporary_path("bad.npz");
    const SubspaceShape shape = net->shape;
    now = SUBSPACE;
    net->shape.hidden = 24;
    assert_ok(subspace_net_write(net, path, &error), error);
    refuse_file(is_read, path, "24 hidden units");
    net->shape = shape;
    net->shape.bodies = 100000;
    assert_refused(subspace_shape_check(&net->shape, "file", &error), "file: error: 100000 bodies");
    net->shape = shape;
    OWN(HybridMemory) *memory = hybrid_memory_create(3, 2, 2, &error);
    error = (Error){0};
    assert_refused(hybrid_memory_write(memory, path, &error), "is empty");
}

RUN_TESTS(NULL, NULL)
