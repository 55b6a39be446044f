/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Recording of datasets, launch after launch. */
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/dataset.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <stdlib.h>
#include <string.h>

/* What is recorded; shared by the threads. */
typedef struct Recording {
    const DatasetOptions *options;
    Scene *scenes[DATASET_MAX_SCENES];
    Dataset *dataset;     /* its launches, and no rows yet */
    LaunchRows *launches; /* [dataset->launches] */
} Recording;

/* Drops and frees the other rows now: those of many launches would exceed memory. */
static void dataset_record_thin(LaunchRows *launch, size_t every) {
    size_t kept = 0;
    for (size_t row = 0; row < launch->count; row += every) launch->rows[kept++] = launch->rows[row];
    launch->count = kept;
    PairRow *smaller = realloc(launch->rows, (kept + 1) * sizeof *smaller);
    if (smaller != NULL) launch->rows = smaller;
}

static bool record_launch(void *context, int i, Error *error) {
    const Recording *recording = context;
    const Scene scene = dataset_launch(recording->dataset, recording->scenes, i);
    LaunchRows *launch = &recording->launches[i];
    if (!dataset_record_rows(recording->dataset, &scene, launch, error)) return false;
    if (recording->options->every > 1) dataset_record_thin(launch, (size_t)recording->options->every);
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
static bool dataset_record_gather(const Recording *recording, Error *error) {
    Dataset *dataset = recording->dataset;
    LaunchRows *launches = recording->launches;
    size_t rows = 0;
    for (int i = 0; i < dataset->launches; i++) {
        launches[i].start = rows;
        rows += launches[i].count;
        dataset->unconverged += launches[i].unconverged;
    }
    if (!dataset_make_rows(dataset, (int64_t)rows, recording->options->context)) return error_memory(error, "dataset");
        /* In parallel: most of the time is page faults at the first write. */
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < dataset->launches; i++) place_rows(dataset, &launches[i], i, launches[i].start);
    return true;
}

static bool record_launches(Recording *recording, const Progress *progress, Error *error) {
    const int count = recording->dataset->launches;
    recording->launches = calloc((size_t)count, sizeof *recording->launches);
    if (recording->launches == NULL) return error_memory(error, "dataset");
    const ParallelWork work = {record_launch, recording};
    return parallel_for(&work, count, "recorded launches", progress, error) && dataset_record_gather(recording, error);
}

static bool check_rows(const Dataset *dataset, Error *error) {
    if (dataset->rows == 0 && dataset->unconverged > 0)
        return error_input(error, "dataset", "the reference converges in no step in which bodies touch");
    return dataset->rows > 0 || error_input(error, "dataset", "no two bodies touched in any launch");
}

static bool check_counts(const DatasetOptions *options, Error *error) {
    if (options->scene_count < 1 || options->scene_count > DATASET_MAX_SCENES)
        return error_input(error, "dataset", "%d scenes; expected 1 to %d", options->scene_count, DATASET_MAX_SCENES);
    const int launches = dataset_launches_each(options);
    return (launches >= 5 && launches <= DATASET_MAX_LAUNCHES) ||
           error_input(error, "dataset",
                       "%d launches per scene; expected at least 5, to hold out a fifth, and at most %d", launches,
                       DATASET_MAX_LAUNCHES);
}

static bool check_target(const DatasetOptions *options, Error *error) {
    if (options->target == TARGET_IMPULSE && options->labels == DATASET_BY_REFERENCE)
        return error_input(error, "dataset",
                           "the target impulse is the change by a sweep of the engine; the reference has none");
    if (options->target == TARGET_IMPULSE && options->view == PAIR_NEIGHBOURS)
        return error_input(error, "dataset", "the target impulse has no view neighbours: they change at every visit");
    if (options->target == TARGET_POINTS && !pair_views[options->view].by_contact)
        return error_input(error, "dataset",
                           "the target points needs the view contact or neighbours, whose inputs have the warm start");
    return !options->context || options->target == TARGET_PAIR ||
           error_input(error, "dataset", "the context is for laws on the target pair; the target %s has none",
                       pair_target_names[options->target]);
}

/* Checks the options, reads the scenes and makes the launches. end_recording(), also after a failure. */
static bool begin_recording(Recording *recording, const DatasetOptions *options, Error *error) {
    *recording = (Recording){.options = options};
    if (!check_counts(options, error) || !check_target(options, error)) return false;
    for (int i = 0; i < options->scene_count; i++) {
        const Scene *scene = recording->scenes[i] = scene_read(options->scenes[i], error);
        if (scene == NULL) return false;
        if (!scene->bomb.present) return error_input(error, options->scenes[i], "the scene has no bomb to launch");
    }
    recording->dataset = dataset_of_launches(options, recording->scenes, error);
    return recording->dataset != NULL;
}

static void end_recording(Recording *recording) {
    for (int i = 0; recording->launches != NULL && i < recording->dataset->launches; i++)
        free(recording->launches[i].rows);
    free(recording->launches);
    for (int i = 0; i < DATASET_MAX_SCENES; i++) scene_destroy(recording->scenes[i]);
}

Dataset *dataset_record(const DatasetOptions *options, const Progress *progress, Error *error) {
    Recording recording;
    const bool ok = begin_recording(&recording, options, error) && record_launches(&recording, progress, error) &&
                    check_rows(recording.dataset, error);
    end_recording(&recording);
    if (ok) return recording.dataset;
    dataset_destroy(recording.dataset);
    return NULL;
}
