/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The file of a finished piece: some lines of text that say what it is, an empty line, then its results. */
#pragma once
#include "common/cpu_name.h"
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

enum { PIECE_NAME_SIZE = 128, PIECE_MAX_SIZE = 1 << 28 };

typedef struct PieceHead {
    uint64_t key;   /* of the study */
    int64_t number; /* of the piece, from 0 */
    char name[PIECE_NAME_SIZE];
    char cpu[CPU_NAME_SIZE]; /* that times were measured on; "": nothing was timed */
} PieceHead;

/* Writes the file atomically, and waits until it is on the disk. */
bool piece_file_write(const char *path, const PieceHead *head, const void *results, size_t size, Error *error);

/* Returns the results, to be freed, with a NUL behind them that *size does not count. NULL with error set: ERROR_INPUT if
   the file is damaged, cut off, or of another study or piece than the head says. The head's cpu is taken from the file. */
char *piece_file_read(const char *path, PieceHead *head, size_t *size, Error *error);
