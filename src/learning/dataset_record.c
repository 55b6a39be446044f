/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Recording of many launches: datasets in memory, datasets in pieces, and poses. */
#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "base/npz.h"
#include "engine/engine.h"
#include "learning/dataset.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "runs/pieces.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <inttypes.h>
#include <math.h>
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
        dataset->unconverged += launches[i].unconverged;
    }
    if (!dataset_make_rows(dataset, (int64_t)rows, context)) return error_memory(error, "dataset");
        /* In parallel: most of the time is page faults at the first write. */
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < runs->count; i++) place_rows(dataset, &launches[i], runs->first + i, launches[i].start);
    return true;
}

/* Records launches first .. end - 1 into the arrays of rows of *part, which must have none: a copy of recording->dataset, or
   that dataset itself. */
static bool record_launches(const DatasetRecording *recording, int first, int end, Dataset *part,
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

bool dataset_check_rows(int64_t rows, int64_t unconverged, Error *error) {
    if (rows == 0 && unconverged > 0)
        return error_input(error, "dataset", "the reference converges in no step in which bodies touch");
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

/* Checks the options, reads the scenes and makes the launches. Errors as dataset_record(). end_recording(), also after
   a failure. */
static bool begin_recording(DatasetRecording *recording, const DatasetOptions *options, Error *error) {
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

static void end_recording(DatasetRecording *recording) {
    dataset_destroy(recording->dataset);
    for (int i = 0; i < DATASET_MAX_SCENES; i++) scene_destroy(recording->scenes[i]);
    *recording = (DatasetRecording){.options = NULL};
}

Dataset *dataset_record(const DatasetOptions *options, const Progress *progress, Error *error) {
    DatasetRecording recording;
    Dataset *dataset = NULL;
    if (begin_recording(&recording, options, error) &&
        record_launches(&recording, 0, recording.dataset->launches, recording.dataset, progress, error) &&
        dataset_check_rows(recording.dataset->rows, recording.dataset->unconverged, error)) {
        dataset = recording.dataset;
        recording.dataset = NULL;
    }
    end_recording(&recording);
    return dataset;
}

/* About the bytes of a piece: several are in memory for each thread. */
static const double piece_size = 1 << 22;

/* Of a launch, on average over steps: a box touches about as many others. */
static const double pairs_of_body = 1.5;

/* s: of recording a row, roughly. */
static const double row_seconds = 2e-6;

static int row_arrays(const DatasetPieces *pieces) { return DATASET_ROW_ARRAYS - !pieces->recording.options->context; }

/* Bytes of a row in all its arrays. */
static size_t whole_row_size(const DatasetPieces *pieces) {
    DatasetArrays arrays;
    size_t size = 0;
    dataset_arrays(pieces->recording.dataset, true, &arrays);
    for (int i = 0; i < row_arrays(pieces); i++) size += dataset_row_size(&arrays.list[DATASET_FIRST_ROWS + i]);
    return size;
}

static double estimated_rows(const DatasetOptions *options, const Scene *scene) {
    const double pairs = pairs_of_body * (scene->body_count + 1.0) * scene->frames;
    const double sweeps = options->target == TARGET_IMPULSE ? scene->iterations : 1;
    return pairs * sweeps / (options->every > 1 ? options->every : 1);
}

static void describe(void *context, int64_t piece, PieceInfo *info) {
    const DatasetPieces *pieces = context;
    int64_t first, end;
    const Scene *scene = pieces->recording.scenes[piece_ranges_find(&pieces->launches, piece, &first, &end)];
    snprintf(info->name, sizeof info->name, "launches %" PRId64 "-%" PRId64, first + 1, end);
    info->weight = row_seconds * estimated_rows(pieces->recording.options, scene) * (double)(end - first);
}

static bool work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    const DatasetPieces *pieces = context;
    Dataset part = *pieces->recording.dataset;
    DatasetArrays arrays;
    int64_t first, end;
    piece_ranges_find(&pieces->launches, piece, &first, &end);
    const bool ok = record_launches(&pieces->recording, (int)first, (int)end, &part, progress, error);
    dataset_arrays(&part, true, &arrays);
    if (ok) stream_put(results, &part.unconverged, sizeof part.unconverged, 1);
    for (int i = 0; ok && i < row_arrays(pieces); i++) {
        const NpzArray *array = &arrays.list[DATASET_FIRST_ROWS + i];
        stream_put(results, array->data, dataset_row_size(array), (size_t)part.rows);
    }
    free(part.row_block);
    return ok;
}

bool dataset_pieces_make(DatasetPieces *pieces, const DatasetOptions *options, Error *error) {
    *pieces = (DatasetPieces){.plan = {.describe = describe, .work = work, .context = pieces}};
    if (!begin_recording(&pieces->recording, options, error)) return false;
    const int each = pieces->recording.dataset->launches / options->scene_count;
    for (int s = 0; s < options->scene_count; s++) {
        const double rows = estimated_rows(options, pieces->recording.scenes[s]) * each;
        piece_ranges_add(&pieces->launches, each, rows * (double)whole_row_size(pieces) / piece_size);
    }
    pieces->plan.count = piece_ranges_count(&pieces->launches);
    return true;
}

void dataset_pieces_free(DatasetPieces *pieces) { end_recording(&pieces->recording); }

bool dataset_pieces_key(const DatasetPieces *pieces, StudyKey *key, Error *error) {
    const DatasetOptions *options = pieces->recording.options;
    const Dataset *dataset = pieces->recording.dataset;
    const int64_t choices[] = {options->view,  options->target,  options->labels,
                               options->every, options->context, (int64_t)options->seed};
    const size_t size = (size_t)dataset->launches * sizeof *dataset->launch_x;
    if (!study_key_begin(key, error)) return false;
    study_key_add(key, choices, sizeof choices);
    for (int s = 0; s < options->scene_count; s++)
        if (!study_key_add_file(key, options->scenes[s], error)) return false;
    if (options->table_path != NULL && !study_key_add_file(key, options->table_path, error)) return false;
    study_key_add(key, dataset->launch_x, size);
    study_key_add(key, dataset->launch_rotation, size);
    study_key_add(key, dataset->launch_spin, size);
    return true;
}

int64_t dataset_piece_rows(const DatasetPieces *pieces, int64_t piece, const char *results, size_t size,
                           int64_t *unconverged, const char *path, Error *error) {
    const size_t whole = whole_row_size(pieces), head = DATASET_PIECE_HEAD;
    const size_t rows = size < head ? 0 : (size - head) / whole;
    int64_t first, end;
    bool fits = size == head + rows * whole;
    *unconverged = 0;
    if (fits) memcpy(unconverged, results, head);
    fits = fits && *unconverged >= 0;
    piece_ranges_find(&pieces->launches, piece, &first, &end);
    /* Inputs and changes precede the launches. */
    const Dataset *dataset = pieces->recording.dataset;
    const size_t numbers = (size_t)dataset_inputs(dataset) + (size_t)pair_change_count(dataset->target);
    const char *launches = results + head + sizeof(float) * numbers * rows;
    int32_t last = (int32_t)first;
    for (size_t i = 0; fits && i < rows; i++) {
        int32_t launch;
        memcpy(&launch, launches + i * sizeof launch, sizeof launch);
        fits = launch >= last && launch < end;
        last = launch;
    }
    if (fits) return (int64_t)rows;
    error_input(error, path,
                "does not have the rows of the launches %" PRId64 " to %" PRId64
                "; delete it, and its shard does it again",
                first + 1, end);
    return -1;
}

/* Appends the rows of a piece to the arrays, whose numbers in the stream are those in the file. */
static bool add_piece(const DatasetPieces *pieces, const Pieces *done, int64_t piece, NpzStream *stream,
                      int64_t *all_rows, int64_t *all_unconverged, Error *error) {
    char path[PIECES_PATH_SIZE];
    DatasetArrays arrays;
    int64_t unconverged;
    size_t size, at = DATASET_PIECE_HEAD;
    if (!pieces_path(done, piece, path, error)) return false;
    char *results = pieces_read(done, piece, &size, NULL, error);
    const int64_t rows =
        results != NULL ? dataset_piece_rows(pieces, piece, results, size, &unconverged, path, error) : -1;
    bool ok = rows >= 0;
    dataset_arrays(pieces->recording.dataset, true, &arrays);
    for (int i = DATASET_FIRST_ROWS; ok && i < DATASET_FIRST_ROWS + row_arrays(pieces); i++) {
        ok = npz_stream_append(stream, i, results + at, rows, error);
        at += dataset_row_size(&arrays.list[i]) * (size_t)rows;
    }
    if (ok) *all_rows += rows;
    if (ok) *all_unconverged += unconverged;
    free(results);
    return ok;
}

bool dataset_pieces_write(const DatasetPieces *pieces, const Pieces *done, const char *path, int64_t *rows,
                          int64_t *unconverged, const Progress *progress, Error *error) {
    DatasetArrays arrays;
    const int count = dataset_arrays(pieces->recording.dataset, pieces->recording.options->context, &arrays);
    const int64_t all = pieces->plan.count;
    NpzStream *stream = npz_stream_create(path, count, error);
    bool ok = stream != NULL;
    *rows = *unconverged = 0;
    for (int i = 0; ok && i < count; i++) ok = npz_stream_add(stream, &arrays.list[i], error) >= 0;
    for (int64_t i = 0; ok && i < all; i++) {
        ok = add_piece(pieces, done, i, stream, rows, unconverged, error);
        if (ok && !progress_report(progress, (double)i + 1, (double)all))
            ok = error_interrupted(error, path, "stopped; finished pieces are kept");
    }
    ok = ok && (*rows == 0 || npz_stream_finish(stream, error));
    npz_stream_destroy(stream);
    return ok;
}

enum { LAUNCH_RUNS_MAX_BYTES = 1 << 30 };

typedef struct Work {
    LaunchRuns *runs;
    const Scene *scene;
    const Method *method;
} Work;

static void record(const LaunchRuns *runs, const World *world, BodyPose *poses) {
    const Body *bodies = world_bodies(world);
    const int count = world_body_count(world);
    for (int i = 0; i < runs->bodies; i++)
        poses[i] = i < count ? (BodyPose){bodies[i].position, bodies[i].angle} : (BodyPose){{NAN, NAN}, NAN};
}

/* A run in progress. */
typedef struct LaunchRun {
    const LaunchRuns *runs;
    BodyPose *poses; /* [frames, bodies] */
} LaunchRun;

static bool observe(void *context, int frame, const World *world, Error *error) {
    (void)error;
    const LaunchRun *run = context;
    record(run->runs, world, run->poses + (size_t)frame * (size_t)run->runs->bodies);
    return true;
}

static bool run_launch(void *context, int i, Error *error) {
    const Work *work = context;
    const LaunchRuns *runs = work->runs;
    LaunchRun run = {runs, runs->poses + (size_t)i * (size_t)runs->frames * (size_t)runs->bodies};
    const StepObserver observer = {observe, &run};
    const Scene launched = launch_scene(work->scene, &runs->launches[i]);
    World *start = scene_world(&launched, error);
    if (start == NULL) return false;
    record(runs, start, run.poses);
    world_destroy(start);
    return simulate_observed(&launched, work->method, &observer, error);
}

bool launch_runs_record(LaunchRuns *runs, const Scene *scene, const Method *method, const Launch *launches, int count,
                        const Progress *progress, Error *error) {
    *runs = (LaunchRuns){.count = count, .frames = scene->frames + 1, .bodies = scene->body_count + 1};
    if (!scene->bomb.present) return error_input(error, scene->name, "the scene has no bomb, so it has no launches");
    const double bytes = (double)count * runs->frames * runs->bodies * (double)sizeof *runs->poses;
    if (bytes > LAUNCH_RUNS_MAX_BYTES)
        return error_input(error, scene->name, "%d launches take %.0f MiB of poses; at most 1024 MiB are allowed",
                           count, bytes / (1 << 20));
    runs->launches = malloc((size_t)count * sizeof *runs->launches);
    runs->poses = malloc((size_t)bytes);
    if (runs->launches == NULL || runs->poses == NULL) return error_memory(error, scene->name);
    memcpy(runs->launches, launches, (size_t)count * sizeof *launches);
    Work work = {runs, scene, method};
    return parallel_for(&(ParallelWork){run_launch, &work}, count, "launches", progress, error);
}

void launch_runs_free(LaunchRuns *runs) {
    free(runs->launches);
    free(runs->poses);
    *runs = (LaunchRuns){0};
}
