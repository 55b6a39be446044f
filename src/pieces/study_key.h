/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A hash of everything that determines a study's result: pieces of an interrupted study, and of other processes, are used
   only if the key is the same. Beside it, what it was made of, to say what differs. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

typedef struct StudyInput {
    char *path;
    uint64_t hash;
} StudyInput;

/* study_key_free(), also after a failure. */
typedef struct StudyKey {
    uint64_t value, program; /* program: hash of this program's file */
    StudyInput *inputs;      /* [count] the files, in the order in which they were added */
    size_t count, capacity;
} StudyKey;

/* Starts with the hash of this program's file, so that another build does not use the pieces. False with error set if
   the file cannot be read. */
bool study_key_begin(StudyKey *key, Error *error);
void study_key_free(StudyKey *key);

void study_key_add(StudyKey *key, const void *data, size_t size);

/* Adds an input of which the hash is known already. */
bool study_key_add_input(StudyKey *key, const char *path, uint64_t hash, Error *error);

/* Adds the contents of a file. False with error set if it cannot be read. */
bool study_key_add_file(StudyKey *key, const char *path, Error *error);
