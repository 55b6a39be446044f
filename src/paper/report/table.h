/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of structs from a table on disk (common/csv.h), its columns found by their names. */
#pragma once
#include "common/csv.h"

#include <stddef.h>

enum { TABLE_MAX_ROWS = 5000, TABLE_MAX_SIZE = TABLE_MAX_ROWS * 512, TABLE_MAX_COLUMNS = 16 };

typedef enum TableKind {
    TABLE_TEXT,    /* const char *, pointing into the table */
    TABLE_NUMBER,  /* double, from minimum on */
    TABLE_OPTIONAL /* the same, NAN where the field is empty: not applicable */
} TableKind;

typedef struct TableColumn {
    const char *name;
    TableKind kind;
    size_t offset; /* in the row's struct */
    double minimum;
} TableColumn;

typedef struct Table {
    Csv csv;
    int count;
    void *rows; /* [count] structs */
} Table;

/* Reads 1 to TABLE_MAX_ROWS rows of row_size bytes each. The header may have further columns and any order. Refused,
   with path:line:column: a column that is missing or there twice, a number that is none or below its minimum. path is
   to outlive the table. On failure nothing is to be freed. */
bool table_read(Table *table, const char *path, const TableColumn *columns, int count, size_t row_size, Error *error);
void table_free(Table *table);
