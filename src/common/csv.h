/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of text (RFC 4180): a header line, then data lines of as many fields each. Fields are separated by commas; one
   that begins with a double quote ends with one, and holds commas and doubled quotes. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdio.h>

typedef struct CsvField {
    const char *text; /* without its quotes */
    int column;       /* in the line, in characters from 1 */
} CsvField;

typedef struct Csv {
    const char *path; /* as given; not owned */
    int width;        /* fields of each line */
    int rows;         /* lines with the header, which is row 0; row i is line i + 1 */
    CsvField *fields; /* [rows][width] */
    char *text;       /* what the fields point into */
} Csv;

/* Reads a file of at most max_size bytes with 1 to max_rows data lines. Line ends are LF or CRLF; a byte order mark is
   dropped. Refused, with file:line:column: control characters (so no field holds a line end), empty lines, lines of
   another width than the header's, stray quotes. On failure nothing is to be freed. */
bool csv_read(Csv *csv, const char *path, size_t max_size, int max_rows, Error *error);
void csv_free(Csv *csv);

/* True for a file of nothing but a header line: a table without rows, which csv_read() refuses. */
bool csv_is_bare(const char *path);

const char *csv_text(const Csv *csv, int row, int field);

/* Sets an input error "path:line:column: error: text". Returns false. */
bool csv_error(const Csv *csv, int row, int field, Error *error, const char *format, ...) PRINTF_LIKE(5, 6);

/* A text for a message: what is no printable ASCII becomes '?', what does not fit is cut to "...". */
typedef struct CsvShown {
    char text[48];
} CsvShown;
CsvShown csv_show(const char *text);

/* Writes a field, in quotes where it needs them. */
void csv_put(FILE *file, const char *text);
