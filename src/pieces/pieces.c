/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pieces/pieces.h"

#include "common/file.h"
#include "common/standard_io.h"
#include "pieces/study_record.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Many files in one folder make some file systems slow. */
enum { FILES_IN_A_FOLDER = 1000 };

bool pieces_shards_folder(char path[PIECES_PATH_SIZE], const char *output, bool output_is_file, Error *error) {
    return file_path(path, PIECES_PATH_SIZE, error, "%s%sshards", output, output_is_file ? "." : "/");
}

static bool open_whole(Pieces *pieces, const char *output, bool output_is_file, const char *record, Error *error) {
    bool there;
    if (!file_find(record, &there, error)) return false;
    if (there)
        return error_input(error, record,
                           "belongs to shards of a study: merge them (twinbox merge %s), or delete the folder", output);
    return file_path(pieces->folder, sizeof pieces->folder, error, "%s%sparts-%016" PRIx64, output,
                     output_is_file ? "." : "/", pieces->key);
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

static bool record_path(char path[PIECES_PATH_SIZE], const char *output, bool output_is_file, Error *error) {
    char folder[PIECES_PATH_SIZE];
    return pieces_shards_folder(folder, output, output_is_file, error) &&
           file_path(path, PIECES_PATH_SIZE, error, "%s/run.json", folder);
}

bool pieces_find_mode(PiecesMode *mode, const char *output, bool output_is_file, const PiecesRun *run, Error *error) {
    char record[PIECES_PATH_SIZE];
    bool recorded;
    *mode = run != NULL && run->merge ? PIECES_MERGE : PIECES_WHOLE;
    if (run == NULL || run->merge) return true;
    if (!record_path(record, output, output_is_file, error) || !file_find(record, &recorded, error)) return false;
    if (is_shard(run, recorded)) *mode = PIECES_SHARD;
    return true;
}

bool pieces_open(Pieces *pieces, const char *output, bool output_is_file, const StudyKey *key, const PiecesRun *run,
                 Error *error) {
    char record[PIECES_PATH_SIZE];
    *pieces = (Pieces){.shard = {1, 1}, .key = key->value, .run = run};
    if (!pieces_find_mode(&pieces->mode, output, output_is_file, run, error) ||
        !pieces_shards_folder(pieces->folder, output, output_is_file, error) ||
        !record_path(record, output, output_is_file, error))
        return false;
    switch (pieces->mode) {
    case PIECES_SHARD: return open_shard(pieces, output, key, record, error);
    case PIECES_MERGE: return open_merge(pieces, key, record, error);
    case PIECES_WHOLE: break;
    }
    return open_whole(pieces, output, output_is_file, record, error);
}

void pieces_close(Pieces *pieces) { *pieces = (Pieces){0}; }

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
