/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that hold no slot network, or one that cannot be: refused with place and reason. */
#include "slot_networks.h"

#include "base/file.h"
#include "base/npz.h"

/* A valid file of two slots between two bodies, array by array, for tests that change one. */
static const int32_t version = SLOT_NETWORK_VERSION, zero, one = 1, two = 2, a[2] = {0, 0}, b[2] = {1, 1};
static const uint32_t features[2] = {4, 6};
static const float numbers[2048] = {1};
static const NpzArray valid[] = {
    {"version", NPZ_INT32, 0, {0}, &version},
    {"kind", NPZ_TEXT, 0, {0}, "scene-net"},
    {"scene", NPZ_TEXT, 0, {0}, "stack"},
    {"command", NPZ_TEXT, 0, {0}, ""},
    {"body_count", NPZ_INT32, 0, {0}, &two},
    {"bomb", NPZ_INT32, 0, {0}, &one},
    {"sweeps", NPZ_INT32, 0, {0}, &zero},
    {"slot_a", NPZ_INT32, 1, {2}, a},
    {"slot_b", NPZ_INT32, 1, {2}, b},
    {"slot_feature", NPZ_UINT32, 1, {2}, features},
    {"bomb_state_rows", NPZ_FLOAT32, 2, {6, 16}, numbers},
    {"bomb_state_centre", NPZ_FLOAT32, 1, {16}, numbers},
    {"state_rows", NPZ_FLOAT32, 2, {6, 16}, numbers},
    {"state_centre", NPZ_FLOAT32, 1, {16}, numbers},
    {"present_rows", NPZ_FLOAT32, 2, {2, 16}, numbers},
    {"present_centre", NPZ_FLOAT32, 1, {16}, numbers},
    {"warm_rows", NPZ_FLOAT32, 2, {4, 16}, numbers},
    {"warm_centre", NPZ_FLOAT32, 1, {16}, numbers},
    {"first_rows", NPZ_FLOAT32, 2, {64, 32}, numbers},
    {"first_biases", NPZ_FLOAT32, 1, {32}, numbers},
    {"second_rows", NPZ_FLOAT32, 2, {32, 32}, numbers},
    {"second_biases", NPZ_FLOAT32, 1, {32}, numbers},
    {"last_rows", NPZ_FLOAT32, 2, {4, 32}, numbers},
    {"last_biases", NPZ_FLOAT32, 1, {4}, numbers},
    {"scale", NPZ_FLOAT32, 1, {2}, numbers},
    {"cap", NPZ_FLOAT32, 1, {2}, numbers},
    {"low", NPZ_FLOAT32, 1, {64}, numbers},
    {"high", NPZ_FLOAT32, 1, {64}, numbers},
    {"gate", NPZ_FLOAT32, 0, {0}, numbers},
    {"bomb_inv_mass", NPZ_FLOAT32, 0, {0}, numbers},
    {"factors", NPZ_FLOAT32, 1, {0}, NULL},
};
enum { VALID_COUNT = sizeof valid / sizeof valid[0] };

static const char *write_arrays(const NpzArray *arrays, size_t count) {
    Error error = {0};
    const char *path = temporary_path("changed.npz");
    assert_ok(npz_write(path, arrays, count, &error), error);
    return path;
}

/* The valid file with the array of the same name replaced. */
static const char *write_with(NpzArray changed) {
    NpzArray arrays[VALID_COUNT];
    int found = 0;
    for (size_t i = 0; i < VALID_COUNT; i++) {
        const bool same = strcmp(valid[i].name, changed.name) == 0;
        arrays[i] = same ? changed : valid[i];
        found += same;
    }
    assert_int_equal(found, 1);
    return write_arrays(arrays, VALID_COUNT);
}

static const char *write_int(const char *name, int32_t number) {
    return write_with((NpzArray){name, NPZ_INT32, 0, {0}, &number});
}

static void the_unchanged_file_is_read(void **state) {
    (void)state;
    Error error = {0};
    SlotNetwork *network = slot_network_read(write_with(valid[0]), &error);
    assert_ok(network != NULL, error);
    assert_int_equal(slot_network_find(network, 0, 1, 6), 1);
    slot_network_destroy(network);
}

static void every_array_is_needed(void **state) {
    (void)state;
    for (size_t left = 0; left < VALID_COUNT; left++) {
        NpzArray arrays[VALID_COUNT];
        size_t count = 0;
        for (size_t i = 0; i < VALID_COUNT; i++)
            if (i != left) arrays[count++] = valid[i];
        assert_slot_network_refused(write_arrays(arrays, count), strcmp(valid[left].name, "kind") == 0
                                                                     ? "not a file of kind 'scene-net'"
                                                                     : valid[left].name);
    }
}

static void another_kind_or_version_is_refused(void **state) {
    (void)state;
    assert_slot_network_refused(write_int("version", 0), "scene-net of version 0; expected version 2");
    assert_slot_network_refused(write_int("version", 1), "scene-net of version 1; expected version 2");
    assert_slot_network_refused(write_with((NpzArray){"kind", NPZ_TEXT, 0, {0}, "network"}),
                                "not a file of kind 'scene-net'");
    char endless[600];
    memset(endless, 'x', sizeof endless - 1);
    endless[sizeof endless - 1] = '\0';
    assert_slot_network_refused(write_with((NpzArray){"kind", NPZ_TEXT, 0, {0}, endless}), "kind");
    assert_slot_network_refused(write_with((NpzArray){"scene", NPZ_TEXT, 0, {0}, endless}), "scene");
    assert_slot_network_refused(write_with((NpzArray){"command", NPZ_TEXT, 0, {0}, endless}), "command");
    assert_slot_network_refused(write_with((NpzArray){"scene", NPZ_TEXT, 0, {0}, "\33[2J"}), "control characters");
}

/* Where the file with one number more along an axis of this array is found to be wrong: four matrices say how wide the
   network is, slot_a how many slots there are. */
static const char *place_of_fault(const char *name, int axis) {
    const char *const widths[] = {"state_rows", "present_rows", "warm_rows", "last_rows"};
    for (int i = 0; i < 4; i++)
        if (axis == 1 && strcmp(name, widths[i]) == 0) return "a width";
    return strcmp(name, "slot_a") == 0 ? "present_rows" : name;
}

static void shapes_that_do_not_fit_are_refused(void **state) {
    (void)state;
    static const float more[4096];
    for (size_t i = 0; i < VALID_COUNT; i++)
        for (int axis = 0; axis < valid[i].rank; axis++) {
            NpzArray changed = valid[i];
            changed.data = more;
            changed.shape[axis]++;
            assert_slot_network_refused(write_with(changed), place_of_fault(changed.name, axis));
        }
}

static void arrays_of_other_types_are_refused(void **state) {
    (void)state;
    static const double more[2048];
    for (size_t i = 0; i < VALID_COUNT; i++) {
        NpzArray changed = valid[i];
        changed.data = more;
        changed.type = NPZ_FLOAT64;
        assert_slot_network_refused(write_with(changed), changed.name);
    }
}

static void bodies_and_slots_out_of_bounds_are_refused(void **state) {
    (void)state;
    const int32_t itself[2] = {1, 1}, beyond[2] = {1, 2}, falls[2] = {0, -1};
    const uint32_t twice[2] = {4, 4};
    assert_slot_network_refused(write_int("bomb", 2), "2 bodies, of which 2 is the bomb");
    assert_slot_network_refused(write_int("bomb", -1), "of which -1 is the bomb");
    assert_slot_network_refused(write_int("body_count", 3),
                                "array 'state_rows' has shape (6, 16); expected (12, up to 1024)");
    assert_slot_network_refused(write_int("body_count", INT32_MIN), "state_rows");
    assert_slot_network_refused(write_int("body_count", INT32_MAX), "state_rows");
    assert_slot_network_refused(write_with((NpzArray){"slot_a", NPZ_INT32, 1, {2}, itself}), "slot 0");
    assert_slot_network_refused(write_with((NpzArray){"slot_a", NPZ_INT32, 1, {2}, falls}), "slot 1");
    assert_slot_network_refused(write_with((NpzArray){"slot_b", NPZ_INT32, 1, {2}, beyond}), "slot 1");
    assert_slot_network_refused(write_with((NpzArray){"slot_feature", NPZ_UINT32, 1, {2}, twice}), "slot 1");
}

/* The valid file, its arrays of these names in other shapes, all zeros. */
typedef struct Change {
    const char *name;
    int64_t shape[2];
} Change;

static const char *write_shapes(const Change *changes, size_t count) {
    NpzArray arrays[VALID_COUNT];
    void *blocks[VALID_COUNT] = {0};
    memcpy(arrays, valid, sizeof arrays);
    for (size_t i = 0; i < VALID_COUNT; i++)
        for (size_t c = 0; c < count; c++) {
            if (strcmp(arrays[i].name, changes[c].name) != 0) continue;
            memcpy(arrays[i].shape, changes[c].shape, sizeof changes[c].shape);
            const int64_t size = changes[c].shape[0] * (arrays[i].rank == 2 ? changes[c].shape[1] : 1);
            arrays[i].data = blocks[i] = calloc((size_t)size + 1, sizeof(float));
            assert_non_null(blocks[i]);
        }
    const char *path = write_arrays(arrays, VALID_COUNT);
    for (size_t i = 0; i < VALID_COUNT; i++) free(blocks[i]);
    return path;
}

/* Sizes that agree with each other and are refused all the same, before room is made for what they would need. */
static void absurd_sizes_are_refused(void **state) {
    (void)state;
    const int64_t many = SLOTS_MAX + 1, wide = SLOT_WIDTH_MAX + ROW_LANES;
    const Change no_slots[] = {{"slot_a", {0}},        {"slot_b", {0}},           {"slot_feature", {0}},
                               {"last_rows", {0, 32}}, {"present_rows", {0, 16}}, {"warm_rows", {0, 16}}};
    assert_slot_network_refused(write_shapes(no_slots, 6), "0 slots");
    assert_slot_network_refused(write_shapes(&(Change){"slot_a", {many}}, 1), "20001 slots");
    assert_slot_network_refused(write_shapes(&(Change){"slot_a", {SLOTS_MAX}}, 1),
                                "array 'present_rows' has shape (2, 16); expected (20000, up to 1024)");
    assert_slot_network_refused(write_shapes(&(Change){"state_rows", {6, wide}}, 1),
                                "array 'state_rows' has shape (6, 1040)");
    assert_slot_network_refused(write_shapes(&(Change){"last_rows", {4, wide}}, 1), "array 'last_rows'");
    assert_slot_network_refused(write_shapes(&(Change){"present_rows", {2, 1 << 20}}, 1), "array 'present_rows'");
    assert_slot_network_refused(write_shapes(&(Change){"warm_rows", {4, 0}}, 1), "a width");
    assert_slot_network_refused(write_shapes(&(Change){"warm_rows", {4, 24}}, 1), "a width");
    const Change endless[] = {{"slot_a", {0}}, {"present_rows", {0, INT64_C(1) << 31}}};
    assert_slot_network_refused(write_shapes(endless, 2), "present_rows");
}

static void numbers_of_sweeps_out_of_bounds_are_refused(void **state) {
    (void)state;
    assert_slot_network_refused(write_int("sweeps", -1), "sweeps is -1; expected 0 to 64");
    assert_slot_network_refused(write_int("sweeps", 65), "sweeps is 65; expected 0 to 64");
    assert_slot_network_refused(write_int("sweeps", INT32_MAX), "sweeps is 2147483647");
    assert_slot_network_refused(write_int("sweeps", 2), "array 'factors' has shape (0); expected (2)");
}

/* Cut off anywhere, or with a byte flipped inside the last matrix. */
static void damaged_files_are_refused(void **state) {
    (void)state;
    Error error = {0};
    size_t size;
    const char *path = write_with(valid[0]);
    char *bytes = file_read(path, 1 << 20, &size, &error);
    assert_ok(bytes != NULL, error);
    for (size_t length = 0; length < size; length += 1 + size / 50) {
        assert_ok(file_write_soon(path, bytes, length, &error), error);
        assert_slot_network_refused(path, "error:");
    }
    free(bytes);
    assert_slot_network_refused(temporary_path("missing.npz"), "error:");

    uint32_t seed = 1;
    SlotNetwork *network = make_slot_network(&five_shape, five_slots, &seed);
    path = temporary_path("flipped.npz");
    assert_ok(slot_network_write(network, path, &error), error);
    slot_network_destroy(network);
    bytes = file_read(path, 1 << 20, &size, &error);
    assert_ok(bytes != NULL, error);
    bytes[size / 2] ^= 1;
    assert_ok(file_write_soon(path, bytes, size, &error), error);
    free(bytes);
    assert_slot_network_refused(path, "damaged");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_unchanged_file_is_read),
        cmocka_unit_test(every_array_is_needed),
        cmocka_unit_test(another_kind_or_version_is_refused),
        cmocka_unit_test(shapes_that_do_not_fit_are_refused),
        cmocka_unit_test(arrays_of_other_types_are_refused),
        cmocka_unit_test(bodies_and_slots_out_of_bounds_are_refused),
        cmocka_unit_test(absurd_sizes_are_refused),
        cmocka_unit_test(numbers_of_sweeps_out_of_bounds_are_refused),
        cmocka_unit_test(damaged_files_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
