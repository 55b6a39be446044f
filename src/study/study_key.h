/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A hash of everything that determines a study's result. An interrupted study is resumed only if the key is the
   same. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

/* Starts with the hash of this program's file, so that another build does not resume the study. False with error set if
   the file cannot be read. */
bool study_key_begin(uint64_t *key, Error *error);

void study_key_add(uint64_t *key, const void *data, size_t size);

/* Adds the contents of a file. False with error set if it cannot be read. */
bool study_key_add_file(uint64_t *key, const char *path, Error *error);
