/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/report/table.h"

#include "common/parse.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool find_column(const Csv *csv, const char *name, int *field, Error *error) {
    *field = -1;
    for (int i = 0; i < csv->width; i++) {
        if (strcmp(csv_text(csv, 0, i), name) != 0) continue;
        if (*field >= 0) return csv_error(csv, 0, i, error, "column %s is there twice", name);
        *field = i;
    }
    return *field >= 0 || csv_error(csv, 0, 0, error, "column %s is missing", name);
}

static bool read_number(const Csv *csv, int row, int field, const TableColumn *column, double *value, Error *error) {
    const char *text = csv_text(csv, row, field);
    if (*text == '\0' && column->kind == TABLE_OPTIONAL) {
        *value = NAN;
        return true;
    }
    if (!parse_double(text, value))
        return csv_error(csv, row, field, error, "%s must be a number (got %s)", column->name, csv_show(text).text);
    return *value >= column->minimum ||
           csv_error(csv, row, field, error, "%s cannot be %s", column->name, csv_show(text).text);
}

static bool read_field(const Csv *csv, int row, int field, const TableColumn *column, void *member, Error *error) {
    if (column->kind != TABLE_TEXT) return read_number(csv, row, field, column, member, error);
    *(const char **)member = csv_text(csv, row, field);
    return true;
}

static bool read_rows(Table *table, const TableColumn *columns, int count, size_t row_size, Error *error) {
    const Csv *csv = &table->csv;
    int fields[TABLE_MAX_COLUMNS];
    assert(count <= TABLE_MAX_COLUMNS);
    for (int i = 0; i < count; i++)
        if (!find_column(csv, columns[i].name, &fields[i], error)) return false;
    table->count = csv->rows - 1;
    table->rows = calloc((size_t)table->count, row_size);
    if (table->rows == NULL) return error_memory(error, csv->path);
    for (int row = 0; row < table->count; row++)
        for (int i = 0; i < count; i++) {
            void *member = (char *)table->rows + (size_t)row * row_size + columns[i].offset;
            if (!read_field(csv, row + 1, fields[i], &columns[i], member, error)) return false;
        }
    return true;
}

bool table_read(Table *table, const char *path, const TableColumn *columns, int count, size_t row_size, Error *error) {
    *table = (Table){.count = 0};
    if (!csv_read(&table->csv, path, TABLE_MAX_SIZE, 1, TABLE_MAX_ROWS, error)) return false;
    if (read_rows(table, columns, count, row_size, error)) return true;
    table_free(table);
    return false;
}

void table_free(Table *table) {
    free(table->rows);
    csv_free(&table->csv);
    *table = (Table){.count = 0};
}
