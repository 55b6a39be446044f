/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The arrays of a network's file, for tests that change one, and what holds for the files of all kinds. */
#pragma once
#include "made.h"
#include "files.h"

enum { NET_ARRAYS_MAX = 64 };

typedef struct NetArrays {
    size_t count;
    NpzArray items[NET_ARRAYS_MAX]; /* with names and data of their own */
} NetArrays;

static inline bool take_array(NpzFile *file, NpzArray *array) {
    static const NpzType types[] = {NPZ_FLOAT32, NPZ_INT32, NPZ_UINT32, NPZ_UINT8, NPZ_INT64, NPZ_UINT64, NPZ_FLOAT64};
    Error error = {0};
    for (size_t t = 0; t < sizeof types / sizeof *types; t++)
        for (int rank = 0; rank <= 2; rank++) {
            if (!npz_shape(file, array->name, types[t], rank, array->shape, &error)) continue;
            array->type = types[t];
            array->rank = rank;
            array->data = npz_read(file, array->name, types[t], rank, array->shape, &error);
            return array->data != NULL;
        }
    char *text = calloc(1, 2048);
    array->type = NPZ_TEXT;
    array->data = text;
    return npz_read_text(file, array->name, text, 2048, &error);
}

static inline NetArrays read_arrays(const char *path) {
    NetArrays arrays = {0};
    NpzFile *file = npz_of(path);
    for (const char *name; (name = npz_name(file, arrays.count)) != NULL; arrays.count++) {
        assert_in_range(arrays.count, 0, NET_ARRAYS_MAX - 1);
        arrays.items[arrays.count] = (NpzArray){.name = strdup(name)};
        assert_true(take_array(file, &arrays.items[arrays.count]));
    }
    npz_close(file);
    return arrays;
}

static inline void free_arrays(NetArrays *arrays) {
    for (size_t i = 0; i < arrays->count; i++) {
        free((void *)arrays->items[i].name);
        free((void *)arrays->items[i].data);
    }
}

/* Writes the arrays with that of the same name replaced, or left out where its data is NULL. */
static inline const char *write_with(const NetArrays *arrays, NpzArray changed) {
    Error error = {0};
    NpzArray items[NET_ARRAYS_MAX];
    size_t count = 0, found = 0;
    for (size_t i = 0; i < arrays->count; i++) {
        const bool same = strcmp(arrays->items[i].name, changed.name) == 0;
        found += same;
        if (!same || changed.data != NULL) items[count++] = same ? changed : arrays->items[i];
    }
    assert_int_equal(found, 1);
    const char *path = temporary_path("changed.npz");
    assert_ok(npz_write(path, items, count, &error), error);
    return path;
}

static inline const char *write_int(const NetArrays *arrays, const char *name, int32_t number) {
    return write_with(arrays, (NpzArray){name, NPZ_INT32, 0, {0}, &number});
}

static inline const char *write_text(const NetArrays *arrays, const char *name, const char *text) {
    return write_with(arrays, (NpzArray){name, NPZ_TEXT, 0, {0}, text});
}

typedef bool NetReader(const char *path, Error *error);

static inline void refuse_file(NetReader *read, const char *path, const char *text) {
    Error error = {0};
    assert_refused(read(path, &error), text, path);
}

static inline size_t items_of(const NpzArray *array) {
    size_t count = 1;
    for (int r = 0; r < array->rank; r++) count *= (size_t)array->shape[r];
    return count;
}

/* Missing, of another type, of another shape, and with its last number NaN. */
static inline void assert_array_is_checked(NetReader *read, const NetArrays *arrays, const NpzArray *array) {
    char text[64];
    NpzArray changed = *array;
    void *zeros = calloc(2 * (items_of(array) + 4096), sizeof(double));
    assert_non_null(zeros);
    refuse_file(read, write_with(arrays, (NpzArray){.name = array->name}), array->name);
    changed.data = zeros;
    changed.type = NPZ_FLOAT64;
    refuse_file(read, write_with(arrays, changed), array->name);
    for (int axis = 0; axis < array->rank; axis++) {
        changed = *array;
        changed.data = zeros;
        changed.shape[axis]++;
        refuse_file(read, write_with(arrays, changed), "error:");
    }
    free(zeros);
    if (array->type != NPZ_FLOAT32 || items_of(array) == 0) return;
    float *last = (float *)array->data + items_of(array) - 1, kept = *last;
    *last = NAN;
    snprintf(text, sizeof text, "%s: number %zu is nan", array->name, items_of(array) - 1);
    refuse_file(read, write_with(arrays, *array), text);
    *last = kept;
}

/* What the file of a kind holds is needed and checked, array by array; other kinds, versions and damage are refused. */
static inline void assert_file_is_checked(NetReader *read, const char *path, const char *kind, int32_t version) {
    Error error = {0};
    char text[128], endless[2000];
    NetArrays arrays = read_arrays(path);
    size_t size;
    char *bytes = read_whole(path, &size);
    memset(endless, 'x', sizeof endless - 1);
    endless[sizeof endless - 1] = '\0';
    assert_ok(read(write_with(&arrays, arrays.items[0]), &error), error);
    for (size_t i = 0; i < arrays.count; i++) {
        const NpzArray *array = &arrays.items[i];
        if (array->type == NPZ_TEXT)
            refuse_file(read, write_text(&arrays, array->name, endless), array->name);
        else
            assert_array_is_checked(read, &arrays, array);
    }
    snprintf(text, sizeof text, "not a file of kind '%s'", kind);
    refuse_file(read, write_text(&arrays, "kind", "other"), text);
    refuse_file(read, write_with(&arrays, (NpzArray){.name = "kind"}), text);
    for (int32_t other = version - 1; other <= version + 1; other += 2) {
        snprintf(text, sizeof text, "%s of version %d; expected version %d", kind, other, version);
        refuse_file(read, write_int(&arrays, "version", other), text);
    }
    free_arrays(&arrays);
    path = temporary_path("cut.npz");
    for (size_t length = 0; length < size; length += 1 + size / 50)
        refuse_file(read, write_bytes(path, bytes, length), "error:");
    free(bytes);
    refuse_file(read, temporary_path("missing.npz"), "error:");
}
