/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Work in pieces: their files, their locks, and the pieces that a shard does. */
#include "runs/pieces.h"

#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/machine.h"
#include "runs/runs_internal.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { HEAD_SIZE = 512 };

/* Everything before the results. The same head and results have one text, which is compared when it is read. */
static int print_head(char text[HEAD_SIZE], const PieceHead *head, const void *results, size_t size) {
    return snprintf(text, HEAD_SIZE,
                    "twinbox piece 1\nkey %016" PRIx64 "\nnumber %" PRId64
                    "\nname %s\ncpu %s\nbytes %zu\nhash %016" PRIx64 "\n\n",
                    head->key, head->number, head->name, head->cpu, size, hash_xxh3(results, size));
}

bool piece_file_write(const char *path, const PieceHead *head, const void *results, size_t size, Error *error) {
    char text[HEAD_SIZE];
    if (size > PIECE_MAX_SIZE - HEAD_SIZE)
        return error_system(error, path, "the results of '%s' are too large: %zu bytes", head->name, size);
    const size_t length = (size_t)print_head(text, head, results, size);
    char *whole = malloc(length + size);
    if (whole == NULL) return error_memory(error, path);
    memcpy(whole, text, length);
    if (size > 0) memcpy(whole + length, results, size);
    const bool done = file_write(path, whole, length + size, error);
    free(whole);
    return done;
}

/* Copies the rest of the line "cpu ..." of a head. */
static void find_cpu(const char *text, char cpu[CPU_NAME_SIZE]) {
    const char *line = strstr(text, "\ncpu ");
    cpu[0] = '\0';
    if (line == NULL) return;
    line += strlen("\ncpu ");
    snprintf(cpu, CPU_NAME_SIZE, "%.*s", (int)strcspn(line, "\n"), line);
}

/* Whether the study is another, to say so. */
static bool pieces_refuse(const char *path, const char *text, const PieceHead *head, Error *error) {
    unsigned long long key;
    char name[PIECE_NAME_SIZE];
    if (sscanf(text, "twinbox piece 1\nkey %16llx\n", &key) != 1)
        return error_input(error, path, "is not a piece of a study; delete it");
    if (key != head->key)
        return error_input(error, path, "is a piece of another study (key %016llx, not %016llx); delete it", key,
                           (unsigned long long)head->key);
    if (sscanf(text, "twinbox piece 1\nkey %*16x\nnumber %*d\nname %127[^\n]", name) == 1 &&
        strcmp(name, head->name) != 0)
        return error_input(error, path, "is the piece '%s', not '%s'; delete it", name, head->name);
    return error_input(error, path, "is damaged or cut off; delete it, and its shard does it again");
}

char *piece_file_read(const char *path, PieceHead *head, size_t *size, Error *error) {
    char expected[HEAD_SIZE];
    size_t whole;
    char *text = file_read(path, PIECE_MAX_SIZE, &whole, error);
    if (text == NULL) return NULL;
    const char *end = strstr(text, "\n\n");
    const size_t length = end != NULL ? (size_t)(end - text) + strlen("\n\n") : whole;
    find_cpu(text, head->cpu);
    *size = whole - length;
    const size_t wanted = (size_t)print_head(expected, head, text + length, *size);
    if (end == NULL || length != wanted || memcmp(expected, text, length) != 0) {
        pieces_refuse(path, text, head, error);
        free(text);
        return NULL;
    }
    memmove(text, text + length, *size + 1);
    return text;
}

/* Many files in one folder make some file systems slow. */
enum { FILES_IN_A_FOLDER = 1000 };

bool pieces_record_path(char path[PIECES_PATH_SIZE], const char *output, Error *error) {
    return file_path(path, PIECES_PATH_SIZE, error, "%s/shards/run.json", output);
}

static bool open_whole(Pieces *pieces, const char *output, const char *record, Error *error) {
    bool there;
    if (!file_find(record, &there, error)) return false;
    if (there)
        return error_input(error, record,
                           "belongs to shards of a study: merge them (twinbox merge %s), or delete the folder", output);
    return file_path(pieces->folder, sizeof pieces->folder, error, "%s/parts-%016" PRIx64, output, pieces->key);
}

/* The other shards and the merge read the same files. */
static bool check_inputs(const StudyKey *key, Error *error) {
    for (size_t i = 0; i < key->count; i++)
        if (path_is_standard(key->inputs[i].path))
            return error_input(error, "--shard", "a merge cannot read standard input again; give the name of a file");
    return true;
}

static bool open_shard(Pieces *pieces, const char *output, const StudyKey *key, const char *path, Error *error) {
    const PiecesRun *run = pieces->run;
    const StudyStart start = {key, &run->request, output, run->argc, run->argv};
    StudyRecord record = {0};
    const bool done = check_inputs(key, error) && file_make_directory(pieces->folder, error) &&
                      study_record_meet(&record, path, &start, error) &&
                      study_record_check(&record, path, key, run->argc, run->argv, error) &&
                      study_record_shard(&record, path, &run->request, &pieces->shard, error);
    pieces->array = record.array;
    study_record_free(&record);
    return done;
}

static bool open_merge(Pieces *pieces, const StudyKey *key, const char *path, Error *error) {
    StudyRecord record;
    const bool done = study_record_read(&record, path, error) && study_record_check(&record, path, key, 0, NULL, error);
    pieces->shard = (Shard){1, record.shards};
    pieces->array = record.array;
    study_record_free(&record);
    return done;
}

/* A job array of one task is the whole study, unless it retries a task of a larger one. */
static bool is_shard(const PiecesRun *run, bool recorded) {
    return run->request.shard.count > 1 || (run->request.array.step > 0 && recorded);
}

bool pieces_find_mode(PiecesMode *mode, const char *output, const PiecesRun *run, Error *error) {
    char record[PIECES_PATH_SIZE];
    bool recorded;
    *mode = run != NULL && run->merge ? PIECES_MERGE : PIECES_WHOLE;
    if (run == NULL || run->merge) return true;
    if (!pieces_record_path(record, output, error) || !file_find(record, &recorded, error)) return false;
    if (is_shard(run, recorded)) *mode = PIECES_SHARD;
    return true;
}

bool pieces_open(Pieces *pieces, const char *output, const StudyKey *key, const PiecesRun *run, Error *error) {
    char record[PIECES_PATH_SIZE];
    *pieces = (Pieces){.shard = {1, 1}, .key = key->value, .run = run};
    if (!pieces_find_mode(&pieces->mode, output, run, error) ||
        !file_path(pieces->folder, sizeof pieces->folder, error, "%s/shards", output) ||
        !pieces_record_path(record, output, error))
        return false;
    switch (pieces->mode) {
    case PIECES_SHARD: return open_shard(pieces, output, key, record, error);
    case PIECES_MERGE: return open_merge(pieces, key, record, error);
    case PIECES_WHOLE: break;
    }
    return open_whole(pieces, output, record, error);
}

bool pieces_path(const Pieces *pieces, int64_t piece, char path[PIECES_PATH_SIZE], Error *error) {
    return file_path(path, PIECES_PATH_SIZE, error, "%s/%04lld/%07lld", pieces->folder,
                     (long long)(piece / FILES_IN_A_FOLDER), (long long)piece);
}

PieceInfo piece_describe(const PiecePlan *plan, int64_t piece) {
    PieceInfo info = {.with = piece, .near = -1};
    plan->describe(plan->context, piece, &info);
    return info;
}

int piece_shard(const PieceInfo *info, int64_t pieces, int shards) {
    const bool together = info->near >= 0 && shards <= PIECES_NEAR_SHARDS;
    return shard_of(together ? info->near : info->with, pieces, shards);
}

void pieces_head(const Pieces *pieces, int64_t piece, PieceHead *head) {
    const PieceInfo info = piece_describe(pieces->plan, piece);
    *head = (PieceHead){.key = pieces->key, .number = piece};
    memcpy(head->name, info.name, sizeof head->name);
    if (info.timed) cpu_name(head->cpu);
}

char *pieces_read(const Pieces *pieces, int64_t piece, size_t *size, char cpu[CPU_NAME_SIZE], Error *error) {
    char path[PIECES_PATH_SIZE];
    PieceHead head;
    pieces_head(pieces, piece, &head);
    if (!pieces_path(pieces, piece, path, error)) return NULL;
    char *results = piece_file_read(path, &head, size, error);
    if (results != NULL && cpu != NULL) memcpy(cpu, head.cpu, sizeof head.cpu);
    return results;
}

bool pieces_find(const Pieces *pieces, int64_t piece, bool *done, char cpu[CPU_NAME_SIZE], Error *error) {
    const PiecePlan *plan = pieces->plan;
    char path[PIECES_PATH_SIZE];
    *done = false;
    if (cpu != NULL) cpu[0] = '\0';
    if (!pieces_path(pieces, piece, path, error) || !file_find(path, done, error)) return false;
    if (!*done) return true;
    size_t size;
    char *results = pieces_read(pieces, piece, &size, cpu, error);
    if (results == NULL) return false;
    const bool known = plan->whole == NULL || plan->whole(plan->context, piece, results, size, done, error);
    if (cpu != NULL && !*done) cpu[0] = '\0';
    free(results);
    return known;
}

bool pieces_keep_times(const Pieces *pieces, const char *cpu) {
    return pieces->run == NULL || !pieces->run->times_first || strcmp(cpu, pieces->cpu) == 0;
}

/* Removes a folder and its files; deeper folders are removed before. */
static bool remove_folder(const char *path, Error *error) {
    DIR *folder = opendir(path);
    if (folder == NULL) return errno == ENOENT || error_system(error, path, "cannot be read: %s", strerror(errno));
    const struct dirent *entry;
    bool done = true;
    errno = 0; /* readdir() returns NULL at the end and on failure */
    while (done && (entry = readdir(folder)) != NULL) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        done = unlinkat(dirfd(folder), entry->d_name, 0) == 0 ||
               error_system(error, path, "%s cannot be removed: %s", entry->d_name, strerror(errno));
    }
    if (done && errno != 0) done = error_system(error, path, "cannot be read: %s", strerror(errno));
    closedir(folder);
    return done && (rmdir(path) == 0 || error_system(error, path, "cannot be removed: %s", strerror(errno)));
}

bool pieces_end(const Pieces *pieces, Error *error) {
    char path[PIECES_PATH_SIZE];
    if (pieces->mode != PIECES_WHOLE) return true;
    for (int64_t i = 0; i < pieces->plan->count; i += FILES_IN_A_FOLDER)
        if (!file_path(path, sizeof path, error, "%s/%04lld", pieces->folder, (long long)(i / FILES_IN_A_FOLDER)) ||
            !remove_folder(path, error))
            return false;
    return remove_folder(pieces->folder, error);
}

/* Doing the pieces of a process, and checking those of all. */

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

static bool pieces_report(void *context, double done, double total) {
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
static bool pieces_store(const Pieces *pieces, int64_t piece, const char *results, size_t size, Error *error) {
    char path[PIECES_PATH_SIZE], folder[PIECES_PATH_SIZE];
    PieceHead head;
    pieces_head(pieces, piece, &head);
    if (!pieces_path(pieces, piece, path, error)) return false;
    snprintf(folder, sizeof folder, "%.*s", (int)file_folder_length(path), path);
    return file_make_directory(folder, error) && piece_file_write(path, &head, results, size, error);
}

static bool pieces_work(Doing *doing, int64_t piece, PieceProgress *own, Error *error) {
    const Progress progress = {pieces_report, own};
    char *results = NULL;
    size_t size = 0;
    FILE *stream = memory_stream(&results, &size);
    if (stream == NULL) return error_memory(error, "piece");
    bool ok = doing->plan->work(doing->plan->context, piece, stream, &progress, error);
    if (ferror(stream) && ok) ok = error_memory(error, "piece");
    if (fclose(stream) != 0 && ok) ok = error_memory(error, "piece");
    ok = ok && pieces_store(doing->pieces, piece, results, size, error);
    free(results);
    return ok;
}

static bool do_piece(void *context, int i, Error *error) {
    Doing *doing = context;
    const PieceInfo info = piece_describe(doing->plan, doing->batch[i]);
    PieceProgress own = {doing, info.weight, 0};
    Error failure = {0};
    if (pieces_work(doing, doing->batch[i], &own, &failure) && pieces_report(&own, 1, 1)) return true;
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
