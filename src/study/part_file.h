/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The finished part of a study on disk, so that an interrupted study can be resumed. */
#pragma once
#include "study/chart_csv.h"

#include <stdbool.h>
#include <stdint.h>

enum { PART_PATH_SIZE = 4096 };

typedef struct PartFile {
    char path[PART_PATH_SIZE];
    ChartTable done; /* rows of the file */
} PartFile;

/* Reads folder/chart-KEY.part.csv if it exists. ERROR_INPUT if it is damaged; the user can delete it. */
bool part_file_open(PartFile *part, const char *folder, uint64_t key, Error *error);
void part_file_close(PartFile *part);

/* Copies the rows of a contender, if the file has them. */
bool part_file_find(const PartFile *part, ChartRow *rows, int count);

/* Replaces the file by these rows. */
bool part_file_write(const PartFile *part, const ChartRow *rows, int count, Error *error);

/* Removes the file: the study is done. */
bool part_file_remove(const PartFile *part, Error *error);
