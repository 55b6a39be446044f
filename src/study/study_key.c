/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/study_key.h"

#include "common/file.h"
#include "common/hash.h"

#include <stdlib.h>

enum { MAX_SIZE = 1 << 28 };

void study_key_add(uint64_t *key, const void *data, size_t size) {
    uint64_t words[2] = {*key, hash_xxh3(data, size)};
    *key = hash_xxh3(words, sizeof words);
}

bool study_key_add_file(uint64_t *key, const char *path, Error *error) {
    size_t size;
    char *data = file_read(path, MAX_SIZE, &size, error);
    if (data == NULL) return false;
    study_key_add(key, data, size);
    free(data);
    return true;
}

bool study_key_begin(uint64_t *key, Error *error) {
    *key = 0;
    return study_key_add_file(key, "/proc/self/exe", error);
}
