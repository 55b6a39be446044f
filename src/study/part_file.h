/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a study has done so far, on disk, so that it can go on where it was cut off. */
#pragma once
#include "study/chart_csv.h"

#include <stdbool.h>
#include <stdint.h>

enum { PART_PATH_SIZE = 4096 };

typedef struct PartFile {
    char path[PART_PATH_SIZE];
    ChartTable done; /* rows found there */
} PartFile;

/* Looks for folder/chart-KEY.part.csv. One that cannot be read is an error: it says so, and can be deleted. */
bool part_file_open(PartFile *part, const char *folder, uint64_t key, Error *error);
void part_file_close(PartFile *part);

/* Copies the rows of a contender, if they are there. */
bool part_file_find(const PartFile *part, ChartRow *rows, int count);

/* Puts these rows in place of what is on disk. */
bool part_file_write(const PartFile *part, const ChartRow *rows, int count, Error *error);

/* The study is done. */
void part_file_remove(const PartFile *part);
