/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "csv/csv_table.h"

#include "common/file.h"

#include <math.h>

static const char *text_of(const CsvColumn *column, const void *row) {
    return *(const char *const *)((const char *)row + column->offset);
}

static int integer_of(const CsvColumn *column, const void *row) {
    return *(const int *)((const char *)row + column->offset);
}

static double number_of(const CsvColumn *column, const void *row) {
    const void *member = (const char *)row + column->offset;
    return column->kind == CSV_FLOAT ? (double)*(const float *)member : *(const double *)member;
}

static bool is_printable(const char *text) {
    for (; *text != '\0'; text++)
        if ((unsigned char)*text < 0x20 || *text == 0x7f) return false;
    return true;
}

static bool check_field(const char *where, const CsvColumn *column, const void *row, Error *error) {
    switch (column->kind) {
    case CSV_TEXT:
    case CSV_NAME:
        return is_printable(text_of(column, row)) || error_input(error, where, "%s: a control character in '%s'",
                                                                 column->name, csv_show(text_of(column, row)).text);
    case CSV_WORD:
    case CSV_INTEGER: return true;
    default: {
        const double number = number_of(column, row);
        return isfinite(number) || (isnan(number) && column->kind == CSV_OPTIONAL) ||
               error_input(error, where, "%s: %g cannot be written", column->name, number);
    }
    }
}

static bool check_row(const char *where, const CsvLayout *layout, const void *row, Error *error) {
    for (int i = 0; i < layout->column_count; i++)
        if (!check_field(where, &layout->columns[i], row, error)) return false;
    return true;
}

static void print_field(FILE *file, const CsvColumn *column, const void *row) {
    switch (column->kind) {
    case CSV_TEXT:
    case CSV_NAME: csv_put(file, text_of(column, row), column->quoted); break;
    case CSV_WORD: csv_put(file, column->words[integer_of(column, row)], false); break;
    case CSV_INTEGER: fprintf(file, "%d", integer_of(column, row)); break;
    default:
        if (!isnan(number_of(column, row)))
            fprintf(file, "%.*g", column->digits > 0 ? column->digits : 6, number_of(column, row));
    }
}

static void print_row(FILE *file, const CsvLayout *layout, const void *row) {
    for (int i = 0; i < layout->column_count; i++) {
        print_field(file, &layout->columns[i], row);
        fputc(i + 1 < layout->column_count ? ',' : '\n', file);
    }
}

void csv_header_print(FILE *file, const CsvLayout *layout) {
    for (int i = 0; i < layout->column_count; i++)
        fprintf(file, "%s%c", layout->columns[i].name, i + 1 < layout->column_count ? ',' : '\n');
}

bool csv_row_print(FILE *file, const CsvLayout *layout, const void *row, Error *error) {
    if (!check_row(layout->name, layout, row, error)) return false;
    print_row(file, layout, row);
    return true;
}

typedef struct Rows {
    const CsvLayout *layout;
    const char *rows;
    int count;
} Rows;

static void print_table(FILE *file, const void *context) {
    const Rows *all = context;
    csv_header_print(file, all->layout);
    for (int i = 0; i < all->count; i++) print_row(file, all->layout, all->rows + (size_t)i * all->layout->row_size);
}

bool csv_table_write(const char *path, const CsvLayout *layout, const void *rows, int count, Error *error) {
    const Rows all = {layout, rows, count};
    for (int i = 0; i < count; i++)
        if (!check_row(path, layout, all.rows + (size_t)i * layout->row_size, error)) return false;
    return file_write_text(path, print_table, &all, error);
}
