/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dataset/dataset_pieces.h"

#include "common/memory_stream.h"
#include "dataset/dataset_file.h"
#include "npz/npz_stream.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* About the bytes of a piece: several are in memory for each thread. */
static const double piece_size = 1 << 22;

/* Of a launch, on average over steps: a box touches about as many others. */
static const double pairs_of_body = 1.5;

/* s: of recording a row, roughly. */
static const double row_seconds = 2e-6;

/* All arrays of rows have numbers of 4 bytes. */
static size_t row_size(const NpzArray *array) {
    return sizeof(float) * (array->rank == 2 ? (size_t)array->shape[1] : 1);
}

static int row_arrays(const DatasetPieces *pieces) { return DATASET_ROW_ARRAYS - !pieces->recording.options->context; }

/* Bytes of a row in all its arrays. */
static size_t whole_row_size(const DatasetPieces *pieces) {
    DatasetArrays arrays;
    size_t size = 0;
    dataset_arrays(pieces->recording.dataset, true, &arrays);
    for (int i = 0; i < row_arrays(pieces); i++) size += row_size(&arrays.list[DATASET_FIRST_ROWS + i]);
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
    const bool ok = dataset_record_launches(&pieces->recording, (int)first, (int)end, &part, progress, error);
    dataset_arrays(&part, true, &arrays);
    for (int i = 0; ok && i < row_arrays(pieces); i++) {
        const NpzArray *array = &arrays.list[DATASET_FIRST_ROWS + i];
        stream_put(results, array->data, row_size(array), (size_t)part.rows);
    }
    dataset_free_rows(&part);
    return ok;
}

bool dataset_pieces_make(DatasetPieces *pieces, const DatasetOptions *options, Error *error) {
    *pieces = (DatasetPieces){.plan = {.describe = describe, .work = work, .context = pieces}};
    if (!dataset_recording_begin(&pieces->recording, options, error)) return false;
    const int each = pieces->recording.dataset->launches / options->scene_count;
    for (int s = 0; s < options->scene_count; s++) {
        const double rows = estimated_rows(options, pieces->recording.scenes[s]) * each;
        piece_ranges_add(&pieces->launches, each, rows * (double)whole_row_size(pieces) / piece_size);
    }
    pieces->plan.count = piece_ranges_count(&pieces->launches);
    return true;
}

void dataset_pieces_free(DatasetPieces *pieces) { dataset_recording_end(&pieces->recording); }

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
                           const char *path, Error *error) {
    const size_t whole = whole_row_size(pieces), rows = size / whole;
    int64_t first, end;
    bool fits = size % whole == 0;
    piece_ranges_find(&pieces->launches, piece, &first, &end);
    /* Inputs and changes precede the launches. */
    const Dataset *dataset = pieces->recording.dataset;
    const size_t before = sizeof(float) * (size_t)(dataset_inputs(dataset) + pair_change_count(dataset->target));
    int32_t last = (int32_t)first;
    for (size_t i = 0; fits && i < rows; i++) {
        int32_t launch;
        memcpy(&launch, results + before * rows + i * sizeof launch, sizeof launch);
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
                      int64_t *all_rows, Error *error) {
    char path[PIECES_PATH_SIZE];
    DatasetArrays arrays;
    size_t size, at = 0;
    if (!pieces_path(done, piece, path, error)) return false;
    char *results = pieces_read(done, piece, &size, NULL, error);
    const int64_t rows = results != NULL ? dataset_piece_rows(pieces, piece, results, size, path, error) : -1;
    bool ok = rows >= 0;
    dataset_arrays(pieces->recording.dataset, true, &arrays);
    for (int i = DATASET_FIRST_ROWS; ok && i < DATASET_FIRST_ROWS + row_arrays(pieces); i++) {
        ok = npz_stream_append(stream, i, results + at, rows, error);
        at += row_size(&arrays.list[i]) * (size_t)rows;
    }
    if (ok) *all_rows += rows;
    free(results);
    return ok;
}

bool dataset_pieces_write(const DatasetPieces *pieces, const Pieces *done, const char *path, int64_t *rows,
                          const Progress *progress, Error *error) {
    DatasetArrays arrays;
    const int count = dataset_arrays(pieces->recording.dataset, pieces->recording.options->context, &arrays);
    const int64_t all = pieces->plan.count;
    NpzStream *stream = npz_stream_create(path, count, error);
    bool ok = stream != NULL;
    *rows = 0;
    for (int i = 0; ok && i < count; i++) ok = npz_stream_add(stream, &arrays.list[i], error) >= 0;
    for (int64_t i = 0; ok && i < all; i++) {
        ok = add_piece(pieces, done, i, stream, rows, error);
        if (ok && !progress_report(progress, (double)i + 1, (double)all))
            ok = error_interrupted(error, path, "stopped; finished pieces are kept");
    }
    ok = ok && (*rows == 0 || npz_stream_finish(stream, error));
    npz_stream_destroy(stream);
    return ok;
}
