/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Doing the pieces of a process, and checking those of all. */
#include "pieces/pieces.h"

#include "common/file.h"
#include "common/memory_stream.h"
#include "common/parallel.h"
#include "pieces/pieces_missing.h"

#include <inttypes.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* Pieces that are handed to the threads together. */
enum { BATCH = 4096 };

typedef struct Doing {
    Pieces *pieces;
    const PiecePlan *plan;
    const Progress *progress;
    double done, total; /* weights */
    bool stopped;
    int count;
    int64_t batch[BATCH];
} Doing;

/* The progress of a piece as a share of the whole. */
typedef struct PieceProgress {
    Doing *doing;
    double weight, share; /* share: of `done` so far */
} PieceProgress;

static bool report(void *context, double done, double total) {
    PieceProgress *piece = context;
    Doing *doing = piece->doing;
    const double share = total > 0 ? piece->weight * done / total : 0;
    bool stopped;
#pragma omp critical(pieces_progress)
    {
        doing->done += share - piece->share;
        piece->share = share;
        doing->stopped = doing->stopped || !progress_report(doing->progress, doing->done, doing->total);
        stopped = doing->stopped;
    }
    return !stopped;
}

/* Writes the piece's file once its results are whole. */
static bool store(const Pieces *pieces, int64_t piece, const char *results, size_t size, Error *error) {
    char path[PIECES_PATH_SIZE], folder[PIECES_PATH_SIZE];
    PieceHead head;
    pieces_head(pieces, piece, &head);
    if (!pieces_path(pieces, piece, path, error)) return false;
    snprintf(folder, sizeof folder, "%.*s", (int)file_folder_length(path), path);
    return file_make_directory(folder, error) && piece_file_write(path, &head, results, size, error);
}

static bool work(Doing *doing, int64_t piece, PieceProgress *own, Error *error) {
    const Progress progress = {report, own};
    char *results = NULL;
    size_t size = 0;
    FILE *stream = memory_stream(&results, &size);
    if (stream == NULL) return error_memory(error, "piece");
    bool ok = doing->plan->work(doing->plan->context, piece, stream, &progress, error);
    if (ferror(stream) && ok) ok = error_memory(error, "piece");
    if (fclose(stream) != 0 && ok) ok = error_memory(error, "piece");
    ok = ok && store(doing->pieces, piece, results, size, error);
    free(results);
    return ok;
}

static bool do_piece(void *context, int i, Error *error) {
    Doing *doing = context;
    const PieceInfo info = piece_describe(doing->plan, doing->batch[i]);
    PieceProgress own = {doing, info.weight, 0};
    Error failure = {0};
    if (work(doing, doing->batch[i], &own, &failure) && report(&own, 1, 1)) return true;
    if (failure.kind == ERROR_NONE || failure.kind == ERROR_INTERRUPTED)
        return error_interrupted(error, info.name, "stopped; finished pieces are kept");
    *error = failure;
    return false;
}

/* Many pieces: a thread for each. Few: all threads for each, as far as the piece itself uses them. */
static bool do_batch(Doing *doing, bool alone, Error *error) {
    bool ok = true;
    if (!alone && doing->count >= 2 * omp_get_max_threads()) {
        const ParallelWork threads = {do_piece, doing};
        ok = parallel_for(&threads, doing->count, "study", NULL, error);
    } else {
        for (int i = 0; ok && i < doing->count; i++) ok = do_piece(doing, i, error);
    }
    doing->count = 0;
    return ok;
}

static bool is_own(const Doing *doing, const PieceInfo *info) {
    const Shard *shard = &doing->pieces->shard;
    return piece_shard(info, doing->plan->count, shard->count) == shard->number;
}

static bool count_own(Doing *doing, Error *error) {
    for (int64_t i = 0; i < doing->plan->count; i++) {
        const PieceInfo info = piece_describe(doing->plan, i);
        bool done;
        if (!is_own(doing, &info)) continue;
        if (!pieces_find(doing->pieces, i, &done, NULL, error)) return false;
        doing->pieces->own++;
        if (done)
            doing->pieces->kept++;
        else
            doing->total += info.weight;
    }
    return true;
}

/* Does those that are done alone, or the others. */
static bool do_own(Doing *doing, bool alone, Error *error) {
    for (int64_t i = 0; i < doing->plan->count; i++) {
        const PieceInfo info = piece_describe(doing->plan, i);
        bool done;
        if (info.alone != alone || !is_own(doing, &info)) continue;
        if (!pieces_find(doing->pieces, i, &done, NULL, error)) return false;
        if (!done && doing->plan->ready != NULL && !doing->plan->ready(doing->plan->context, i)) {
            doing->pieces->waiting++;
            continue;
        }
        if (!done) doing->batch[doing->count++] = i;
        if ((doing->count == BATCH || (alone && doing->count > 0)) && !do_batch(doing, alone, error)) return false;
    }
    return do_batch(doing, alone, error);
}

/* The processor of timed pieces, in the order of the plan. */
static void meet_cpu(Pieces *pieces, const char *cpu) {
    if (cpu[0] == '\0') return;
    if (pieces->cpu[0] == '\0')
        memcpy(pieces->cpu, cpu, CPU_NAME_SIZE);
    else if (strcmp(cpu, pieces->cpu) != 0)
        pieces->cpus_differ = true;
}

static bool check_piece(Doing *doing, int64_t piece, PiecesMissing *missing, Error *error) {
    char cpu[CPU_NAME_SIZE];
    bool done;
    if (!pieces_find(doing->pieces, piece, &done, cpu, error)) return false;
    meet_cpu(doing->pieces, cpu);
    if (done) return true;
    const PieceInfo info = piece_describe(doing->plan, piece);
    pieces_missing_add(missing, &info);
    return true;
}

/* Every piece, whoever did it. */
static bool check_all(Doing *doing, Error *error) {
    PiecesMissing missing = {.pieces = doing->pieces, .plan = doing->plan};
    bool ok = true;
    for (int64_t i = 0; ok && i < doing->plan->count; i++) {
        ok = check_piece(doing, i, &missing, error);
        if (ok && doing->pieces->mode == PIECES_MERGE &&
            !progress_report(doing->progress, (double)i + 1, (double)doing->plan->count))
            ok = error_interrupted(error, doing->pieces->folder, "stopped");
    }
    ok = ok && pieces_missing_refuse(&missing, error);
    pieces_missing_free(&missing);
    if (ok && doing->pieces->mode == PIECES_MERGE && doing->pieces->cpus_differ && !doing->pieces->run->times_first)
        ok = error_input(
            error, doing->pieces->folder,
            "times were measured on different processors, on %s and on others; do those pieces again on one, "
            "or use --times first, which leaves out the times of the others",
            doing->pieces->cpu);
    return ok;
}

bool pieces_do(Pieces *pieces, const PiecePlan *plan, const Progress *progress, Error *error) {
    if (plan->count > PIECES_MAX)
        return error_input(error, pieces->folder, "the study has %" PRId64 " pieces; at most %d are allowed",
                           plan->count, PIECES_MAX);
    Doing *doing = calloc(1, sizeof *doing);
    if (doing == NULL) return error_memory(error, "study");
    pieces->plan = plan;
    *doing = (Doing){.pieces = pieces, .plan = plan, .progress = progress};
    bool ok = pieces->mode == PIECES_MERGE ||
              (count_own(doing, error) && do_own(doing, false, error) && do_own(doing, true, error));
    if (pieces->mode != PIECES_SHARD) ok = ok && check_all(doing, error);
    free(doing);
    return ok;
}
