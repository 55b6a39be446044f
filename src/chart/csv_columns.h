/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Some of a table's columns, found by their names, as an array of structs. */
#pragma once
#include "common/error.h"

#include <stddef.h>

enum { CSV_NAME_SIZE = 40, CSV_TEXT_SIZE = 128, CSV_MAX_ROWS = 5000, CSV_MAX_COLUMNS = 16 };

/* What a field is, and the member of the struct that takes it. */
typedef enum CsvKind {
    CSV_NAME,   /* char[CSV_NAME_SIZE]: plain as of chart_plain(), so that no name can be more than one to gnuplot */
    CSV_TEXT,   /* char[CSV_TEXT_SIZE]: as it is */
    CSV_WORD,   /* int: which of a list of words */
    CSV_NUMBER, /* double in [minimum, maximum] */
    CSV_MAYBE   /* the same, or NAN where the field is empty */
} CsvKind;

typedef struct CsvColumn {
    const char *name;
    CsvKind kind;
    size_t offset;
    const char *const *words; /* of CSV_WORD; ends in NULL */
    double minimum, maximum;
} CsvColumn;

/* Reads column_count (at most CSV_MAX_COLUMNS) columns of folder/file.csv: for each of its *row_count lines a struct of
   struct_size bytes, in the file's order; the caller frees them. Other columns are left alone. NULL with error
   "path:line:column: error: text" for a column that is missing or there twice, a field that is not of its kind, more
   than max_rows lines or a table that is not in order (common/csv.h; so is one without a line). */
void *csv_columns_read(const char *folder, const char *file, const CsvColumn *columns, int column_count,
                       size_t struct_size, int max_rows, int *row_count, Error *error);
