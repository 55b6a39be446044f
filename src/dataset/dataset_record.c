/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dataset/dataset_record.h"

#include "common/parallel.h"
#include "dataset/dataset_launches.h"
#include "dataset/dataset_rows.h"

#include <stdlib.h>
#include <string.h>

/* State shared by the threads. */
typedef struct Runs {
    const DatasetRecording *recording;
    LaunchRows *launches; /* [count] */
    int first, count;     /* launches of the dataset */
} Runs;

/* Drops and frees the other rows now: those of many launches would exceed memory. */
static void thin(LaunchRows *launch, size_t every) {
    size_t kept = 0;
    for (size_t row = 0; row < launch->count; row += every) launch->rows[kept++] = launch->rows[row];
    launch->count = kept;
    PairRow *smaller = realloc(launch->rows, (kept + 1) * sizeof *smaller);
    if (smaller != NULL) launch->rows = smaller;
}

static bool record_launch(void *context, int i, Error *error) {
    const Runs *runs = context;
    const DatasetRecording *recording = runs->recording;
    const Scene scene = dataset_launch(recording->dataset, recording->scenes, runs->first + i);
    LaunchRows *launch = &runs->launches[i];
    if (!dataset_record_rows(recording->dataset, &scene, launch, error)) return false;
    if (recording->options->every > 1) thin(launch, (size_t)recording->options->every);
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
static bool gather(const Runs *runs, Dataset *dataset, Error *error) {
    const bool context = runs->recording->options->context;
    LaunchRows *launches = runs->launches;
    size_t rows = 0;
    for (int i = 0; i < runs->count; i++) {
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
    for (int i = 0; i < runs->count; i++) place_rows(dataset, &launches[i], runs->first + i, launches[i].start);
    return true;
}

bool dataset_record_launches(const DatasetRecording *recording, int first, int end, Dataset *part,
                             const Progress *progress, Error *error) {
    const int count = end - first;
    const Runs runs = {recording, calloc((size_t)count, sizeof *runs.launches), first, count};
    if (runs.launches == NULL) return error_memory(error, "dataset");
    const ParallelWork work = {record_launch, (void *)&runs};
    const bool ok = parallel_for(&work, count, "recorded launches", progress, error) && gather(&runs, part, error);
    for (int i = 0; i < count; i++) free(runs.launches[i].rows);
    free(runs.launches);
    return ok;
}

bool dataset_check_rows(int64_t rows, Error *error) {
    return rows > 0 || error_input(error, "dataset", "no two bodies touched in any launch");
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

bool dataset_recording_begin(DatasetRecording *recording, const DatasetOptions *options, Error *error) {
    *recording = (DatasetRecording){.options = options};
    if (!check_counts(options, error) || !check_target(options, error)) return false;
    for (int i = 0; i < options->scene_count; i++) {
        const Scene *scene = recording->scenes[i] = scene_read(options->scenes[i], error);
        if (scene == NULL) return false;
        if (!scene->bomb.present) return error_input(error, options->scenes[i], "the scene has no bomb to launch");
    }
    recording->dataset = dataset_of_launches(options, recording->scenes, error);
    return recording->dataset != NULL;
}

void dataset_recording_end(DatasetRecording *recording) {
    dataset_destroy(recording->dataset);
    for (int i = 0; i < DATASET_MAX_SCENES; i++) scene_destroy(recording->scenes[i]);
    *recording = (DatasetRecording){.options = NULL};
}

Dataset *dataset_record(const DatasetOptions *options, const Progress *progress, Error *error) {
    DatasetRecording recording;
    Dataset *dataset = NULL;
    if (dataset_recording_begin(&recording, options, error) &&
        dataset_record_launches(&recording, 0, recording.dataset->launches, recording.dataset, progress, error) &&
        dataset_check_rows(recording.dataset->rows, error)) {
        dataset = recording.dataset;
        recording.dataset = NULL;
    }
    dataset_recording_end(&recording);
    return dataset;
}
