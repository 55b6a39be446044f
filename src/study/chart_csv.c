/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/chart_csv.h"

#include "common/csv.h"
#include "common/file.h"
#include "common/parse.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHART_MAX_SIZE = CHART_MAX_ROWS * 1024 };

static const char *const protocol_names[] = {"frozen", "closed", NULL};
static const char *const phase_names[] = {"impact", "after", "rest", NULL};

typedef struct Column Column;

struct Column {
    const char *name;
    bool (*read)(const Csv *csv, int row, int field, const Column *column, void *member, Error *error);
    void (*write)(FILE *file, const void *member);
    size_t offset;
    size_t size;              /* of a text */
    const char *const *words; /* of a word */
    double minimum, maximum;  /* of a figure */
};

static bool read_text(const Csv *csv, int row, int field, const Column *column, void *member, Error *error) {
    const char *text = csv_text(csv, row, field);
    if (strlen(text) >= column->size)
        return csv_error(csv, row, field, error, "%s may have at most %zu bytes", column->name, column->size - 1);
    strcpy(member, text);
    return true;
}

static void write_text(FILE *file, const void *member) { csv_put(file, member, false); }

/* Protocol and phase are enums, numbered as their words. */
static bool read_word(const Csv *csv, int row, int field, const Column *column, void *member, Error *error) {
    const char *text = csv_text(csv, row, field);
    for (int i = 0; column->words[i] != NULL; i++) {
        if (strcmp(text, column->words[i]) != 0) continue;
        *(unsigned *)member = (unsigned)i;
        return true;
    }
    return csv_error(csv, row, field, error, "unknown %s (got %s)", column->name, csv_show(text).text);
}

static void write_protocol(FILE *file, const void *member) { fputs(protocol_names[*(const unsigned *)member], file); }

static void write_phase(FILE *file, const void *member) { fputs(phase_names[*(const unsigned *)member], file); }

static bool read_count(const Csv *csv, int row, int field, const Column *column, void *member, Error *error) {
    const char *text = csv_text(csv, row, field);
    int64_t value;
    if (!parse_int(text, 0, INT_MAX, &value))
        return csv_error(csv, row, field, error, "%s must be a whole number (got %s)", column->name,
                         csv_show(text).text);
    *(int *)member = (int)value;
    return true;
}

static void write_count(FILE *file, const void *member) { fprintf(file, "%d", *(const int *)member); }

static bool read_figure(const Csv *csv, int row, int field, const Column *column, void *member, Error *error) {
    const char *text = csv_text(csv, row, field);
    double value = NAN;
    if (text[0] != '\0') {
        if (!parse_double(text, &value))
            return csv_error(csv, row, field, error, "%s must be a number (got %s)", column->name, csv_show(text).text);
        if (value < column->minimum || value > column->maximum)
            return csv_error(csv, row, field, error, "%s cannot be %s", column->name, csv_show(text).text);
    }
    *(double *)member = value;
    return true;
}

static void write_figure(FILE *file, const void *member) {
    double value = *(const double *)member;
    if (!isnan(value)) fprintf(file, "%.6g", value);
}

#define TEXT(name) \
    { #name, read_text, write_text, offsetof(ChartRow, name), sizeof(((ChartRow *)0)->name), NULL, 0, 0 }
#define FIGURE(name, minimum, maximum) \
    { #name, read_figure, write_figure, offsetof(ChartRow, name), 0, NULL, minimum, maximum }

static const Column columns[] = {
    TEXT(scene),
    TEXT(method),
    TEXT(setting),
    {"protocol", read_word, write_protocol, offsetof(ChartRow, protocol), 0, protocol_names, 0, 0},
    {"phase", read_word, write_phase, offsetof(ChartRow, phase), 0, phase_names, 0, 0},
    {"launches", read_count, write_count, offsetof(ChartRow, launches), 0, NULL, 0, 0},
    FIGURE(us_solver, 0, INFINITY),
    FIGURE(us_solver_q1, 0, INFINITY),
    FIGURE(us_solver_q3, 0, INFINITY),
    FIGURE(us_step, 0, INFINITY),
    FIGURE(instructions, 0, INFINITY),
    FIGURE(error_mean, 0, INFINITY),
    FIGURE(error_median, 0, INFINITY),
    FIGURE(error_p95, 0, INFINITY),
    FIGURE(error_worst, 0, INFINITY),
    FIGURE(share_right, 0, 1),
    FIGURE(penetration_max, 0, INFINITY),
    FIGURE(drift, -INFINITY, INFINITY),
    FIGURE(energy, -INFINITY, INFINITY),
    FIGURE(moved, 0, INFINITY),
};

enum { COLUMN_COUNT = sizeof columns / sizeof *columns, SOLVER_MEDIAN = 6 };

_Static_assert(sizeof(ChartProtocol) == sizeof(unsigned) && sizeof(Phase) == sizeof(unsigned),
               "words are read and written as unsigned");

static bool figures_fit(const ChartRow *row) {
    for (int i = 0; i < COLUMN_COUNT; i++)
        if (columns[i].read == read_figure && isinf(*(const double *)((const char *)row + columns[i].offset)))
            return false;
    return true;
}

static bool texts_fit(const ChartRow *row) {
    const char *const texts[] = {row->scene, row->method, row->setting};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        for (const char *c = texts[i]; *c != '\0'; c++)
            if ((unsigned char)*c < 0x20 || *c == 0x7f) return false;
    return true;
}

static bool check_row(const char *path, const ChartRow *row, Error *error) {
    if (!texts_fit(row)) return error_input(error, path, "a control character in a name or setting");
    return figures_fit(row) ||
           error_input(error, path, "an infinite figure of %s, method %s:%s", row->scene, row->method, row->setting);
}

static void write_row(FILE *file, const ChartRow *row) {
    for (int i = 0; i < COLUMN_COUNT; i++) {
        columns[i].write(file, (const char *)row + columns[i].offset);
        fputc(i + 1 < COLUMN_COUNT ? ',' : '\n', file);
    }
}

bool chart_csv_write(const char *path, const ChartRow *rows, int count, Error *error) {
    for (int i = 0; i < count; i++)
        if (!check_row(path, &rows[i], error)) return false;
    char *data = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&data, &size);
    if (file == NULL) return error_memory(error, path);
    for (int i = 0; i < COLUMN_COUNT; i++) fprintf(file, "%s%c", columns[i].name, i + 1 < COLUMN_COUNT ? ',' : '\n');
    for (int i = 0; i < count; i++) write_row(file, &rows[i]);
    bool whole = !ferror(file);
    whole = fclose(file) == 0 && whole;
    bool written = whole ? file_write(path, data, size, error) : error_memory(error, path);
    free(data);
    return written;
}

static bool check_header(const Csv *csv, Error *error) {
    for (int i = 0; i < COLUMN_COUNT && i < csv->width; i++)
        if (strcmp(csv_text(csv, 0, i), columns[i].name) != 0)
            return csv_error(csv, 0, i, error, "column %d of a chart is %s (got %s)", i + 1, columns[i].name,
                             csv_show(csv_text(csv, 0, i)).text);
    return csv->width == COLUMN_COUNT ||
           csv_error(csv, 0, 0, error, "a chart has %d columns (got %d)", (int)COLUMN_COUNT, csv->width);
}

static bool read_row(const Csv *csv, int row, ChartRow *out, Error *error) {
    for (int i = 0; i < COLUMN_COUNT; i++)
        if (!columns[i].read(csv, row, i, &columns[i], (char *)out + columns[i].offset, error)) return false;
    /* Comparisons with NAN are false: what is not there is not checked. */
    return !(out->us_solver_q1 > out->us_solver || out->us_solver > out->us_solver_q3 ||
             out->us_solver_q1 > out->us_solver_q3) ||
           csv_error(csv, row, SOLVER_MEDIAN, error, "the median time is not within its quartiles");
}

static int compare_rows(const void *left, const void *right) {
    const ChartRow *a = *(const ChartRow *const *)left, *b = *(const ChartRow *const *)right;
    int order = strcmp(a->scene, b->scene);
    if (order == 0) order = strcmp(a->method, b->method);
    if (order == 0) order = strcmp(a->setting, b->setting);
    if (order == 0) order = (a->protocol > b->protocol) - (a->protocol < b->protocol);
    return order != 0 ? order : (a->phase > b->phase) - (a->phase < b->phase);
}

/* Equal rows lie side by side once sorted. */
static bool check_doubles(const Csv *csv, const ChartTable *table, Error *error) {
    const ChartRow **sorted = malloc((size_t)table->count * sizeof(const ChartRow *));
    if (sorted == NULL) return error_memory(error, csv->path);
    for (int i = 0; i < table->count; i++) sorted[i] = &table->rows[i];
    qsort(sorted, (size_t)table->count, sizeof *sorted, compare_rows);
    bool single = true;
    for (int i = 1; single && i < table->count; i++) {
        if (compare_rows(&sorted[i - 1], &sorted[i]) != 0) continue;
        const ChartRow *later = sorted[i - 1] > sorted[i] ? sorted[i - 1] : sorted[i];
        single = csv_error(csv, (int)(later - table->rows) + 1, 0, error, "this row is there twice");
    }
    free(sorted);
    return single;
}

static bool read_table(ChartTable *table, const Csv *csv, Error *error) {
    if (!check_header(csv, error)) return false;
    table->count = csv->rows - 1;
    table->rows = calloc((size_t)table->count, sizeof *table->rows);
    if (table->rows == NULL) return error_memory(error, csv->path);
    for (int i = 0; i < table->count; i++)
        if (!read_row(csv, i + 1, &table->rows[i], error)) return false;
    return check_doubles(csv, table, error);
}

bool chart_csv_read(ChartTable *table, const char *path, Error *error) {
    *table = (ChartTable){.count = 0};
    Csv csv;
    if (!csv_read(&csv, path, CHART_MAX_SIZE, 1, CHART_MAX_ROWS, error)) return false;
    bool read = read_table(table, &csv, error);
    csv_free(&csv);
    if (!read) chart_csv_free(table);
    return read;
}

void chart_csv_free(ChartTable *table) {
    free(table->rows);
    *table = (ChartTable){.count = 0};
}
