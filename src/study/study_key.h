/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A number for all that decides a study's result: one that was cut off is gone on with only where it is the same. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

/* Begins with this program's own file: results of another build are not gone on with. False where it cannot be read. */
bool study_key_begin(uint64_t *key, Error *error);

void study_key_add(uint64_t *key, const void *data, size_t size);

/* Adds what a file holds. False with error set where it cannot be read. */
bool study_key_add_file(uint64_t *key, const char *path, Error *error);
