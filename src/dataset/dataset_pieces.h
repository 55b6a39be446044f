/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A dataset file in pieces (pieces/pieces.h): the rows of some launches each. */
#pragma once
#include "dataset/dataset_record.h"
#include "pieces/piece_ranges.h"
#include "pieces/pieces.h"

/* dataset_pieces_free(). */
typedef struct DatasetPieces {
    DatasetRecording recording;
    PieceRanges launches; /* a group for each scene */
    PiecePlan plan;
} DatasetPieces;

/* Errors as dataset_record(). The options and *pieces must stay where they are. */
bool dataset_pieces_make(DatasetPieces *pieces, const DatasetOptions *options, Error *error);
void dataset_pieces_free(DatasetPieces *pieces);

/* Hashes everything that determines the file. */
bool dataset_pieces_key(const DatasetPieces *pieces, StudyKey *key, Error *error);

/* The number of rows in the results of a piece, which are the arrays of rows one after the other. -1 with error set: the
   results, which are those of the file `path`, are not of these launches. */
int64_t dataset_piece_rows(const DatasetPieces *pieces, int64_t piece, const char *results, size_t size,
                           const char *path, Error *error);

/* Writes the file that dataset_write() writes of dataset_record(), in bounded memory. *rows: in the file. Without rows,
   nothing is written: dataset_check_rows() refuses that. */
bool dataset_pieces_write(const DatasetPieces *pieces, const Pieces *done, const char *path, int64_t *rows,
                          const Progress *progress, Error *error);
