/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pieces/study_record.h"

#include "common/file.h"
#include "common/json_write.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What is written. */
typedef struct Written {
    const StudyStart *start;
    const char *folder;
} Written;

static void print(FILE *out, const void *context) {
    const Written *written = context;
    const StudyStart *start = written->start;
    const JobArray *array = &start->request->array;
    JsonWriter json = {.out = out};
    json_begin_object(&json, NULL, JSON_LINES);
    json_put_text(&json, "format", STUDY_RECORD_FORMAT);
    json_put_text(&json, "version", TWINBOX_VERSION);
    json_put_hash(&json, "program", start->key->program);
    json_put_hash(&json, "key", start->key->value);
    json_put_int(&json, "shards", start->request->shard.count);
    json_put_int(&json, "array_first", array->first);
    json_put_int(&json, "array_step", array->step);
    json_put_text(&json, "folder", written->folder);
    json_put_text(&json, "output", start->output);
    json_begin_array(&json, "arguments", JSON_ONE_LINE);
    for (int i = 0; i < start->argc; i++) json_put_text(&json, NULL, start->argv[i]);
    json_end(&json);
    json_begin_array(&json, "inputs", JSON_LINES);
    for (size_t i = 0; i < start->key->count; i++) {
        json_begin_object(&json, NULL, JSON_ONE_LINE);
        json_put_text(&json, "file", start->key->inputs[i].path);
        json_put_hash(&json, "hash", start->key->inputs[i].hash);
        json_end(&json);
    }
    json_end(&json);
    json_end(&json);
}

/* file_create() fails if another process was first: that is as good. */
static bool create(const char *path, const char *text, size_t size, Error *error) {
    Error failure = {0};
    bool there;
    if (file_create(path, text, size, &failure)) return true;
    if (failure.kind == ERROR_INPUT && file_find(path, &there, error) && there) return true;
    if (error->kind == ERROR_NONE) *error = failure;
    return false;
}

bool study_record_meet(StudyRecord *record, const char *path, const StudyStart *start, Error *error) {
    char folder[PATH_MAX];
    bool there;
    *record = (StudyRecord){0};
    if (!file_find(path, &there, error)) return false;
    if (there) return study_record_read(record, path, error);
    if (getcwd(folder, sizeof folder) == NULL) return error_system(error, path, "the current folder has no name");
    const Written written = {start, folder};
    size_t size;
    char *text = file_print(print, &written, &size);
    if (text == NULL) return error_memory(error, path);
    const bool fits = size <= STUDY_RECORD_SIZE || error_input(error, path,
                                                               "the command line and its input files are too many for "
                                                               "shards: more than %d bytes",
                                                               STUDY_RECORD_SIZE);
    const bool done = fits && create(path, text, size, error) && study_record_read(record, path, error);
    free(text);
    return done;
}

static bool differs(const char *path, Error *error, const char *what, const char *here, const char *there) {
    return error_input(error, path,
                       "the folder has shards of another study: %s is %s there, %s here. Use another output folder, or "
                       "delete the shards",
                       what, there, here);
}

static bool hash_differs(const char *path, Error *error, const char *what, uint64_t here, uint64_t there) {
    char texts[2][24];
    snprintf(texts[0], sizeof texts[0], "%016llx", (unsigned long long)here);
    snprintf(texts[1], sizeof texts[1], "%016llx", (unsigned long long)there);
    return differs(path, error, what, texts[0], texts[1]);
}

static bool check_inputs(const StudyRecord *record, const char *path, const StudyKey *key, Error *error) {
    char what[PATH_MAX + 32];
    for (size_t i = 0; i < record->key.count && i < key->count; i++) {
        const StudyInput *there = &record->key.inputs[i], *here = &key->inputs[i];
        if (there->hash == here->hash) continue;
        snprintf(what, sizeof what, "the hash of the input %s", here->path);
        return hash_differs(path, error, what, here->hash, there->hash);
    }
    return true;
}

static bool check_arguments(const StudyRecord *record, const char *path, int argc, char **argv, Error *error) {
    const StudyCommand *there = &record->command;
    for (int i = 0; argv != NULL && (i < argc || i < there->argc); i++) {
        const char *mine = i < argc ? argv[i] : "(no more)", *its = i < there->argc ? there->argv[i] : "(no more)";
        if (strcmp(mine, its) != 0) return differs(path, error, "an argument", mine, its);
    }
    return true;
}

bool study_record_check(const StudyRecord *record, const char *path, const StudyKey *key, int argc, char **argv,
                        Error *error) {
    if (key->value == record->key.value) return true;
    if (strcmp(record->version, TWINBOX_VERSION) != 0)
        return differs(path, error, "the version of twinbox", TWINBOX_VERSION, record->version);
    if (key->program != record->key.program)
        return hash_differs(path, error, "the hash of the program", key->program, record->key.program);
    return check_inputs(record, path, key, error) && check_arguments(record, path, argc, argv, error) &&
           hash_differs(path, error, "the hash of options and inputs", key->value, record->key.value);
}

bool study_record_shard(const StudyRecord *record, const char *path, const ShardRequest *request, Shard *shard,
                        Error *error) {
    *shard = (Shard){request->shard.number, record->shards};
    if (request->array.step == 0 || record->array.step == 0)
        return request->shard.count == record->shards ||
               error_input(error, path, "the study was begun in %d shards, and this is one of %d", record->shards,
                           request->shard.count);
    const int64_t beyond = (int64_t)request->array.id - record->array.first;
    shard->number = (int)(beyond / record->array.step) + 1;
    return (beyond >= 0 && beyond % record->array.step == 0 && beyond / record->array.step < record->shards) ||
           error_input(error, path, "the study was begun by the job array %d-%lld:%d, which has no task %d",
                       record->array.first,
                       (long long)record->array.first + (long long)(record->shards - 1) * record->array.step,
                       record->array.step, request->array.id);
}
