/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A long study as parts, one after the other, each kept in a file of its own once it is done: a study that is cut off
   goes on with the part that was in hand. A part's text has lines "TABLE:row", by which the tables are put together at
   the end. */
#pragma once
#include "common/csv_table.h"
#include "common/progress.h"

#include <stdint.h>

enum { STUDY_PARTS_PATH_SIZE = 4096 };

/* Zero-initialise. */
typedef struct StudyParts {
    char folder[STUDY_PARTS_PATH_SIZE];
    const Progress *progress; /* of the parts together; may be changed between them */
    double done, total;       /* weights of the parts done, and of all */
    char *text;               /* of the parts done, one after the other */
    size_t size, capacity;
} StudyParts;

typedef struct StudyPart {
    const char *name; /* of its file */
    double weight;    /* how long it takes beside other parts */
    /* Writes the part's lines. progress is of this part alone. */
    bool (*write)(void *context, FILE *lines, const Progress *progress, Error *error);
    void *context;
} StudyPart;

/* Makes folder/parts-KEY where it is missing. */
bool study_parts_open(StudyParts *parts, const char *folder, uint64_t key, Error *error);
void study_parts_close(StudyParts *parts);

/* Does the part, unless its file is there. ERROR_INPUT where progress asks to stop: the part is not kept then. */
bool study_parts_do(StudyParts *parts, const StudyPart *part, Error *error);

/* Writes a row as such a line; the table's name is the layout's. Errors as csv_row_print(). */
bool study_parts_print(FILE *lines, const CsvLayout *layout, const void *row, Error *error);

/* Writes folder/TABLE.csv: the header, and all rows of that table in the order of the parts. */
bool study_parts_table(const StudyParts *parts, const char *folder, const CsvLayout *layout, Error *error);

/* The study is done: removes what was kept. */
void study_parts_remove(const StudyParts *parts);
