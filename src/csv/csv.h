/* SPDX-License-Identifier: GPL-3.0-or-later */
/* CSV files (RFC 4180): a header line, then rows with the same number of fields. Fields are separated by commas. A field
   in double quotes may contain commas and doubled quotes. Typed rows: csv/csv_table.h. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdio.h>

typedef struct CsvField {
    const char *text; /* without its quotes */
    int column;       /* in the line, in characters from 1 */
} CsvField;

typedef struct Csv {
    char *path;
    int width;        /* fields of each line */
    int rows;         /* lines, the header included: row 0; row i is line i + 1 */
    CsvField *fields; /* [rows][width] */
    char *text;       /* that the fields point into */
} Csv;

/* Reads a file of at most max_size bytes with min_rows (0 or 1) to max_rows lines after the header. Line ends are LF or
   CRLF; a byte order mark is dropped. Refused, with path:line:column: control characters (so no field contains a line
   end), empty lines, lines with more or fewer fields than the header, stray quotes. On failure nothing is to be freed. */
bool csv_read(Csv *csv, const char *path, size_t max_size, int min_rows, int max_rows, Error *error);
void csv_free(Csv *csv);

const char *csv_text(const Csv *csv, int row, int field);

/* Sets an input error "path:line:column: error: text". Returns false. */
bool csv_error(const Csv *csv, int row, int field, Error *error, const char *format, ...) PRINTF_LIKE(5, 6);

/* A text for a message: all but printable ASCII becomes '?', and a long text ends in "...". */
typedef struct CsvShown {
    char text[48];
} CsvShown;
CsvShown csv_show(const char *text);

/* Writes a field, in quotes if it needs them or `quoted` is set. */
void csv_put(FILE *file, const char *text, bool quoted);
