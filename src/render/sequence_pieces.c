/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/sequence_pieces.h"

#include "render/sink.h"
#include "render/workers.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* A piece takes some seconds on one core, as a process takes as long to start as some dozens of small pictures; a short
   film has pieces for some shards all the same. */
static const double piece_seconds = 4;

enum { MOST_PICTURES = 256, FEW_PICTURES = 32, FEW_PIECES = 16 };

/* The plan's context. */
typedef struct Ranges {
    WorkerJob all;
    double seconds; /* about those of a picture */
    int size;       /* pictures in a piece; fewer in the last */
} Ranges;

static int at_most(int a, int b) { return a < b ? a : b; }
static int at_least(int a, int b) { return a > b ? a : b; }

/* Follows from the options alone, so that all shards have the same pieces. */
static void plan_ranges(Ranges *ranges, const WorkerJob *job) {
    const RenderOptions *options = job->options;
    const double pixel_seconds = options->small ? 4e-8 : 2.5e-9;
    const int pictures = job->last - job->first + 1;
    *ranges = (Ranges){.all = *job, .seconds = 1e-3 + pixel_seconds * options->width * options->height};
    ranges->size = at_least(1, at_most(MOST_PICTURES, (int)(piece_seconds / ranges->seconds)));
    ranges->size = at_most(ranges->size, at_least(FEW_PICTURES, pictures / FEW_PIECES));
}

static int first_of(const Ranges *ranges, int64_t piece) { return ranges->all.first + (int)piece * ranges->size; }

static int last_of(const Ranges *ranges, int64_t piece) {
    return at_most(first_of(ranges, piece + 1) - 1, ranges->all.last);
}

static void describe(void *context, int64_t piece, PieceInfo *info) {
    const Ranges *ranges = context;
    const int first = first_of(ranges, piece), last = last_of(ranges, piece);
    snprintf(info->name, sizeof info->name, "pictures %d-%d", first, last);
    info->weight = (last - first + 1) * ranges->seconds;
    info->alone = true; /* its processes take all cores */
}

static bool work(void *context, int64_t piece, FILE *results, const Progress *progress, Error *error) {
    const Ranges *ranges = context;
    WorkerJob job = ranges->all;
    const Manifest *manifest = job.manifest;
    job.first = first_of(ranges, piece);
    job.last = last_of(ranges, piece);
    if (!workers_draw(&job, NULL, progress, error)) return false;
    for (int i = job.first; i <= job.last; i++) {
        const PictureHashes *hashes = &manifest->hashes[i - manifest->first];
        fprintf(results, "%d %016" PRIx64 " %016" PRIx64 "\n", i, hashes->pixels, hashes->file);
    }
    return true;
}

/* The hashes of picture `index` from the line at *text, which then stands at the next one. */
static bool read_line(const char **text, int index, PictureHashes *hashes) {
    int read, end = 0;
    if (sscanf(*text, "%d %16" SCNx64 " %16" SCNx64 "%n", &read, &hashes->pixels, &hashes->file, &end) != 3 ||
        read != index || (*text)[end] != '\n')
        return false;
    *text += end + 1;
    return true;
}

/* Whether the frames are as the shard left them. */
static bool whole(void *context, int64_t piece, const char *results, size_t size, bool *there, Error *error) {
    const Ranges *ranges = context;
    const char *text = results;
    *there = true;
    for (int i = first_of(ranges, piece); *there && i <= last_of(ranges, piece); i++) {
        PictureHashes hashes;
        *there = read_line(&text, i, &hashes);
        if (*there && !sink_frame_check(ranges->all.options->directory, i, hashes.file, there, error)) return false;
    }
    *there = *there && text == results + size;
    return true;
}

static bool take_piece(const Ranges *ranges, const Pieces *pieces, int64_t piece, Error *error) {
    Manifest *manifest = ranges->all.manifest;
    size_t size;
    char *results = pieces_read(pieces, piece, &size, NULL, error);
    const char *text = results;
    bool ok = results != NULL;
    for (int i = first_of(ranges, piece); ok && i <= last_of(ranges, piece); i++) {
        ok = read_line(&text, i, &manifest->hashes[i - manifest->first]) ||
             error_input(error, pieces->folder, "the hashes of picture %d have changed", i);
        manifest->known[i - manifest->first] = ok;
    }
    free(results);
    return ok;
}

/* An earlier manifest of the same pictures stays until it is replaced. */
static bool take_all(const Ranges *ranges, const Pieces *pieces, Error *error) {
    char why[256];
    manifest_recall(ranges->all.manifest, why, sizeof why);
    for (int64_t i = 0; i < pieces->plan->count; i++)
        if (!take_piece(ranges, pieces, i, error)) return false;
    return true;
}

bool sequence_pieces_do(const WorkerJob *job, RenderStudy *study, const Progress *progress, Error *error) {
    Pieces *pieces = &study->pieces;
    Ranges ranges;
    plan_ranges(&ranges, job);
    const PiecePlan plan = {.count = (job->last - job->first) / ranges.size + 1,
                            .describe = describe,
                            .work = work,
                            .whole = whole,
                            .context = &ranges};
    study_key_add(study->key, job->manifest->head, strlen(job->manifest->head));
    if (!manifest_check(job->manifest, error) ||
        !pieces_open(pieces, job->options->directory, false, study->key, study->run, error))
        return false;
    if (pieces->mode == PIECES_WHOLE) return true;
    const bool ok =
        pieces_do(pieces, &plan, progress, error) && (pieces->mode == PIECES_SHARD || take_all(&ranges, pieces, error));
    pieces->plan = NULL;
    return ok;
}
