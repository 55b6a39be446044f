/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pieces that a merge does not find, and the shards that are to do them. */
#pragma once
#include "pieces/pieces.h"

enum { MISSING_NAMED = 5 };

/* Begin with the first two members; pieces_missing_free(). */
typedef struct PiecesMissing {
    const Pieces *pieces;
    const PiecePlan *plan;
    int64_t count;
    char names[MISSING_NAMED][PIECE_NAME_SIZE]; /* the first of them */
    unsigned char *shards; /* [shards of the study] whether it has missing pieces; NULL: no memory */
} PiecesMissing;

void pieces_missing_add(PiecesMissing *missing, const PieceInfo *info);
void pieces_missing_free(PiecesMissing *missing);

/* ERROR_INCOMPLETE if there are any. */
bool pieces_missing_refuse(const PiecesMissing *missing, Error *error);

/* "3,17-20": these shards, or the ids that a job array gave them; to be freed. NULL when memory is short. */
char *pieces_shard_list(const unsigned char *shards, int count, const JobArray *array);
