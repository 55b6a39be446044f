/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What studies in pieces (runs/pieces.h) share: keys of scenes, and tables from the results of pieces. */
#pragma once
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "runs/pieces.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Hashes a scene's file and its networks. A missing network is an error only of the method that needs it. */
bool study_key_add_scene(StudyKey *key, const char *path, Error *error);

/* Tables from the pieces of a study (runs/pieces.h). The results of a piece are lines "TABLE:row", or
   "TABLE/SECTION:row"; the rows of a table are put together in the order of the pieces. Lines that begin with "#" are
   the study's own notes, which no table has. */

/* Pieces that follow each other and whose rows are sorted by their section: a map has a piece for each cell, and its
   table has a section for each method. */
typedef struct PieceGroup {
    int64_t first, count;
    int sections; /* 0: the rows have none */
} PieceGroup;

/* Writes a row as such a line; the table's name is the layout's. section: -1: none. Errors as csv_row_print(). */
bool piece_tables_print(FILE *results, const CsvLayout *layout, int section, const void *row, Error *error);

/* Writes folder/TABLE.csv of each layout: the header and the table's rows. groups[group_count] cover all pieces; NULL:
   one without sections. Reads each piece once; memory: the results of all. */
bool piece_tables_write(const Pieces *pieces, const char *folder, const CsvLayout *const *layouts, int layout_count,
                        const PieceGroup *groups, int group_count, Error *error);
