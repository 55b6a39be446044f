/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is said of pieces: the missing ones, the plan of shards, and its estimate. */
#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "runs/runs_internal.h"
#include "runs/pieces.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void pieces_missing_add(PiecesMissing *missing, const PieceInfo *info) {
    const int shards = missing->pieces->shard.count;
    if (missing->count < MISSING_NAMED) memcpy(missing->names[missing->count], info->name, PIECE_NAME_SIZE);
    missing->count++;
    if (missing->shards == NULL) missing->shards = calloc((size_t)shards, 1);
    if (missing->shards != NULL) missing->shards[piece_shard(info, missing->plan->count, shards) - 1] = 1;
}

void pieces_missing_free(PiecesMissing *missing) { free(missing->shards); }

static void print_list(FILE *out, const unsigned char *shards, int count, const JobArray *array) {
    const int64_t first = array->step > 0 ? array->first : 1, step = array->step > 0 ? array->step : 1;
    const char *comma = "";
    for (int i = 0; i < count; i++) {
        int last = i;
        if (!shards[i]) continue;
        while (last + 1 < count && shards[last + 1]) last++;
        fprintf(out, "%s%" PRId64, comma, first + i * step);
        if (last > i) fprintf(out, "-%" PRId64, first + last * step);
        if (last > i && step > 1) fprintf(out, ":%" PRId64, step);
        comma = ",";
        i = last;
    }
}

char *pieces_shard_list(const unsigned char *shards, int count, const JobArray *array) {
    char *text = NULL;
    size_t size;
    FILE *out = memory_stream(&text, &size);
    if (out == NULL) return NULL;
    print_list(out, shards, count, array);
    const bool failed = ferror(out) != 0;
    if (fclose(out) == 0 && !failed) return text;
    free(text);
    return NULL;
}

bool pieces_missing_refuse(const PiecesMissing *missing, Error *error) {
    const Pieces *pieces = missing->pieces;
    enum { SHOWN = 800 };
    if (missing->count == 0) return true;
    char *list =
        missing->shards != NULL ? pieces_shard_list(missing->shards, pieces->shard.count, &pieces->array) : NULL;
    if (list == NULL) return error_memory(error, pieces->folder);
    error_incomplete(error, pieces->folder, "%" PRId64 " of %" PRId64 " pieces are missing: ", missing->count,
                     missing->plan->count);
    for (int i = 0; i < missing->count && i < MISSING_NAMED; i++)
        error_add(error, "%s%s", i > 0 ? ", " : "", missing->names[i]);
    error_add(error, "%s; run their shards (of %d) again: --array=%.*s%s",
              missing->count > MISSING_NAMED ? ", ..." : "", pieces->shard.count, SHOWN, list,
              strlen(list) > SHOWN ? "..." : "");
    if (pieces->run != NULL && pieces->run->shards != NULL)
        *pieces->run->shards = list;
    else
        free(list);
    return false;
}

const char *const pieces_limit_names[PIECES_LIMITS] = {"computing", "longest piece", "file system", "merge"};

static const double begin_until = 30; /* s */

typedef struct Measuring {
    const PiecePlan *plan;
    const Progress *progress;
    double began;
    int done, count;
    int64_t pieces[PIECES_MEASURED];
    double weights[PIECES_MEASURED], seconds[PIECES_MEASURED], bytes[PIECES_MEASURED]; /* seconds NaN: not measured */
} Measuring;

/* One more piece is done, or none. */
static bool pieces_report_done(Measuring *measuring, int more) {
    bool go_on;
#pragma omp critical(pieces_progress)
    {
        measuring->done += more;
        go_on = progress_report(measuring->progress, measuring->done, measuring->count);
    }
    return go_on;
}

static bool keep_on(void *context, double done, double total) {
    (void)done, (void)total;
    return pieces_report_done(context, 0);
}

/* All of a piece in this thread: a parallel region inside another has one. */
static bool pieces_report_measure(void *context, int i, Error *error) {
    Measuring *measuring = context;
    const Progress progress = {keep_on, measuring};
    char *results = NULL;
    size_t size = 0;
    if (clock_seconds() - measuring->began > begin_until) return true;
    FILE *stream = memory_stream(&results, &size);
    if (stream == NULL) return error_memory(error, "plan");
    const double began = clock_thread_seconds();
    const bool done = measuring->plan->work(measuring->plan->context, measuring->pieces[i], stream, &progress, error);
    const double took = clock_thread_seconds() - began;
    const bool written = !ferror(stream) && fclose(stream) == 0;
    free(results);
    if (!done) return false;
    if (!written) return error_memory(error, "plan");
    measuring->seconds[i] = took;
    measuring->bytes[i] = (double)size;
    return pieces_report_done(measuring, 1) || error_interrupted(error, "plan", "stopped");
}

/* The weight of all pieces, of the heaviest, and of the heaviest that few shards do together; these follow each
   other. */
static double add_weights(const PiecePlan *plan, double *heaviest, double *together) {
    double all = 0, group = 0;
    int64_t near = -1;
    *heaviest = *together = 0;
    for (int64_t i = 0; i < plan->count; i++) {
        const PieceInfo info = piece_describe(plan, i);
        group = info.near >= 0 && info.near == near ? group + info.weight : info.weight;
        near = info.near;
        all += info.weight;
        *heaviest = fmax(*heaviest, info.weight);
        *together = fmax(*together, group);
    }
    return all;
}

/* Pieces of the same group differ less than groups: the weights carry the measured times over to the others. */
static void pieces_report_extrapolate(PiecesEstimate *estimate, const Measuring *measuring) {
    double seconds = 0, bytes = 0, weights = 0, heaviest, together;
    for (int i = 0; i < measuring->count; i++) {
        if (isnan(measuring->seconds[i])) continue;
        estimate->measured++;
        seconds += measuring->seconds[i];
        bytes += measuring->bytes[i];
        weights += measuring->weights[i];
        estimate->longest = fmax(estimate->longest, measuring->seconds[i]);
    }
    const double rate = weights > 0 ? seconds / weights : 0;
    estimate->total = rate * add_weights(measuring->plan, &heaviest, &together);
    estimate->seconds = estimate->total / (double)estimate->pieces;
    estimate->longest = fmax(estimate->longest, rate * heaviest);
    estimate->together = fmax(estimate->longest, rate * together);
    estimate->bytes = estimate->measured > 0 ? bytes / estimate->measured : 0;
}

/* The k-th of the pieces to measure: any first few of them are spread over the whole plan. */
static int64_t pieces_report_spread(int64_t k, int64_t pieces) {
    const double golden = 0.6180339887498949;
    if (pieces <= PIECES_MEASURED) return k;
    return (int64_t)(fmod((double)k * golden, 1) * (double)pieces);
}

bool pieces_estimate(PiecesEstimate *estimate, const PiecePlan *plan, const Progress *progress, Error *error) {
    Measuring measuring = {.plan = plan, .progress = progress, .began = clock_seconds()};
    *estimate = (PiecesEstimate){.pieces = plan->count};
    for (int64_t k = 0; k < plan->count && k < PIECES_MEASURED; k++) {
        measuring.pieces[measuring.count] = pieces_report_spread(k, plan->count);
        const PieceInfo info = piece_describe(plan, measuring.pieces[measuring.count]);
        measuring.weights[measuring.count] = info.weight;
        measuring.seconds[measuring.count] = NAN;
        if (!info.alone) measuring.count++;
    }
    if (!parallel_for(&(ParallelWork){pieces_report_measure, &measuring}, measuring.count, "plan", NULL, error))
        return false;
    pieces_report_extrapolate(estimate, &measuring);
    return true;
}

PiecesLimit pieces_times(const PiecesEstimate *estimate, int64_t cores, double files, double seconds[PIECES_LIMITS]) {
    const double pieces = (double)estimate->pieces;
    seconds[LIMIT_COMPUTING] = estimate->total / (double)cores;
    seconds[LIMIT_LONGEST] = cores <= PIECES_NEAR_SHARDS ? estimate->together : estimate->longest;
    seconds[LIMIT_FILES] = pieces / files;
    seconds[LIMIT_MERGE] = 2 * pieces / files; /* every piece is checked, then read */
    PiecesLimit largest = LIMIT_COMPUTING;
    for (int i = 0; i < PIECES_LIMITS; i++)
        if (seconds[i] > seconds[largest]) largest = (PiecesLimit)i;
    return largest;
}
