/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A long study in parts. The result of each part is saved in a file, so an interrupted study resumes with the first
   unfinished part. A result has lines "TABLE:row"; study_parts_table() collects the rows of each table. */
#pragma once
#include "common/csv_table.h"
#include "common/progress.h"

#include <stdint.h>

enum { STUDY_PARTS_PATH_SIZE = 4096 };

/* Zero-initialise. */
typedef struct StudyParts {
    char folder[STUDY_PARTS_PATH_SIZE];
    const Progress *progress; /* of the whole study; may be changed between parts */
    double done, total;       /* weights of the finished parts and of all parts */
    char *text;               /* results of the finished parts, concatenated */
    size_t size, capacity;
} StudyParts;

typedef struct StudyPart {
    const char *name; /* of its file */
    double weight;    /* relative duration */
    /* Writes the part's lines. `progress` covers this part only. */
    bool (*write)(void *context, FILE *lines, const Progress *progress, Error *error);
    void *context;
} StudyPart;

/* Creates folder/parts-KEY if missing. */
bool study_parts_open(StudyParts *parts, const char *folder, uint64_t key, Error *error);
void study_parts_close(StudyParts *parts);

/* Runs the part unless its file exists. ERROR_INPUT if progress stops it; the part is then not saved. */
bool study_parts_do(StudyParts *parts, const StudyPart *part, Error *error);

/* Writes a row as such a line; the table's name is the layout's. Errors as csv_row_print(). */
bool study_parts_print(FILE *lines, const CsvLayout *layout, const void *row, Error *error);

/* Writes folder/TABLE.csv: the header and the table's rows in the order of the parts. */
bool study_parts_table(const StudyParts *parts, const char *folder, const CsvLayout *layout, Error *error);

/* Deletes the saved parts: the study is complete. */
void study_parts_remove(const StudyParts *parts);
