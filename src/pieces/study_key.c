/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pieces/study_key.h"

#include "common/array.h"
#include "common/file.h"
#include "common/hash.h"

#include <stdlib.h>
#include <string.h>

enum { MAX_SIZE = 1 << 28 };

static void add_hash(StudyKey *key, uint64_t hash) {
    const uint64_t words[2] = {key->value, hash};
    key->value = hash_xxh3(words, sizeof words);
}

void study_key_add(StudyKey *key, const void *data, size_t size) { add_hash(key, hash_xxh3(data, size)); }

static bool hash_file(const char *path, uint64_t *hash, Error *error) {
    size_t size;
    char *data = file_read(path, MAX_SIZE, &size, error);
    if (data == NULL) return false;
    *hash = hash_xxh3(data, size);
    free(data);
    return true;
}

bool study_key_add_input(StudyKey *key, const char *path, uint64_t hash, Error *error) {
    char *copy = strdup(path);
    if (copy == NULL || !array_reserve((void **)&key->inputs, &key->capacity, key->count + 1, sizeof *key->inputs)) {
        free(copy);
        return error_memory(error, path);
    }
    add_hash(key, hash);
    key->inputs[key->count++] = (StudyInput){copy, hash};
    return true;
}

bool study_key_add_file(StudyKey *key, const char *path, Error *error) {
    uint64_t hash;
    return hash_file(path, &hash, error) && study_key_add_input(key, path, hash, error);
}

bool study_key_begin(StudyKey *key, Error *error) {
    *key = (StudyKey){0};
    if (!hash_file("/proc/self/exe", &key->program, error)) return false;
    add_hash(key, key->program);
    return true;
}

void study_key_free(StudyKey *key) {
    for (size_t i = 0; i < key->count; i++) free(key->inputs[i].path);
    free(key->inputs);
    *key = (StudyKey){0};
}
