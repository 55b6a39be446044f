/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of structs and the lines of CSV files that hold them. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

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

/* Whether the row can be read back. */
static bool check_row(const char *where, const CsvLayout *layout, const void *row, Error *error) {
    for (int i = 0; i < layout->column_count; i++) {
        const CsvColumn *column = &layout->columns[i];
        const bool text = column->kind == CSV_TEXT || column->kind == CSV_NAME;
        if (column->kind == CSV_WORD || column->kind == CSV_INTEGER) continue;
        for (const char *c = text ? text_of(column, row) : ""; *c != '\0'; c++)
            if ((unsigned char)*c < 0x20 || *c == 0x7f)
                return error_input(error, where, "%s: a control character in '%s'", column->name,
                                   csv_show(text_of(column, row)).text);
        if (text) continue;
        const double number = number_of(column, row);
        if (!isfinite(number) && !(isnan(number) && column->kind == CSV_OPTIONAL))
            return error_input(error, where, "%s: %g cannot be written", column->name, number);
    }
    return true;
}

/* Far more than any row of numbers and names takes. */
enum { ROW_MAX_SIZE = 1200 };

static void print_row(FILE *file, const CsvLayout *layout, const void *row) {
    for (int i = 0; i < layout->column_count; i++) {
        const CsvColumn *column = &layout->columns[i];
        switch (column->kind) {
        case CSV_TEXT:
        case CSV_NAME: {
            char apart[ROW_MAX_SIZE];
            const char *text = text_of(column, row);
            snprintf(apart, sizeof apart, "'%s", text);
            csv_put(file, csv_is_computed(text) ? apart : text, column->quoted);
            break;
        }
        case CSV_WORD: csv_put(file, column->words[integer_of(column, row)], false); break;
        case CSV_INTEGER: fprintf(file, "%d", integer_of(column, row)); break;
        default:
            if (!isnan(number_of(column, row)))
                fprintf(file, "%.*g", column->digits > 0 ? column->digits : 6, number_of(column, row));
        }
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

size_t csv_plain_length(const char *text) {
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789 -_.,:=+/()*[]";
    enum { AFTER_CONTROLS = 0xA1 };
    uint32_t character;
    const size_t length = utf8_decode(text, strnlen(text, 4), &character);
    return length > 1 ? (character >= AFTER_CONTROLS ? length : 0) : length == 1 && strchr(plain, *text) != NULL;
}

int csv_word(const char *const *words, const char *word) {
    int i = 0;
    while (words[i] != NULL && strcmp(words[i], word) != 0) i++;
    return words[i] != NULL ? i : -1;
}

/* A field of a row that is being read. */
typedef struct CsvCell {
    const Csv *csv;
    int row, field; /* of csv */
    const CsvColumn *column;
} CsvCell;

static const char *cell_text(const CsvCell *cell) { return csv_text(cell->csv, cell->row, cell->field); }

/* "NAME: 'FIELD' what". */
static bool refuse_cell(const CsvCell *cell, Error *error, const char *what) {
    const char *text = cell_text(cell), *name = cell->column->name;
    if (text[0] == '\0') return csv_error(cell->csv, cell->row, cell->field, error, "%s: the field is empty", name);
    return csv_error(cell->csv, cell->row, cell->field, error, "%s: '%s' %s", name, csv_show(text).text, what);
}

static bool read_text(const CsvCell *cell, const char **member, Error *error) {
    const char *text = cell_text(cell);
    const bool name = cell->column->kind == CSV_NAME;
    text += *text == '\'' && csv_is_computed(text + 1);
    const size_t most = name ? CSV_NAME_SIZE - 1 : (size_t)cell->column->maximum;
    char what[64];
    snprintf(what, sizeof what, "is longer than %zu bytes", most);
    if (strlen(text) > most) return refuse_cell(cell, error, what);
    for (const char *c = text; name && *c != '\0'; c += csv_plain_length(c))
        if (csv_plain_length(c) == 0)
            return refuse_cell(cell, error, "may only have letters, digits, spaces and -_.,:=+/()*[]");
    *member = text;
    return true;
}

/* Reads the field into its member of the row's struct. False with an error at the field if it is not of its column's
   kind or range. */
static bool read_cell(const CsvCell *cell, void *row, Error *error) {
    const CsvColumn *column = cell->column;
    void *member = (char *)row + column->offset;
    const char *text = cell_text(cell);
    char what[256];
    double value;
    if (column->kind == CSV_TEXT || column->kind == CSV_NAME) return read_text(cell, member, error);
    if (column->kind == CSV_WORD) {
        NameList known = {0};
        if ((*(int *)member = csv_word(column->words, text)) >= 0) return true;
        for (int i = 0; column->words[i] != NULL; i++) name_list_add(&known, column->words[i]);
        snprintf(what, sizeof what, "is not one of %.200s", known.text);
        return refuse_cell(cell, error, what);
    }
    if (column->kind == CSV_INTEGER) {
        int64_t whole;
        if (!parse_int(text, INT64_MIN, INT64_MAX, &whole)) return refuse_cell(cell, error, "is not a whole number");
        *(int *)member = (int)whole;
        value = (double)whole;
    } else if (column->kind == CSV_FLOAT) {
        if (!parse_float(text, member)) return refuse_cell(cell, error, "is not a number");
        value = (double)*(float *)member;
    } else {
        *(double *)member = NAN;
        if (text[0] == '\0' && column->kind == CSV_OPTIONAL) return true;
        if (!parse_double(text, member)) return refuse_cell(cell, error, "is not a number");
        value = *(double *)member;
    }
    if (value >= column->minimum && value <= column->maximum) return true;
    snprintf(what, sizeof what, "is %s than %g", value < column->minimum ? "less" : "greater",
             value < column->minimum ? column->minimum : column->maximum);
    return refuse_cell(cell, error, what);
}

/* A file that is being read. */
typedef struct Reading {
    CsvTable *table;
    const CsvLayout *layout;
    Error *error;
} Reading;

static bool read_rows(const Reading *reading) {
    static const char *const empty = "";
    static const double unknown = NAN;
    const CsvLayout *layout = reading->layout;
    CsvTable *table = reading->table;
    table->count = table->csv.rows - 1;
    table->rows = calloc((size_t)table->csv.rows, layout->row_size);
    if (table->rows == NULL) return error_memory(reading->error, table->csv.path);
    for (int row = 1; row <= table->count; row++)
        for (int i = 0; i < layout->column_count; i++) {
            const CsvCell cell = {&table->csv, row, table->fields[i], &layout->columns[i]};
            void *target = (char *)table->rows + (size_t)(row - 1) * layout->row_size;
            if (cell.field >= 0) {
                if (!read_cell(&cell, target, reading->error)) return false;
            } else if (cell.column->optional && cell.column->kind == CSV_TEXT) {
                memcpy((char *)target + cell.column->offset, &empty, sizeof empty);
            } else if (cell.column->optional && cell.column->kind == CSV_OPTIONAL) {
                memcpy((char *)target + cell.column->offset, &unknown, sizeof unknown);
            }
        }
    return true;
}

/* Finds the columns. */
static bool read_header(const Reading *reading) {
    const CsvLayout *layout = reading->layout;
    const Csv *csv = &reading->table->csv;
    int *fields = reading->table->fields;
    for (int i = 0; i < CSV_MAX_COLUMNS; i++) fields[i] = -1;
    for (int field = 0; field < csv->width; field++) {
        const char *name = csv_text(csv, 0, field);
        int column = 0;
        while (column < layout->column_count && strcmp(layout->columns[column].name, name) != 0) column++;
        if (layout->header == CSV_EXACT && column != field && field < layout->column_count)
            return csv_error(csv, 0, field, reading->error, "column %d must be '%s' (got '%s')", field + 1,
                             layout->columns[field].name, csv_show(name).text);
        if (column == layout->column_count) {
            NameList names = {0};
            if (layout->header == CSV_ALL) continue;
            for (int i = 0; i < layout->column_count; i++) name_list_add(&names, layout->columns[i].name);
            return csv_error(csv, 0, field, reading->error, "unknown column '%s'; the columns are %s",
                             csv_show(name).text, names.text);
        }
        if (fields[column] >= 0) return csv_error(csv, 0, field, reading->error, "the column '%s' appears twice", name);
        fields[column] = field;
    }
    for (int i = 0; layout->header != CSV_SUBSET && i < layout->column_count; i++)
        if (fields[i] < 0 && !layout->columns[i].optional)
            return csv_error(csv, 0, 0, reading->error, "the column '%s' is missing", layout->columns[i].name);
    return true;
}

/* A row, as qsort() needs it. */
typedef struct KeyedRow {
    const Reading *reading;
    int row;
} KeyedRow;

static int compare_keys(const void *left, const void *right) {
    const KeyedRow *a = left, *b = right;
    const CsvTable *table = a->reading->table;
    const CsvLayout *layout = a->reading->layout;
    for (int i = 0; i < layout->column_count; i++) {
        if (!layout->columns[i].key || table->fields[i] < 0) continue;
        int order =
            strcmp(csv_text(&table->csv, a->row, table->fields[i]), csv_text(&table->csv, b->row, table->fields[i]));
        if (order != 0) return order;
    }
    return 0;
}

/* Rows with equal keys are neighbours once sorted. */
static bool check_keys(const Reading *reading) {
    const CsvTable *table = reading->table;
    bool keyed = false;
    for (int i = 0; i < reading->layout->column_count; i++)
        keyed = keyed || (reading->layout->columns[i].key && table->fields[i] >= 0);
    if (!keyed || table->count == 0) return true;
    KeyedRow *sorted = malloc((size_t)table->count * sizeof *sorted);
    if (sorted == NULL) return error_memory(reading->error, table->csv.path);
    for (int i = 0; i < table->count; i++) sorted[i] = (KeyedRow){reading, i + 1};
    qsort(sorted, (size_t)table->count, sizeof *sorted, compare_keys);
    bool single = true;
    for (int i = 1; single && i < table->count; i++) {
        if (compare_keys(&sorted[i - 1], &sorted[i]) != 0) continue;
        const int a = sorted[i - 1].row, b = sorted[i].row;
        single = csv_error(&table->csv, a > b ? a : b, 0, reading->error, "the row repeats that of line %d",
                           (a > b ? b : a) + 1);
    }
    free(sorted);
    return single;
}

bool csv_table_read(CsvTable *table, const char *path, const CsvLayout *layout, Error *error) {
    const Reading reading = {table, layout, error};
    assert(layout->column_count <= CSV_MAX_COLUMNS);
    *table = (CsvTable){.count = 0};
    const size_t max_size = ((size_t)layout->max_rows + 1) * ROW_MAX_SIZE;
    if (!csv_read(&table->csv, path, max_size, layout->min_rows, layout->max_rows, error)) return false;
    if (read_header(&reading) && read_rows(&reading) && check_keys(&reading) &&
        (layout->check == NULL || layout->check(table, error)))
        return true;
    csv_table_free(table);
    return false;
}

bool csv_table_path(char path[CSV_PATH_SIZE], const char *folder, const CsvLayout *layout, Error *error) {
    return file_path(path, CSV_PATH_SIZE, error, "%s/%s.csv", folder, layout->name);
}

bool csv_table_read_from(CsvTable *table, const char *folder, const CsvLayout *layout, Error *error) {
    char path[CSV_PATH_SIZE];
    return csv_table_path(path, folder, layout, error) && csv_table_read(table, path, layout, error);
}

void csv_table_free(CsvTable *table) {
    free(table->rows);
    csv_free(&table->csv);
    *table = (CsvTable){.count = 0};
}

bool csv_table_error(const CsvTable *table, int row, int column, Error *error, const char *format, ...) {
    char what[512];
    PRINT_ARGUMENTS(what, sizeof what, format);
    const int field = table->fields[column];
    return csv_error(&table->csv, row + 1, field < 0 ? 0 : field, error, "%s", what);
}
