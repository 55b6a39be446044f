/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A long study in parts. Each finished part is stored in a file, so that an interrupted study can be resumed at the
   part that it was working on. A part's text has lines "TABLE:row"; the tables are assembled from them at the end. */
#pragma once
#include "common/progress.h"
#include "csv/csv_table.h"

#include <stdint.h>

enum { STUDY_PARTS_PATH_SIZE = 4096 };

/* Zero-initialise. */
typedef struct StudyParts {
    char folder[STUDY_PARTS_PATH_SIZE];
    const Progress *progress; /* of all parts together; may be changed between parts */
    double done, total;       /* weights of the parts done, and of all */
    char *text;               /* of the finished parts, concatenated */
    size_t size, capacity;
} StudyParts;

typedef struct StudyPart {
    const char *name; /* and file name */
    double weight;    /* its share of the time */
    /* Writes the part's lines. progress is of this part alone. */
    bool (*write)(void *context, FILE *lines, const Progress *progress, Error *error);
    void *context;
} StudyPart;

/* Creates folder/parts-KEY if it is missing. */
bool study_parts_open(StudyParts *parts, const char *folder, uint64_t key, Error *error);
void study_parts_close(StudyParts *parts);

/* Does the part, unless its file exists. ERROR_INTERRUPTED if progress requests a stop; the part is not kept then. */
bool study_parts_do(StudyParts *parts, const StudyPart *part, Error *error);

/* Writes a row as such a line; the table's name is the layout's. Errors as csv_row_print(). */
bool study_parts_print(FILE *lines, const CsvLayout *layout, const void *row, Error *error);

/* Writes folder/TABLE.csv: the header and the table's rows in the order of the parts. */
bool study_parts_table(const StudyParts *parts, const char *folder, const CsvLayout *layout, Error *error);

/* Removes the stored parts: the study is done. ERROR_SYSTEM if any is left. */
bool study_parts_remove(const StudyParts *parts, Error *error);
