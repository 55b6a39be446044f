/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/csv_columns.h"

#include "chart/chart_data.h"
#include "common/csv.h"
#include "common/parse.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_MAX_SIZE = 1024 };

_Static_assert((int)CSV_NAME_SIZE == (int)CHART_TEXT_SIZE, "a name that is plain fits");

static bool read_name(const Csv *csv, int row, int field, const CsvColumn *column, char *member, Error *error) {
    const char *text = csv_text(csv, row, field);
    chart_plain(member, text);
    return strcmp(member, text) == 0 ||
           csv_error(csv, row, field, error, "%s cannot be drawn (got %s)", column->name, csv_show(text).text);
}

static bool read_text(const Csv *csv, int row, int field, const CsvColumn *column, char *member, Error *error) {
    const char *text = csv_text(csv, row, field);
    if (strlen(text) >= CSV_TEXT_SIZE)
        return csv_error(csv, row, field, error, "%s has more than %d bytes", column->name, CSV_TEXT_SIZE - 1);
    strcpy(member, text);
    return true;
}

static bool read_word(const Csv *csv, int row, int field, const CsvColumn *column, int *member, Error *error) {
    const char *text = csv_text(csv, row, field);
    for (*member = 0; column->words[*member] != NULL; ++*member)
        if (strcmp(text, column->words[*member]) == 0) return true;
    return csv_error(csv, row, field, error, "unknown %s (got %s)", column->name, csv_show(text).text);
}

static bool read_number(const Csv *csv, int row, int field, const CsvColumn *column, double *member, Error *error) {
    const char *text = csv_text(csv, row, field);
    *member = NAN;
    if (text[0] == '\0' && column->kind == CSV_MAYBE) return true;
    if (!parse_double(text, member))
        return csv_error(csv, row, field, error, "%s must be a number (got %s)", column->name, csv_show(text).text);
    return (*member >= column->minimum && *member <= column->maximum) ||
           csv_error(csv, row, field, error, "%s cannot be %s", column->name, csv_show(text).text);
}

static bool read_field(const Csv *csv, int row, int field, const CsvColumn *column, char *item, Error *error) {
    void *member = item + column->offset;
    switch (column->kind) {
    case CSV_NAME: return read_name(csv, row, field, column, member, error);
    case CSV_TEXT: return read_text(csv, row, field, column, member, error);
    case CSV_WORD: return read_word(csv, row, field, column, member, error);
    default: return read_number(csv, row, field, column, member, error);
    }
}

static bool find_columns(const Csv *csv, const CsvColumn *columns, int count, int *fields, Error *error) {
    for (int i = 0; i < count; i++) {
        fields[i] = -1;
        for (int field = 0; field < csv->width; field++) {
            if (strcmp(csv_text(csv, 0, field), columns[i].name) != 0) continue;
            if (fields[i] >= 0) return csv_error(csv, 0, field, error, "a second column %s", columns[i].name);
            fields[i] = field;
        }
        if (fields[i] < 0) return csv_error(csv, 0, 0, error, "there is no column %s", columns[i].name);
    }
    return true;
}

static char *read_rows(const Csv *csv, const CsvColumn *columns, int count, size_t struct_size, Error *error) {
    int fields[CSV_MAX_COLUMNS];
    if (!find_columns(csv, columns, count, fields, error)) return NULL;
    char *rows = calloc((size_t)csv->rows, struct_size);
    if (rows == NULL) {
        error_memory(error, csv->path);
        return NULL;
    }
    for (int row = 1; row < csv->rows; row++)
        for (int i = 0; i < count; i++) {
            if (read_field(csv, row, fields[i], &columns[i], rows + (size_t)(row - 1) * struct_size, error)) continue;
            free(rows);
            return NULL;
        }
    return rows;
}

void *csv_columns_read(const char *folder, const char *file, const CsvColumn *columns, int column_count,
                       size_t struct_size, int max_rows, int *row_count, Error *error) {
    char path[PATH_MAX];
    int length = snprintf(path, sizeof path, "%s/%s.csv", folder, file);
    if (length < 0 || length >= (int)sizeof path) {
        error_input(error, folder, "this path is too long");
        return NULL;
    }
    Csv csv;
    if (!csv_read(&csv, path, (size_t)CSV_MAX_ROWS * LINE_MAX_SIZE, 1, max_rows, error)) return NULL;
    char *rows = read_rows(&csv, columns, column_count, struct_size, error);
    *row_count = csv.rows - 1;
    csv_free(&csv);
    return rows;
}
