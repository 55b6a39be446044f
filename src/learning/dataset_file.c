/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of datasets: kind "dataset"; scenes are names in lines, and context is there if it was recorded. */
#include "base/base.h"
#include "base/npz.h"
#include "learning/dataset.h"
#include "methods/pair.h"
#include "nets/nets.h"
#include "scenes/scenes.h"

#include <float.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

const char *const dataset_label_names[DATASET_LABELS + 1] = {"engine", "reference"};

bool dataset_make_launches(Dataset *dataset, int launches) {
    const size_t count = (size_t)launches;
    dataset->launches = launches;
    dataset->launch_block = calloc(count, sizeof(int32_t) + 3 * sizeof(float) + 1);
    if (dataset->launch_block == NULL) return false;
    dataset->launch_scene = dataset->launch_block;
    dataset->launch_x = (float *)(dataset->launch_scene + count);
    dataset->launch_rotation = dataset->launch_x + count;
    dataset->launch_spin = dataset->launch_rotation + count;
    dataset->launch_test = (uint8_t *)(dataset->launch_spin + count);
    return true;
}

bool dataset_make_rows(Dataset *dataset, int64_t rows, bool context) {
    const size_t count = (size_t)rows, inputs = (size_t)dataset_inputs(dataset),
                 changes = (size_t)pair_change_count(dataset->target), contexts = context ? PAIR_CONTEXT : 0;
    dataset->rows = rows;
    dataset->row_block = malloc((count + 1) * ((inputs + changes + contexts) * sizeof(float) + 4 * sizeof(int32_t)));
    if (dataset->row_block == NULL) return false;
    dataset->inputs = dataset->row_block;
    dataset->changes = dataset->inputs + count * inputs;
    float *after = dataset->changes + count * changes;
    dataset->context = context ? after : NULL;
    dataset->launch = (int32_t *)(after + count * contexts);
    dataset->frame = dataset->launch + count;
    dataset->bodies = dataset->frame + count;
    return true;
}

void dataset_destroy(Dataset *dataset) {
    if (dataset == NULL) return;
    free(dataset->row_block);
    free(dataset->launch_block);
    free(dataset);
}

typedef struct DatasetFile {
    Dataset *dataset;
    bool context;
    char *scenes; /* of a writer */
} DatasetFile;

static const FloatBounds finite = {-FLT_MAX, FLT_MAX, "all must be finite"};

static int list_fields(void *of, NetField *fields) {
    const DatasetFile *file = of;
    const Dataset *dataset = file->dataset;
    const int64_t rows = dataset->rows, launches = dataset->launches, inputs = dataset_inputs(dataset),
                  changes = pair_change_count(dataset->target);
    const NetField all[] = {
        {"view", NPZ_TEXT, 0, {0}, .data = (char *)pair_views[dataset->view].name, .known = true},
        {"target", NPZ_TEXT, 0, {0}, .data = (char *)pair_target_names[dataset->target], .known = true},
        {"labels", NPZ_TEXT, 0, {0}, .data = (char *)dataset_label_names[dataset->labels], .known = true},
        {"scenes", NPZ_TEXT, 0, {0}, .data = file->scenes, .known = true},
        {"launch_scene", NPZ_INT32, 1, {launches}, .data = dataset->launch_scene},
        {"launch_x", NPZ_FLOAT32, 1, {launches}, .data = dataset->launch_x, .range = &finite},
        {"launch_rotation", NPZ_FLOAT32, 1, {launches}, .data = dataset->launch_rotation, .range = &finite},
        {"launch_spin", NPZ_FLOAT32, 1, {launches}, .data = dataset->launch_spin, .range = &finite},
        {"launch_test", NPZ_UINT8, 1, {launches}, .data = dataset->launch_test},
        {"inputs", NPZ_FLOAT32, 2, {rows, inputs}, .data = dataset->inputs, .range = &finite},
        {"changes", NPZ_FLOAT32, 2, {rows, changes}, .data = dataset->changes, .range = &finite},
        {"launch", NPZ_INT32, 1, {rows}, .data = dataset->launch},
        {"frame", NPZ_INT32, 1, {rows}, .data = dataset->frame},
        {"bodies", NPZ_INT32, 2, {rows, 2}, .data = dataset->bodies},
        {"context", NPZ_FLOAT32, 2, {rows, PAIR_CONTEXT}, .data = dataset->context, .range = &finite}};
    memcpy(fields, all, sizeof all);
    return (int)(sizeof all / sizeof *all) - !file->context;
}

static bool read_scenes(NpzFile *file, Dataset *dataset, Error *error) {
    const char *path = npz_path(file);
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
static bool read_word(NpzFile *file, const char *name, const char *const *words, int count, int *place, Error *error) {
    char text[32];
    if (!npz_read_text(file, name, text, sizeof text, error)) return false;
    for (*place = 0; *place < count; ++*place)
        if (strcmp(words[*place], text) == 0) return true;
    return error_input(error, npz_path(file), "%s: a word that is not known", name);
}

static bool read_words(NpzFile *file, Dataset *dataset, Error *error) {
    const char *views[PAIR_VIEWS];
    int view, target, labels;
    for (int v = 0; v < PAIR_VIEWS; v++) views[v] = pair_views[v].name;
    if (!read_word(file, "view", views, PAIR_VIEWS, &view, error) ||
        !read_word(file, "target", pair_target_names, PAIR_TARGETS, &target, error) ||
        !read_word(file, "labels", dataset_label_names, DATASET_LABELS, &labels, error))
        return false;
    dataset->view = (PairView)view;
    dataset->target = (PairTarget)target;
    dataset->labels = (DatasetLabels)labels;
    return true;
}

static bool read_sizes(void *of, NpzFile *npz, Error *error) {
    DatasetFile *file = of;
    Dataset *dataset = file->dataset;
    int64_t launches, shape[2];
    if (!read_scenes(npz, dataset, error) || !read_words(npz, dataset, error) ||
        !npz_shape(npz, "launch_x", NPZ_FLOAT32, 1, &launches, error) ||
        !npz_shape(npz, "inputs", NPZ_FLOAT32, 2, shape, error))
        return false;
    if (launches < 1 || launches > INT_MAX || shape[0] < 1)
        return error_input(error, npz_path(npz), "%lld launches and %lld rows; expected at least one of each",
                           (long long)launches, (long long)shape[0]);
    dataset->launches = (int)launches;
    dataset->rows = shape[0];
    file->context = npz_has(npz, "context");
    return true;
}

static bool make_arrays(void *of, Error *error) {
    const DatasetFile *file = of;
    return (dataset_make_launches(file->dataset, file->dataset->launches) &&
            dataset_make_rows(file->dataset, file->dataset->rows, file->context)) ||
           error_memory(error, "dataset");
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

static bool check_contents(void *of, const char *path, Error *error) {
    const Dataset *dataset = ((DatasetFile *)of)->dataset;
    const int64_t rows = dataset->rows;
    if (!check_indices(dataset->launch_scene, dataset->launches, dataset->scene_count, "launch_scene", path, error) ||
        !check_indices(dataset->launch, rows, dataset->launches, "launch", path, error) ||
        !check_indices(dataset->frame, rows, INT32_MAX, "frame", path, error) ||
        !check_indices(dataset->bodies, rows * 2, INT32_MAX, "bodies", path, error))
        return false;
    for (int64_t r = 0; dataset->context != NULL && r < rows; r++) {
        const char *fault = pair_context_fault(dataset->context + r * PAIR_CONTEXT);
        if (fault != NULL) return error_input(error, path, "context: row %lld has %s", (long long)r, fault);
    }
    for (int i = 0; i < dataset->launches; i++)
        if (dataset->launch_test[i] > 1)
            return error_input(error, path, "launch_test: number %d is %d; expected 0 and 1", i,
                               dataset->launch_test[i]);
    int64_t test_rows = 0;
    for (int64_t r = 0; r < rows; r++) test_rows += dataset_is_test(dataset, r);
    return (test_rows > 0 && test_rows < rows) ||
           error_input(error, path, "%lld rows to train on and %lld to test on; expected at least one of each",
                       (long long)(rows - test_rows), (long long)test_rows);
}

static const NetFileKind kind = {"dataset", DATASET_VERSION, list_fields, read_sizes, make_arrays, check_contents};

int dataset_arrays(const Dataset *dataset, DatasetArrays *arrays) {
    DatasetFile file = {(Dataset *)dataset, dataset->context != NULL, arrays->scenes};
    arrays->scenes[0] = '\0';
    for (int i = 0; i < dataset->scene_count; i++)
        text_add(arrays->scenes, sizeof arrays->scenes, "%s%s", i > 0 ? "\n" : "", dataset->scenes[i]);
    const int count = list_fields(&file, arrays->fields);
    arrays->list[0] = (NpzArray){"version", NPZ_INT32, 0, {0}, &kind.version};
    arrays->list[1] = (NpzArray){"kind", NPZ_TEXT, 0, {0}, kind.name};
    for (int i = 0; i < count; i++) arrays->list[2 + i] = net_field_array(&arrays->fields[i]);
    return 2 + count;
}

bool dataset_write(const Dataset *dataset, const char *path, Error *error) {
    DatasetArrays arrays;
    const int count = dataset_arrays(dataset, &arrays);
    return npz_write(path, arrays.list, (size_t)count, error);
}

Dataset *dataset_read(const char *path, Error *error) {
    DatasetFile file = {.dataset = calloc(1, sizeof *file.dataset)};
    if (file.dataset == NULL) return error_memory(error, path), NULL;
    if (net_file_read(&kind, &file, path, error)) return file.dataset;
    dataset_destroy(file.dataset);
    return NULL;
}
