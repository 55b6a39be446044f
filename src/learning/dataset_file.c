/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Dataset files: .npz with version, kind ("dataset"), scenes (text, one name per line), view, target, labels (words),
   launch_scene, launch_x, launch_rotation, launch_spin, launch_test [launches], inputs [rows, 10, 12, 20 or 32],
   changes [rows, 6 or 4], launch, frame [rows], bodies [rows, 2]; and, if recorded, context [rows, 17]. */
#include "base/base.h"
#include "base/npz.h"
#include "learning/dataset.h"
#include "methods/pair.h"
#include "scenes/scenes.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define KIND "dataset"

const char *const dataset_label_names[DATASET_LABELS + 1] = {"engine", "reference"};

void dataset_free_rows(Dataset *dataset) {
    free(dataset->inputs);
    free(dataset->changes);
    free(dataset->context);
    free(dataset->launch);
    free(dataset->frame);
    free(dataset->bodies);
}

void dataset_destroy(Dataset *dataset) {
    if (dataset == NULL) return;
    dataset_free_rows(dataset);
    free(dataset->launch_scene);
    free(dataset->launch_x);
    free(dataset->launch_rotation);
    free(dataset->launch_spin);
    free(dataset->launch_test);
    free(dataset);
}

static void join_scenes(const Dataset *dataset, char text[DATASET_SCENES_SIZE]) {
    text[0] = '\0';
    for (int s = 0; s < dataset->scene_count; s++) {
        if (s > 0) strcat(text, "\n");
        strcat(text, dataset->scenes[s]);
    }
}

enum { ARRAYS = DATASET_ARRAYS - DATASET_WORDS };

/* One list for writing and reading; the last may be missing. */
static void list_arrays(const Dataset *dataset, NpzArray list[ARRAYS]) {
    const int64_t rows = dataset->rows, launches = dataset->launches;
    const NpzArray all[ARRAYS] = {
        {"launch_scene", NPZ_INT32, 1, {launches}, dataset->launch_scene},
        {"launch_x", NPZ_FLOAT32, 1, {launches}, dataset->launch_x},
        {"launch_rotation", NPZ_FLOAT32, 1, {launches}, dataset->launch_rotation},
        {"launch_spin", NPZ_FLOAT32, 1, {launches}, dataset->launch_spin},
        {"launch_test", NPZ_UINT8, 1, {launches}, dataset->launch_test},
        {"inputs", NPZ_FLOAT32, 2, {rows, dataset_inputs(dataset)}, dataset->inputs},
        {"changes", NPZ_FLOAT32, 2, {rows, pair_change_count(dataset->target)}, dataset->changes},
        {"launch", NPZ_INT32, 1, {rows}, dataset->launch},
        {"frame", NPZ_INT32, 1, {rows}, dataset->frame},
        {"bodies", NPZ_INT32, 2, {rows, 2}, dataset->bodies},
        {"context", NPZ_FLOAT32, 2, {rows, PAIR_CONTEXT}, dataset->context},
    };
    memcpy(list, all, sizeof all);
}

int dataset_arrays(const Dataset *dataset, bool context, DatasetArrays *arrays) {
    static const int32_t version = DATASET_VERSION;
    join_scenes(dataset, arrays->scenes);
    const NpzArray words[DATASET_WORDS] = {
        {"version", NPZ_INT32, 0, {0}, &version},
        {"kind", NPZ_TEXT, 0, {0}, KIND},
        {"view", NPZ_TEXT, 0, {0}, pair_views[dataset->view].name},
        {"target", NPZ_TEXT, 0, {0}, pair_target_names[dataset->target]},
        {"labels", NPZ_TEXT, 0, {0}, dataset_label_names[dataset->labels]},
        {"scenes", NPZ_TEXT, 0, {0}, arrays->scenes},
    };
    memcpy(arrays->list, words, sizeof words);
    list_arrays(dataset, arrays->list + DATASET_WORDS);
    return DATASET_ARRAYS - !context;
}

bool dataset_write(const Dataset *dataset, const char *path, Error *error) {
    DatasetArrays arrays;
    const int count = dataset_arrays(dataset, dataset->context != NULL, &arrays);
    return npz_write(path, arrays.list, (size_t)count, error);
}

static bool read_scenes(NpzFile *file, const char *path, Dataset *dataset, Error *error) {
    char text[DATASET_SCENES_SIZE], *line = text;
    if (!npz_read_text(file, "scenes", text, sizeof text, error)) return false;
    while (line != NULL) {
        size_t length = strcspn(line, "\n");
        if (dataset->scene_count == DATASET_MAX_SCENES)
            return error_input(error, path, "scenes: more than %d names", DATASET_MAX_SCENES);
        if (length == 0 || length >= DATASET_NAME_SIZE)
            return error_input(error, path, "scenes: a name of %zu bytes; expected 1 to %d", length,
                               DATASET_NAME_SIZE - 1);
        char *name = dataset->scenes[dataset->scene_count++];
        memcpy(name, line, length);
        name[length] = '\0';
        line = line[length] == '\n' ? line + length + 1 : NULL;
    }
    return true;
}

/* The index of a stored word in a list. */
static bool read_word(NpzFile *file, const char *path, const char *name, const char *const *words, int count,
                      int *place, Error *error) {
    char text[32];
    if (!npz_read_text(file, name, text, sizeof text, error)) return false;
    for (*place = 0; *place < count; ++*place)
        if (strcmp(words[*place], text) == 0) return true;
    return error_input(error, path, "%s: a word that is not known", name);
}

static bool read_words(NpzFile *file, const char *path, Dataset *dataset, Error *error) {
    const char *views[PAIR_VIEWS];
    int view, target, labels;
    for (int v = 0; v < PAIR_VIEWS; v++) views[v] = pair_views[v].name;
    if (!read_word(file, path, "view", views, PAIR_VIEWS, &view, error) ||
        !read_word(file, path, "target", pair_target_names, PAIR_TARGETS, &target, error) ||
        !read_word(file, path, "labels", dataset_label_names, DATASET_LABELS, &labels, error))
        return false;
    dataset->view = (PairView)view;
    dataset->target = (PairTarget)target;
    dataset->labels = (DatasetLabels)labels;
    return true;
}

static void *take(NpzFile *file, const NpzArray *array, Error *error) {
    return npz_read(file, array->name, array->type, array->rank, array->shape, error);
}

static bool read_arrays(NpzFile *file, const char *path, Dataset *dataset, Error *error) {
    int64_t launches, shape[2];
    if (!npz_shape(file, "launch_x", NPZ_FLOAT32, 1, &launches, error)) return false;
    if (!npz_shape(file, "inputs", NPZ_FLOAT32, 2, shape, error)) return false;
    const int64_t rows = shape[0];
    if (launches < 1 || launches > INT_MAX || rows < 1)
        return error_input(error, path, "%lld launches and %lld rows; expected at least one of each",
                           (long long)launches, (long long)rows);
    dataset->launches = (int)launches;
    dataset->rows = rows;
    NpzArray list[ARRAYS], *next = list;
    const bool has_context = npz_has(file, "context");
    list_arrays(dataset, list);
    return npz_expect(file, list, has_context ? ARRAYS : ARRAYS - 1, error) &&
           (dataset->launch_scene = take(file, next++, error)) != NULL &&
           (dataset->launch_x = take(file, next++, error)) != NULL &&
           (dataset->launch_rotation = take(file, next++, error)) != NULL &&
           (dataset->launch_spin = take(file, next++, error)) != NULL &&
           (dataset->launch_test = take(file, next++, error)) != NULL &&
           (dataset->inputs = take(file, next++, error)) != NULL &&
           (dataset->changes = take(file, next++, error)) != NULL &&
           (dataset->launch = take(file, next++, error)) != NULL &&
           (dataset->frame = take(file, next++, error)) != NULL &&
           (dataset->bodies = take(file, next++, error)) != NULL &&
           (!has_context || (dataset->context = take(file, next, error)) != NULL);
}

static bool check_finite(const float *numbers, int64_t count, const char *name, const char *path, Error *error) {
    for (int64_t i = 0; i < count; i++)
        if (!isfinite(numbers[i]))
            return error_input(error, path, "%s: number %lld is %g; all must be finite", name, (long long)i,
                               (double)numbers[i]);
    return true;
}

/* Every number in [0, limit). */
static bool check_indices(const int32_t *numbers, int64_t count, int32_t limit, const char *name, const char *path,
                          Error *error) {
    for (int64_t i = 0; i < count; i++)
        if (numbers[i] < 0 || numbers[i] >= limit)
            return error_input(error, path, "%s: number %lld is %d; expected 0 to %d", name, (long long)i, numbers[i],
                               limit - 1);
    return true;
}

static bool check_context(const Dataset *dataset, const char *path, Error *error) {
    if (dataset->context == NULL) return true;
    if (!check_finite(dataset->context, dataset->rows * PAIR_CONTEXT, "context", path, error)) return false;
    for (int64_t r = 0; r < dataset->rows; r++) {
        const char *fault = pair_context_fault(dataset->context + r * PAIR_CONTEXT);
        if (fault != NULL) return error_input(error, path, "context: row %lld has %s", (long long)r, fault);
    }
    return true;
}

static bool check_split(const Dataset *dataset, const char *path, Error *error) {
    for (int i = 0; i < dataset->launches; i++)
        if (dataset->launch_test[i] > 1)
            return error_input(error, path, "launch_test: number %d is %d; expected 0 and 1", i,
                               dataset->launch_test[i]);
    int64_t test_rows = 0;
    for (int64_t r = 0; r < dataset->rows; r++) test_rows += dataset_is_test(dataset, r);
    if (test_rows > 0 && test_rows < dataset->rows) return true;
    return error_input(error, path, "%lld rows to train on and %lld to test on; expected at least one of each",
                       (long long)(dataset->rows - test_rows), (long long)test_rows);
}

static bool check_contents(const Dataset *dataset, const char *path, Error *error) {
    const int64_t rows = dataset->rows, launches = dataset->launches;
    return check_indices(dataset->launch_scene, launches, dataset->scene_count, "launch_scene", path, error) &&
           check_finite(dataset->launch_x, launches, "launch_x", path, error) &&
           check_finite(dataset->launch_rotation, launches, "launch_rotation", path, error) &&
           check_finite(dataset->launch_spin, launches, "launch_spin", path, error) &&
           check_finite(dataset->inputs, rows * dataset_inputs(dataset), "inputs", path, error) &&
           check_finite(dataset->changes, rows * pair_change_count(dataset->target), "changes", path, error) &&
           check_indices(dataset->launch, rows, dataset->launches, "launch", path, error) &&
           check_indices(dataset->frame, rows, INT32_MAX, "frame", path, error) &&
           check_indices(dataset->bodies, rows * 2, INT32_MAX, "bodies", path, error) &&
           check_context(dataset, path, error) && check_split(dataset, path, error);
}

Dataset *dataset_read(const char *path, Error *error) {
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return NULL;
    Dataset *dataset = calloc(1, sizeof *dataset);
    if (dataset == NULL) error_memory(error, path);
    if (dataset != NULL && !(npz_check_kind(file, KIND, DATASET_VERSION, error) &&
                             read_scenes(file, path, dataset, error) && read_words(file, path, dataset, error) &&
                             read_arrays(file, path, dataset, error) && check_contents(dataset, path, error))) {
        dataset_destroy(dataset);
        dataset = NULL;
    }
    npz_close(file);
    return dataset;
}
