/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "csv/csv_cell.h"

#include "common/names.h"
#include "common/parse.h"

#include <math.h>
#include <string.h>

static const char *text_of(const CsvCell *cell) { return csv_text(cell->csv, cell->row, cell->field); }

/* "NAME: 'FIELD' what". */
static bool refuse(const CsvCell *cell, Error *error, const char *what) {
    const char *text = text_of(cell), *name = cell->column->name;
    if (text[0] == '\0') return csv_error(cell->csv, cell->row, cell->field, error, "%s: the field is empty", name);
    return csv_error(cell->csv, cell->row, cell->field, error, "%s: '%s' %s", name, csv_show(text).text, what);
}

static bool read_text(const CsvCell *cell, const char **member, Error *error) {
    const char *text = text_of(cell);
    const bool name = cell->column->kind == CSV_NAME;
    const size_t most = name ? CSV_NAME_SIZE - 1 : (size_t)cell->column->maximum;
    char what[64];
    snprintf(what, sizeof what, "is longer than %zu bytes", most);
    if (strlen(text) > most) return refuse(cell, error, what);
    for (const char *c = text; name && *c != '\0'; c += csv_plain_length(c))
        if (csv_plain_length(c) == 0)
            return refuse(cell, error, "may only have letters, digits, spaces and -_.,:=+/()*[]");
    *member = text;
    return true;
}

static bool read_word(const CsvCell *cell, int *member, Error *error) {
    const char *const *words = cell->column->words;
    NameList known = {0};
    char what[256];
    *member = csv_word(words, text_of(cell));
    if (*member >= 0) return true;
    for (int i = 0; words[i] != NULL; i++) name_list_add(&known, words[i]);
    snprintf(what, sizeof what, "is not one of %.200s", known.text);
    return refuse(cell, error, what);
}

static bool is_in_range(const CsvCell *cell, double value, Error *error) {
    const double minimum = cell->column->minimum, maximum = cell->column->maximum;
    char what[64];
    if (value >= minimum && value <= maximum) return true;
    snprintf(what, sizeof what, "is %s than %g", value < minimum ? "less" : "greater",
             value < minimum ? minimum : maximum);
    return refuse(cell, error, what);
}

static bool read_integer(const CsvCell *cell, int *member, Error *error) {
    int64_t value;
    if (!parse_int(text_of(cell), INT64_MIN, INT64_MAX, &value)) return refuse(cell, error, "is not a whole number");
    *member = (int)value;
    return is_in_range(cell, (double)value, error);
}

static bool read_float(const CsvCell *cell, float *member, Error *error) {
    return parse_float(text_of(cell), member) ? is_in_range(cell, (double)*member, error)
                                              : refuse(cell, error, "is not a number");
}

static bool read_number(const CsvCell *cell, double *member, Error *error) {
    const char *text = text_of(cell);
    *member = NAN;
    if (text[0] == '\0' && cell->column->kind == CSV_OPTIONAL) return true;
    return parse_double(text, member) ? is_in_range(cell, *member, error) : refuse(cell, error, "is not a number");
}

bool csv_cell_read(const CsvCell *cell, void *row, Error *error) {
    void *member = (char *)row + cell->column->offset;
    switch (cell->column->kind) {
    case CSV_TEXT:
    case CSV_NAME: return read_text(cell, member, error);
    case CSV_WORD: return read_word(cell, member, error);
    case CSV_INTEGER: return read_integer(cell, member, error);
    case CSV_FLOAT: return read_float(cell, member, error);
    default: return read_number(cell, member, error);
    }
}
