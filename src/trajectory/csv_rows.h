/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows of a run's CSV, one at a time: a file of a million rows takes no memory but its text. Part of csv_run. */
#pragma once
#include "common/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum CsvRowsColumn { COL_FRAME, COL_BODY, COL_X, COL_Y, COL_ANGLE, COL_VX, COL_VY, COL_OMEGA, COL_TIME, COL_COUNT };

typedef struct CsvRows {
    const char *path;
    const char *at;       /* the line to be read */
    int line;             /* its number */
    int width;            /* fields of each line */
    int field[COL_COUNT]; /* of each column, -1: absent */
    const char *first;    /* the first row, */
    int first_line;       /* and its number */
    char ignored[128];    /* columns that mean nothing, separated by ", " */
} CsvRows;

typedef struct CsvRow {
    int line;
    int64_t frame, body;
    float state[6]; /* x, y, angle, vx, vy, omega; the last three 0 if absent */
    double time;    /* s, 0 if absent */
} CsvRow;

/* Reads the header at `text`, which is line `line` of the file and stays the caller's. */
bool csv_rows_begin(CsvRows *rows, const char *path, const char *text, int line, Error *error);

/* False at the end, and with error set. */
bool csv_rows_next(CsvRows *rows, CsvRow *row, Error *error);
void csv_rows_rewind(CsvRows *rows);

/* Line of the row of a body in a frame; 0: none. */
int csv_rows_find(CsvRows *rows, int64_t frame, int64_t body);

/* "path:line: error: text". Returns false. */
bool csv_rows_error(const CsvRows *rows, int line, Error *error, const char *format, ...) PRINTF_LIKE(4, 5);
