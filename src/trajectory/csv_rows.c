/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "trajectory/csv_rows.h"

#include "common/nearest.h"
#include "common/parse.h"
#include "csv/csv.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { LINE_SIZE = 1024, FIELDS_MAX = 64, INDEX_MAX = INT32_MAX - 1 };

static const char *const names[COL_COUNT] = {"frame", "body", "x", "y", "angle", "vx", "vy", "omega", "time"};

/* A line, cut into fields in place. */
typedef struct Fields {
    int count;
    char *text[FIELDS_MAX];
    int column[FIELDS_MAX]; /* in the line, from 1 */
    char line[LINE_SIZE];
} Fields;

static bool fail_at(const CsvRows *rows, int line, int column, Error *error, const char *what) {
    char where[1280];
    int used = snprintf(where, sizeof where, "%.1200s:%d", rows->path, line);
    if (column > 0) snprintf(where + used, sizeof where - (size_t)used, ":%d", column);
    return error_input(error, where, "%s", what);
}

bool csv_rows_error(const CsvRows *rows, int line, Error *error, const char *format, ...) {
    char what[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    return fail_at(rows, line, 0, error, what);
}

static char *trim(char *text) {
    text += strspn(text, " \t");
    size_t length = strlen(text);
    while (length > 0 && strchr(" \t", text[length - 1]) != NULL) text[--length] = '\0';
    return text;
}

/* Takes the next line. */
static bool split(CsvRows *rows, Fields *fields, Error *error) {
    size_t length = strcspn(rows->at, "\n"), used = length;
    fields->count = 0;
    if (used > 0 && rows->at[used - 1] == '\r') used--;
    if (used == 0) return csv_rows_error(rows, rows->line, error, "the line is empty");
    if (used >= LINE_SIZE) return csv_rows_error(rows, rows->line, error, "longer than %d bytes", LINE_SIZE - 1);
    memcpy(fields->line, rows->at, used);
    fields->line[used] = '\0';
    rows->at += length + (rows->at[length] == '\n');
    for (char *next = fields->line; next != NULL;) {
        char *field = next, *comma = strchr(field, ',');
        if (fields->count == FIELDS_MAX)
            return csv_rows_error(rows, rows->line, error, "more than %d fields", FIELDS_MAX);
        next = comma != NULL ? comma + 1 : NULL;
        if (comma != NULL) *comma = '\0';
        fields->column[fields->count] = (int)(field - fields->line) + 1;
        fields->text[fields->count++] = trim(field);
    }
    return true;
}

static bool is_absent(const CsvRows *rows, int column) { return rows->field[column] < 0; }

/* The column that an unknown name probably means, among those that the file lacks; NULL: none. */
static const char *meant(const CsvRows *rows, const char *name) {
    static const struct {
        const char *other;
        int column;
    } others[] = {{"step", COL_FRAME}, {"id", COL_BODY},       {"theta", COL_ANGLE},  {"rotation", COL_ANGLE},
                  {"t", COL_TIME},     {"spin", COL_OMEGA},    {"w", COL_OMEGA},      {"pos_x", COL_X},
                  {"pos_y", COL_Y},    {"velocity_x", COL_VX}, {"velocity_y", COL_VY}};
    const char *missing[COL_COUNT];
    int count = 0;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (is_absent(rows, others[i].column) && strcmp(others[i].other, name) == 0) return names[others[i].column];
    for (int i = 0; i < COL_COUNT; i++)
        if (is_absent(rows, i)) missing[count++] = names[i];
    return strlen(name) > 3 ? nearest_word(name, missing, count) : NULL;
}

static bool place(CsvRows *rows, const Fields *fields, Error *error) {
    for (int i = 0; i < COL_COUNT; i++) rows->field[i] = -1;
    for (int i = 0; i < fields->count; i++) {
        char what[128];
        int column = 0;
        while (column < COL_COUNT && strcmp(names[column], fields->text[i]) != 0) column++;
        if (column == COL_COUNT) continue;
        if (!is_absent(rows, column)) {
            snprintf(what, sizeof what, "the column '%s' appears twice", names[column]);
            return fail_at(rows, rows->line, fields->column[i], error, what);
        }
        rows->field[column] = i;
    }
    return true;
}

/* Names that mean nothing are kept for a note, unless one looks like a name that is missing. */
static bool check_others(CsvRows *rows, const Fields *fields, Error *error) {
    for (int i = 0; i < fields->count; i++) {
        bool known = false;
        for (int column = 0; column < COL_COUNT; column++) known = known || rows->field[column] == i;
        if (known) continue;
        const char *right = meant(rows, fields->text[i]);
        const CsvShown shown = csv_show(fields->text[i]);
        char what[160];
        if (right != NULL) {
            snprintf(what, sizeof what, "unknown column '%s': did you mean '%s'? Rename or remove it", shown.text,
                     right);
            return fail_at(rows, rows->line, fields->column[i], error, what);
        }
        size_t used = strlen(rows->ignored);
        snprintf(rows->ignored + used, sizeof rows->ignored - used, "%s%s", used > 0 ? ", " : "", shown.text);
    }
    return true;
}

bool csv_rows_begin(CsvRows *rows, const char *path, const char *text, int line, Error *error) {
    Fields fields;
    *rows = (CsvRows){.path = path, .at = text, .line = line};
    if (*text == '\0') return csv_rows_error(rows, line, error, "there is no header 'frame,body,x,y,angle'");
    if (!split(rows, &fields, error) || !place(rows, &fields, error) || !check_others(rows, &fields, error))
        return false;
    for (int i = COL_FRAME; i <= COL_ANGLE; i++)
        if (is_absent(rows, i))
            return csv_rows_error(rows, line, error, "the column '%s' is missing; expected frame,body,x,y,angle",
                                  names[i]);
    for (int i = COL_VX; i <= COL_OMEGA; i++)
        if (is_absent(rows, i) != is_absent(rows, COL_VX))
            return csv_rows_error(rows, line, error, "give all of vx, vy and omega, or none of them");
    rows->width = fields.count;
    rows->first = rows->at;
    rows->first_line = rows->line = line + 1;
    return true;
}

void csv_rows_rewind(CsvRows *rows) {
    rows->at = rows->first;
    rows->line = rows->first_line;
}

static bool fail_field(const CsvRows *rows, const Fields *fields, int column, Error *error, const char *what) {
    const int field = rows->field[column];
    char text[200];
    snprintf(text, sizeof text, "%s: '%s' %s", names[column], csv_show(fields->text[field]).text, what);
    return fail_at(rows, rows->line, fields->column[field], error, text);
}

static bool take_index(const CsvRows *rows, const Fields *fields, int column, int64_t *index, Error *error) {
    return parse_int(fields->text[rows->field[column]], 0, INDEX_MAX, index) ||
           fail_field(rows, fields, column, error, "is not a whole number from 0 to 2147483646");
}

static bool take_state(const CsvRows *rows, const Fields *fields, CsvRow *row, Error *error) {
    for (int column = COL_X; column <= COL_OMEGA; column++)
        if (!is_absent(rows, column) && !parse_float(fields->text[rows->field[column]], &row->state[column - COL_X]))
            return fail_field(rows, fields, column, error, "is not a finite number");
    return is_absent(rows, COL_TIME) || parse_double(fields->text[rows->field[COL_TIME]], &row->time) ||
           fail_field(rows, fields, COL_TIME, error, "is not a finite number");
}

bool csv_rows_next(CsvRows *rows, CsvRow *row, Error *error) {
    Fields fields;
    *row = (CsvRow){.line = rows->line};
    if (*rows->at == '\0' || !split(rows, &fields, error)) return false;
    if (fields.count != rows->width)
        return csv_rows_error(rows, rows->line, error, "%d fields, but the header has %d", fields.count, rows->width);
    if (!take_index(rows, &fields, COL_FRAME, &row->frame, error) ||
        !take_index(rows, &fields, COL_BODY, &row->body, error) || !take_state(rows, &fields, row, error))
        return false;
    rows->line++;
    return true;
}

int csv_rows_find(CsvRows *rows, int64_t frame, int64_t body) {
    CsvRow row;
    Error ignored = {0};
    csv_rows_rewind(rows);
    while (csv_rows_next(rows, &row, &ignored))
        if (row.frame == frame && row.body == body) return row.line;
    return 0;
}
