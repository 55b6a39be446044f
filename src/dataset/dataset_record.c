/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/parallel.h"
#include "dataset/dataset_launches.h"
#include "dataset/dataset_rows.h"

#include <stdlib.h>
#include <string.h>

/* State shared by the threads. */
typedef struct Recording {
    Scene *const *scenes;
    const Dataset *dataset;
    LaunchRows *launches;
    int every; /* keep every n-th row */
} Recording;

/* Drops and frees the other rows now: those of many launches would exceed memory. */
static void thin(LaunchRows *launch, size_t every) {
    size_t kept = 0;
    for (size_t row = 0; row < launch->count; row += every) launch->rows[kept++] = launch->rows[row];
    launch->count = kept;
    PairRow *smaller = realloc(launch->rows, (kept + 1) * sizeof *smaller);
    if (smaller != NULL) launch->rows = smaller;
}

static bool record_launch(void *context, int index, Error *error) {
    const Recording *recording = context;
    Scene scene = dataset_launch(recording->dataset, recording->scenes, index);
    LaunchRows *launch = &recording->launches[index];
    if (!dataset_record_rows(recording->dataset, &scene, launch, error)) return false;
    if (recording->every > 1) thin(launch, (size_t)recording->every);
    return true;
}

/* Copies the rows of launch i to row `at` and on. */
static void place_rows(const Dataset *dataset, LaunchRows *launch, int i, size_t at) {
    size_t inputs = (size_t)dataset_inputs(dataset), changes = (size_t)pair_change_count(dataset->target);
    for (size_t k = 0; k < launch->count; k++, at++) {
        const PairRow *row = &launch->rows[k];
        memcpy(dataset->inputs + at * inputs, row->inputs, inputs * sizeof *row->inputs);
        memcpy(dataset->changes + at * changes, row->changes, changes * sizeof *row->changes);
        if (dataset->context != NULL) memcpy(dataset->context + at * PAIR_CONTEXT, row->context, sizeof row->context);
        dataset->launch[at] = i;
        dataset->frame[at] = row->frame;
        memcpy(dataset->bodies + at * 2, row->bodies, sizeof row->bodies);
    }
    free(launch->rows);
    launch->rows = NULL;
}

/* Concatenates the rows of the launches, in order. */
static bool gather(Dataset *dataset, LaunchRows *launches, bool context, Error *error) {
    size_t rows = 0;
    for (int i = 0; i < dataset->launches; i++) {
        launches[i].start = rows;
        rows += launches[i].count;
    }
    dataset->inputs = malloc((rows + 1) * (size_t)dataset_inputs(dataset) * sizeof *dataset->inputs);
    dataset->changes = malloc((rows + 1) * (size_t)pair_change_count(dataset->target) * sizeof *dataset->changes);
    if (context) dataset->context = malloc((rows + 1) * PAIR_CONTEXT * sizeof *dataset->context);
    dataset->launch = malloc((rows + 1) * sizeof *dataset->launch);
    dataset->frame = malloc((rows + 1) * sizeof *dataset->frame);
    dataset->bodies = malloc((rows + 1) * 2 * sizeof *dataset->bodies);
    if (dataset->inputs == NULL || dataset->changes == NULL || dataset->launch == NULL || dataset->frame == NULL ||
        dataset->bodies == NULL || (context && dataset->context == NULL))
        return error_memory(error, "dataset");
    dataset->rows = (int64_t)rows;
    /* In parallel: most of the time is page faults at the first write. */
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < dataset->launches; i++) place_rows(dataset, &launches[i], i, launches[i].start);
    if (rows == 0) return error_input(error, "dataset", "no two bodies touched in any launch");
    return true;
}

static Dataset *record_scenes(const DatasetOptions *options, Scene *const *scenes, const Progress *progress,
                              Error *error) {
    Dataset *dataset = dataset_of_launches(options, scenes, error);
    if (dataset == NULL) return NULL;
    LaunchRows *launches = calloc((size_t)dataset->launches, sizeof *launches);
    if (launches == NULL) error_memory(error, "dataset");
    Recording recording = {.scenes = scenes, .dataset = dataset, .launches = launches, .every = options->every};
    const ParallelWork work = {record_launch, &recording};
    bool ok = launches != NULL && parallel_for(&work, dataset->launches, "recorded launches", progress, error) &&
              gather(dataset, launches, options->context, error);
    for (int i = 0; launches != NULL && i < dataset->launches; i++) free(launches[i].rows);
    free(launches);
    if (ok) return dataset;
    dataset_destroy(dataset);
    return NULL;
}

Dataset *dataset_record(const DatasetOptions *options, const Progress *progress, Error *error) {
    if (options->scene_count < 1 || options->scene_count > DATASET_MAX_SCENES) {
        error_input(error, "dataset", "%d scenes; expected 1 to %d", options->scene_count, DATASET_MAX_SCENES);
        return NULL;
    }
    int launches = dataset_launches_each(options);
    if (launches < 5 || launches > DATASET_MAX_LAUNCHES) {
        error_input(error, "dataset", "%d launches per scene; expected at least 5, to hold out a fifth, and at most %d",
                    launches, DATASET_MAX_LAUNCHES);
        return NULL;
    }
    if (options->target == TARGET_IMPULSE && options->labels == DATASET_BY_REFERENCE) {
        error_input(error, "dataset",
                    "the target impulse is the change by a sweep of the engine; the reference has none");
        return NULL;
    }
    if (options->target == TARGET_IMPULSE && options->view == PAIR_NEIGHBOURS) {
        error_input(error, "dataset", "the target impulse has no view neighbours: they change at every visit");
        return NULL;
    }
    if (options->target == TARGET_POINTS && !pair_views[options->view].by_contact) {
        error_input(error, "dataset",
                    "the target points needs the view contact or neighbours, whose inputs have the warm start");
        return NULL;
    }
    if (options->context && options->target != TARGET_PAIR) {
        error_input(error, "dataset", "the context is for laws on the target pair; the target %s has none",
                    pair_target_names[options->target]);
        return NULL;
    }
    Scene *scenes[DATASET_MAX_SCENES] = {NULL};
    bool ok = true;
    for (int i = 0; ok && i < options->scene_count; i++) {
        scenes[i] = scene_read(options->scenes[i], error);
        ok = scenes[i] != NULL &&
             (scenes[i]->bomb.present || error_input(error, options->scenes[i], "the scene has no bomb to launch"));
    }
    Dataset *dataset = ok ? record_scenes(options, scenes, progress, error) : NULL;
    for (int i = 0; i < options->scene_count; i++) scene_destroy(scenes[i]);
    return dataset;
}
