/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checkpoint of a study: the rows done so far, so that an interrupted study can be resumed. */
#pragma once
#include "study/chart_csv.h"

#include <stdbool.h>
#include <stdint.h>

enum { PART_PATH_SIZE = 4096 };

typedef struct PartFile {
    char path[PART_PATH_SIZE];
    ChartTable done; /* rows of an earlier, interrupted study */
} PartFile;

/* Reads folder/chart-KEY.part.csv if it exists. A file that cannot be read is an error; the user may delete it. */
bool part_file_open(PartFile *part, const char *folder, uint64_t key, Error *error);
void part_file_close(PartFile *part);

/* Looks up the rows whose first has the scene, method and setting of rows[0], and copies them. False if not found. */
bool part_file_find(const PartFile *part, ChartRow *rows, int count);

/* Replaces the file. */
bool part_file_write(const PartFile *part, const ChartRow *rows, int count, Error *error);

/* Deletes the file: the study is complete. */
void part_file_remove(const PartFile *part);
