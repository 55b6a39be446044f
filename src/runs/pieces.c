/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Work in pieces: the key of a study, the files of its pieces, and the pieces that a process does. */
#include "runs/pieces.h"

#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/machine.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Bytes of an input, of a piece, and of what stands before a piece's results. */
enum { INPUT_MAX_SIZE = 1 << 28, PIECE_MAX_SIZE = 1 << 28, HEAD_SIZE = 512 };

/* Many files in one folder make some file systems slow. */
enum { FILES_IN_A_FOLDER = 1000 };

void study_key_add(StudyKey *key, const void *data, size_t size) {
    const uint64_t words[2] = {key->value, hash_xxh3(data, size)};
    key->value = hash_xxh3(words, sizeof words);
}

bool study_key_add_file(StudyKey *key, const char *path, Error *error) {
    size_t size;
    char *data = file_read(path, INPUT_MAX_SIZE, &size, error);
    if (data == NULL) return false;
    study_key_add(key, data, size);
    free(data);
    return true;
}

bool study_key_begin(StudyKey *key, Error *error) {
    *key = (StudyKey){0};
    if (study_key_add_file(key, "/proc/self/exe", error)) return true;
    error->kind = ERROR_SYSTEM; /* no input of the user's */
    return false;
}

bool pieces_open(Pieces *pieces, const char *output, const StudyKey *key, const Shard *shard, Error *error) {
    *pieces = (Pieces){.shard = *shard, .key = key->value};
    return (shard->count > 0 || folder_reserve(output, error)) &&
           file_path(pieces->folder, sizeof pieces->folder, error, "%s/parts-%016" PRIx64, output, pieces->key);
}

bool pieces_path(const Pieces *pieces, int64_t piece, char path[PIECES_PATH_SIZE], Error *error) {
    return file_path(path, PIECES_PATH_SIZE, error, "%s/%04lld/%07lld", pieces->folder,
                     (long long)(piece / FILES_IN_A_FOLDER), (long long)piece);
}

static PieceInfo describe(const PiecePlan *plan, int64_t piece) {
    PieceInfo info = {.weight = 0};
    plan->describe(plan->context, piece, &info);
    return info;
}

/* Everything before the results. The same head and results have one text, which is compared when it is read. */
static size_t print_head(char text[HEAD_SIZE], const Pieces *pieces, int64_t piece, const char *cpu,
                         const void *results, size_t size) {
    return (size_t)snprintf(
        text, HEAD_SIZE,
        "twinbox piece 1\nkey %016" PRIx64 "\nnumber %" PRId64 "\nname %s\ncpu %s\nbytes %zu\nhash %016" PRIx64 "\n\n",
        pieces->key, piece, describe(pieces->plan, piece).name, cpu, size, hash_xxh3(results, size));
}

static bool store(const Pieces *pieces, int64_t piece, const char *results, size_t size, Error *error) {
    char path[PIECES_PATH_SIZE], folder[PIECES_PATH_SIZE], head[HEAD_SIZE], cpu[CPU_NAME_SIZE] = "";
    const PieceInfo info = describe(pieces->plan, piece);
    if (!pieces_path(pieces, piece, path, error)) return false;
    if (size > PIECE_MAX_SIZE - HEAD_SIZE)
        return error_system(error, path, "the results of '%s' are too large: %zu bytes", info.name, size);
    if (info.timed) cpu_name(cpu);
    const size_t length = print_head(head, pieces, piece, cpu, results, size);
    char *whole = malloc(length + size);
    if (whole == NULL) return error_memory(error, path);
    memcpy(whole, head, length);
    if (size > 0) memcpy(whole + length, results, size);
    snprintf(folder, sizeof folder, "%.*s", (int)file_folder_length(path), path);
    const bool done = file_make_directory(folder, error) && file_write(path, whole, length + size, error);
    free(whole);
    return done;
}

/* Says whether the file is of another study or piece, or damaged. */
static bool refuse(const Pieces *pieces, int64_t piece, const char *path, const char *text, Error *error) {
    unsigned long long key;
    char name[PIECE_NAME_SIZE];
    const PieceInfo info = describe(pieces->plan, piece);
    if (sscanf(text, "twinbox piece 1\nkey %16llx\n", &key) != 1)
        return error_input(error, path, "is not a piece of a study; delete it");
    if (key != pieces->key)
        return error_input(error, path, "is a piece of another study (key %016llx, not %016llx); delete it", key,
                           (unsigned long long)pieces->key);
    if (sscanf(text, "twinbox piece 1\nkey %*16x\nnumber %*d\nname %127[^\n]", name) == 1 &&
        strcmp(name, info.name) != 0)
        return error_input(error, path, "is the piece '%s', not '%s'; delete it", name, info.name);
    return error_input(error, path, "is damaged or cut off; delete it, and run the command again");
}

char *pieces_read(const Pieces *pieces, int64_t piece, size_t *size, char cpu[CPU_NAME_SIZE], Error *error) {
    char path[PIECES_PATH_SIZE], expected[HEAD_SIZE], read_cpu[CPU_NAME_SIZE] = "";
    size_t whole;
    char *text = pieces_path(pieces, piece, path, error) ? file_read(path, PIECE_MAX_SIZE, &whole, error) : NULL;
    if (text == NULL) return NULL;
    const char *end = strstr(text, "\n\n"), *line = strstr(text, "\ncpu ");
    if (line != NULL) {
        line += strlen("\ncpu ");
        snprintf(read_cpu, sizeof read_cpu, "%.*s", (int)strcspn(line, "\n"), line);
    }
    const size_t length = end != NULL ? (size_t)(end - text) + strlen("\n\n") : whole;
    *size = whole - length;
    const size_t wanted = print_head(expected, pieces, piece, read_cpu, text + length, *size);
    if (end == NULL || length != wanted || memcmp(expected, text, length) != 0) {
        refuse(pieces, piece, path, text, error);
        free(text);
        return NULL;
    }
    if (cpu != NULL) memcpy(cpu, read_cpu, sizeof read_cpu);
    memmove(text, text + length, *size + 1);
    return text;
}

bool pieces_find(const Pieces *pieces, int64_t piece, bool *done, Error *error) {
    const PiecePlan *plan = pieces->plan;
    char path[PIECES_PATH_SIZE];
    *done = false;
    if (!pieces_path(pieces, piece, path, error) || !file_find(path, done, error)) return false;
    if (!*done) return true;
    size_t size;
    char *results = pieces_read(pieces, piece, &size, NULL, error);
    const bool known =
        results != NULL && (plan->whole == NULL || plan->whole(plan->context, piece, results, size, done, error));
    free(results);
    return known;
}

/* Doing the pieces of a process. */

typedef struct Doing {
    Pieces *pieces;
    const PiecePlan *plan;
    const Progress *progress;
    double done, total; /* weights */
    bool stopped;
    int *todo; /* [together + alone] pieces: those done on several threads, then those done alone */
    int together, alone;
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

static bool do_piece(void *context, int i, Error *error) {
    Doing *doing = context;
    const PiecePlan *plan = doing->plan;
    const int piece = doing->todo[i];
    const PieceInfo info = describe(plan, piece);
    PieceProgress own = {doing, info.weight, 0};
    char *results = NULL;
    size_t size = 0;
    Error failure = {0};
    FILE *stream = memory_stream(&results, &size);
    if (stream == NULL) return error_memory(error, info.name);
    bool ok = plan->work(plan->context, piece, stream, &(Progress){report, &own}, &failure);
    if (ferror(stream) && ok) ok = error_memory(&failure, info.name);
    if (fclose(stream) != 0 && ok) ok = error_memory(&failure, info.name);
    ok = ok && store(doing->pieces, piece, results, size, &failure);
    free(results);
    if (ok && report(&own, 1, 1)) return true;
    if (failure.kind == ERROR_NONE || failure.kind == ERROR_INTERRUPTED)
        return error_interrupted(error, info.name, "stopped; finished pieces are kept");
    *error = failure;
    return false;
}

/* Lists what is to be done of the process's pieces. */
static bool list(Doing *doing, Error *error) {
    Pieces *pieces = doing->pieces;
    const PiecePlan *plan = doing->plan;
    const Shard *shard = &pieces->shard;
    const int count = (int)plan->count;
    int *alone = malloc(((size_t)count + 1) * sizeof *alone);
    doing->todo = malloc(((size_t)count + 1) * sizeof *doing->todo);
    bool ok = (alone != NULL && doing->todo != NULL) || error_memory(error, "study");
    for (int i = shard->count > 0 ? shard->number - 1 : 0; ok && i<count; i += shard->count> 0 ? shard->count : 1) {
        const PieceInfo info = describe(plan, i);
        bool done;
        ok = pieces_find(pieces, i, &done, error);
        pieces->own++;
        pieces->kept += done;
        if (!ok || done) continue;
        if (shard->count > 0 && info.timed) {
            pieces->left++;
            continue;
        }
        doing->total += info.weight;
        if (info.alone)
            alone[doing->alone++] = i;
        else
            doing->todo[doing->together++] = i;
    }
    if (ok && doing->alone > 0) memcpy(doing->todo + doing->together, alone, (size_t)doing->alone * sizeof *alone);
    free(alone);
    return ok;
}

bool pieces_do(Pieces *pieces, const PiecePlan *plan, const Progress *progress, Error *error) {
    if (plan->count > PIECES_MAX)
        return error_input(error, pieces->folder, "the study has %" PRId64 " pieces; at most %d are allowed",
                           plan->count, PIECES_MAX);
    Doing doing = {.pieces = pieces, .plan = plan, .progress = progress};
    pieces->plan = plan;
    bool ok = list(&doing, error);
    /* Many pieces: a thread for each. Few: all threads for each, as far as the piece itself uses them. */
    if (ok && doing.together >= 2 * omp_get_max_threads())
        ok = parallel_for(&(ParallelWork){do_piece, &doing}, doing.together, "study", NULL, error);
    else
        for (int i = 0; ok && i < doing.together; i++) ok = do_piece(&doing, i, error);
    for (int i = doing.together; ok && i < doing.together + doing.alone; i++) {
        if (pieces->shard.count > 0 && plan->ready != NULL && !plan->ready(plan->context, doing.todo[i]))
            pieces->left++;
        else
            ok = do_piece(&doing, i, error);
    }
    free(doing.todo);
    return ok;
}

/* Removes a folder and its files; deeper folders are removed before. One into which a shard still writes stays. */
static bool remove_folder(const char *path, Error *error) {
    DIR *folder = opendir(path);
    if (folder == NULL) return errno == ENOENT || error_system(error, path, "cannot be read: %s", strerror(errno));
    const struct dirent *entry;
    bool done = true;
    errno = 0; /* readdir() returns NULL at the end and on failure */
    while (done && (entry = readdir(folder)) != NULL) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        done = unlinkat(dirfd(folder), entry->d_name, 0) == 0 || errno == ENOENT || errno == EISDIR ||
               error_system(error, path, "%s cannot be removed: %s", entry->d_name, strerror(errno));
        errno = 0;
    }
    if (done && errno != 0) done = error_system(error, path, "cannot be read: %s", strerror(errno));
    closedir(folder);
    return done && (rmdir(path) == 0 || errno == ENOTEMPTY || errno == ENOENT ||
                    error_system(error, path, "cannot be removed: %s", strerror(errno)));
}

bool pieces_end(const Pieces *pieces, Error *error) {
    char path[PIECES_PATH_SIZE];
    for (int64_t i = 0; i < pieces->plan->count; i += FILES_IN_A_FOLDER)
        if (!file_path(path, sizeof path, error, "%s/%04lld", pieces->folder, (long long)(i / FILES_IN_A_FOLDER)) ||
            !remove_folder(path, error))
            return false;
    return remove_folder(pieces->folder, error);
}
