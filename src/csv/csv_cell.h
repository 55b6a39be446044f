/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Part of csv_table: one field of a row. */
#pragma once
#include "csv/csv_table.h"

typedef struct CsvCell {
    const Csv *csv;
    int row, field; /* of csv */
    const CsvColumn *column;
} CsvCell;

/* Reads the field into its member of the row's struct. False with an error at the field if it is not of its column's kind
   or range. */
bool csv_cell_read(const CsvCell *cell, void *row, Error *error);
