/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a study takes on many cores, from some of its pieces. */
#pragma once
#include "pieces/pieces.h"

typedef struct PiecesEstimate {
    int64_t pieces;
    int measured;          /* of them */
    double seconds, bytes; /* of a piece on one core, on average */
    double longest;        /* seconds of the longest piece, by the measured ones and the weights of the others */
    double together;       /* seconds of the pieces that few shards do not divide */
    double total;          /* seconds of all pieces on one core */
} PiecesEstimate;

enum { PIECES_MEASURED = 32 };

/* Does up to PIECES_MEASURED pieces, spread over the plan, without storing them; begins no more after half a minute. Pieces
   that are done alone are not measured. Processor time, so that other programs do not count. ERROR_INTERRUPTED if progress
   requests a stop. */
bool pieces_estimate(PiecesEstimate *estimate, const PiecePlan *plan, const Progress *progress, Error *error);

/* What takes longest when `cores` cores do a study. */
typedef enum PiecesLimit { LIMIT_COMPUTING, LIMIT_LONGEST, LIMIT_FILES, LIMIT_MERGE, PIECES_LIMITS } PiecesLimit;

extern const char *const pieces_limit_names[PIECES_LIMITS];

/* Seconds of each, in the order of PiecesLimit. The first three happen at the same time, the merge afterwards. files: that
   the shared file system makes or opens in a second. Returns which is the largest. */
PiecesLimit pieces_times(const PiecesEstimate *estimate, int64_t cores, double files, double seconds[PIECES_LIMITS]);
