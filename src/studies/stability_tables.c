/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tables of the stability study: names and texts of their rows, what they may hold, their layouts. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "methods/names.h"
#include "methods/programs.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"
#include "studies/chart_data.h"
#include "studies/stability.h"
#include "studies/stability_internal.h"

#include <ctype.h>
#include <limits.h>
#include <math.h>
#include <string.h>

bool map_cell_same_method(const MapCell *a, const MapCell *b) {
    return strcmp(a->method, b->method) == 0 && strcmp(a->setting, b->setting) == 0;
}

bool border_same_method(const BorderRow *a, const BorderRow *b) {
    return strcmp(a->method, b->method) == 0 && strcmp(a->setting, b->setting) == 0;
}

bool border_same_study(const BorderRow *a, const BorderRow *b) { return strcmp(a->study, b->study) == 0; }

const char stability_struck_words[] =
    "Where a bomb or a moving body strikes, a method holds where no box falls; where it collapses, half of the boxes "
    "do, or more. Hatched: it stands where the reference falls, or falls where it stands, or is not sound as it is; in "
    "maps also where only one of the two collapses. "
    "Undecided: a micrometre decides, or the reference did not converge.";

const char stability_unconverged_words[] = "Where a step did not converge, what a strike must do is undecided.";

bool stability_unconverged(const CsvTable *table, const char *study, char text[UNCONVERGED_TEXT_SIZE]) {
    enum { NAMED = 12 };
    double steps = 0, not_converged = 0, residual = 0;
    int places = 0;
    text[0] = '\0';
    for (int i = 0; i < table->count; i++) {
        const MapCell *cell = map_cell(table, i);
        const bool map = !isnan(cell->y);
        bool first = strcmp(cell->map, study) == 0; /* row of its values: other methods have the same converged runs */
        for (int k = 0; first && k < i; k++) {
            const MapCell *other = map_cell(table, k);
            first = strcmp(other->map, study) != 0 || other->x != cell->x || (map && other->y != cell->y);
        }
        if (!first) continue;
        /* "at rows 22", or of a map "at rows/rate 22/60"; further places without the names. */
        if (places == 0)
            text_add(text, UNCONVERGED_TEXT_SIZE, map ? "at %s/%s " : "at %s ", cell->x_parameter, cell->y_parameter);
        if (places < NAMED)
            text_add(text, UNCONVERGED_TEXT_SIZE, map ? "%s%.4g/%.4g" : "%s%.4g", places > 0 ? ", " : "", cell->x,
                     cell->y);
        places++;
        steps += cell->steps;
        not_converged += cell->not_converged;
        if (!(cell->residual <= residual)) residual = cell->residual;
    }
    if (places > NAMED) text_add(text, UNCONVERGED_TEXT_SIZE, " and %d more", places - NAMED);
    if (places > 0) text_add(text, UNCONVERGED_TEXT_SIZE, " (%.0f of %.0f steps, residual ", not_converged, steps);
    if (places > 0)
        text_add(text, UNCONVERGED_TEXT_SIZE, isnan(residual) ? "not finite)" : "up to %.2g m/s)", residual);
    return places > 0;
}

bool border_is_struck(const CsvTable *table, int i, const StabilityOwn *own) {
    const StabilityStudy *known = border_study(own, border_row(table, i));
    if (known != NULL) return !known->stands;
    for (int k = 0; k < table->count; k++) {
        const int verdict = border_row(table, k)->verdict;
        if (!border_same_study(border_row(table, k), border_row(table, i))) continue;
        if (verdict == VERDICT_STANDS || verdict == VERDICT_UNDECIDED || verdict == VERDICT_COLLAPSES) return true;
    }
    return false;
}

void stability_method_name(char text[STABILITY_TEXT_SIZE], const char *method, const char *setting) {
    char whole[CSV_NAME_SIZE + STABILITY_SETTING_SIZE];
    snprintf(whole, sizeof whole, "%s%s%s", method, setting[0] != '\0' ? ":" : "", setting);
    method_name(text, STABILITY_TEXT_SIZE, whole);
}

void stability_method_text(char text[STABILITY_TEXT_SIZE], const char *method, const char *setting) {
    stability_method_name(text, method, setting);
    chart_make_plain(text);
}

/* Words instead of the names of tables. */
void stability_axis_text(char text[STABILITY_TEXT_SIZE], const char *parameter, const char *unit) {
    snprintf(text, STABILITY_TEXT_SIZE, unit[0] != '\0' ? "%s (%s)" : "%s", parameter, unit);
    for (char *c = text; *c != '\0'; c++)
        if (*c == '_') *c = ' ';
    text[0] = (char)toupper((unsigned char)text[0]);
}

/* Row i is the first of a map, or of a method of one: neither may have appeared before. */
static bool check_first(const CsvTable *table, int i, bool new_map, Error *error) {
    const MapCell *cell = map_cell(table, i);
    bool is_name = cell->map[0] != '\0';
    for (const char *c = cell->map; *c != '\0'; c++) is_name &= isalnum((unsigned char)*c) || *c == '_' || *c == '-';
    if (new_map && !is_name) return csv_table_error(table, i, 0, error, "map: '%s' is not a file name", cell->map);
    for (int k = 0; k < i; k++) {
        if (strcmp(map_cell(table, k)->map, cell->map) != 0) continue;
        if (new_map) return csv_table_error(table, i, 0, error, "the rows of map '%s' are not together", cell->map);
        if (map_cell_same_method(map_cell(table, k), cell))
            return csv_table_error(table, i, 0, error, "the rows of this method of map '%s' are not together",
                                   cell->map);
    }
    return true;
}

static bool check_cells(const CsvTable *table, Error *error) {
    int firsts = 0;
    for (int i = 0; i < table->count; i++) {
        const MapCell *cell = map_cell(table, i), *last = i > 0 ? cell - 1 : cell;
        bool new_map = i == 0 || strcmp(last->map, cell->map) != 0;
        if (!new_map && (strcmp(last->x_parameter, cell->x_parameter) != 0 || strcmp(last->x_unit, cell->x_unit) != 0 ||
                         strcmp(last->y_parameter, cell->y_parameter) != 0 || strcmp(last->y_unit, cell->y_unit) != 0))
            return csv_table_error(table, i, 0, error, "the parameters differ from those of the row before");
        if (!new_map && map_cell_same_method(last, cell)) continue;
        if (++firsts > STABILITY_MAX_PANELS)
            return csv_table_error(table, i, 0, error, "more than %d methods of maps", STABILITY_MAX_PANELS);
        if (!check_first(table, i, new_map, error)) return false;
    }
    return true;
}

/* The parameter of a study is that of its first row. */
static bool check_border(const CsvTable *table, int i, Error *error) {
    const BorderRow *row = border_row(table, i), *first = table->rows;
    while (strcmp(first->study, row->study) != 0) first++;
    if (strcmp(first->parameter, row->parameter) != 0 || strcmp(first->unit, row->unit) != 0)
        return csv_table_error(table, i, 0, error, "the study '%s' had another parameter before", row->study);
    const char *verdict = verdict_words[row->verdict];
    bool holds = !isnan(row->holds_at), fails = !isnan(row->fails_at);
    if (row->verdict == CELL_NOT_APPLICABLE)
        return (!holds && !fails) || csv_table_error(table, i, 0, error, "'%s' cannot have values", verdict);
    if (!verdict_holds((Verdict)row->verdict)) return true;
    return (holds && !fails) || csv_table_error(table, i, 0, error, "'%s' contradicts the values", verdict);
}

static bool check_borders(const CsvTable *table, Error *error) {
    bool whole = true;
    for (int i = 0; whole && i < table->count; i++) whole = check_border(table, i, error);
    return whole;
}

#define LARGEST 1e30

enum { REASON_SIZE = 2048, VALUE_DIGITS = 9, REST_DIGITS = 4 };

#define TEXT(Row, member, size) CSV_MEMBER(Row, member, CSV_TEXT, .maximum = (size)-1)
#define NAME(Row, member) CSV_MEMBER(Row, member, CSV_NAME)
#define VERDICT(Row) CSV_MEMBER(Row, verdict, CSV_WORD, .words = verdict_words)
#define NUMBER(Row, member, sort, least, most, count) \
    CSV_MEMBER(Row, member, sort, .minimum = least, .maximum = most, .digits = count)
#define COUNT(Row, member, least) NUMBER(Row, member, CSV_INTEGER, least, INT_MAX, 0)

/* The columns that tables of cells begin with. y_sort: whether y may be missing */
#define CELL_COLUMNS(y_sort)                                                                         \
    NAME(MapCell, map), NAME(MapCell, method), TEXT(MapCell, setting, STABILITY_SETTING_SIZE),       \
        NAME(MapCell, x_parameter), NAME(MapCell, x_unit),                                           \
        NUMBER(MapCell, x, CSV_NUMBER, -LARGEST, LARGEST, VALUE_DIGITS), NAME(MapCell, y_parameter), \
        NAME(MapCell, y_unit), NUMBER(MapCell, y, y_sort, -LARGEST, LARGEST, VALUE_DIGITS), VERDICT(MapCell)

static const CsvColumn map_columns[] = {
    CELL_COLUMNS(CSV_NUMBER),
    NUMBER(MapCell, frame, CSV_OPTIONAL, 0, SCENE_MAX_FRAMES, VALUE_DIGITS),
    NUMBER(MapCell, body, CSV_OPTIONAL, -1, SCENE_MAX_BODIES, VALUE_DIGITS),
    NUMBER(MapCell, value, CSV_OPTIONAL, -LARGEST, LARGEST, 0),
    NAME(MapCell, unit),
};

static const CsvColumn unconverged_columns[] = {
    CELL_COLUMNS(CSV_OPTIONAL),
    COUNT(MapCell, steps, 1),
    COUNT(MapCell, not_converged, 1),
    NUMBER(MapCell, residual, CSV_OPTIONAL, 0, LARGEST, REST_DIGITS),
};

/* The columns that these tables begin with. */
#define METHOD_COLUMNS(Row) NAME(Row, study), NAME(Row, method), TEXT(Row, setting, STABILITY_SETTING_SIZE)
#define PARAMETER_COLUMNS(Row) METHOD_COLUMNS(Row), NAME(Row, parameter), NAME(Row, unit)

static const CsvColumn border_columns[] = {
    PARAMETER_COLUMNS(BorderRow),
    NUMBER(BorderRow, holds_at, CSV_OPTIONAL, -LARGEST, LARGEST, VALUE_DIGITS),
    NUMBER(BorderRow, fails_at, CSV_OPTIONAL, -LARGEST, LARGEST, VALUE_DIGITS),
    VERDICT(BorderRow),
};

static const CsvColumn refusal_columns[] = {METHOD_COLUMNS(RefusalRow), TEXT(RefusalRow, reason, REASON_SIZE)};

static const CsvColumn rest_columns[] = {
    PARAMETER_COLUMNS(RunRow),
    NUMBER(RunRow, value, CSV_NUMBER, -LARGEST, LARGEST, VALUE_DIGITS),
    VERDICT(RunRow),
    COUNT(RunRow, steps, 0),
    NUMBER(RunRow, drift, CSV_OPTIONAL, 0, LARGEST, REST_DIGITS),
    NUMBER(RunRow, energy, CSV_OPTIONAL, -LARGEST, LARGEST, REST_DIGITS),
};

static const CsvColumn fallback_columns[] = {
    PARAMETER_COLUMNS(RunRow),      NUMBER(RunRow, value, CSV_NUMBER, -LARGEST, LARGEST, VALUE_DIGITS),
    COUNT(RunRow, steps, 0),        COUNT(RunRow, not_finite, 0),
    COUNT(RunRow, outside_cone, 0), COUNT(RunRow, beyond_training, 0),
    COUNT(RunRow, by_sweeps, 0),
};

static const CsvColumn engine_columns[] = {
    METHOD_COLUMNS(EngineRow),
    TEXT(EngineRow, engine, PROGRAM_NAME_SIZE),
    TEXT(EngineRow, version, PROGRAM_NAME_SIZE),
    COUNT(EngineRow, runs, 0),
    COUNT(EngineRow, failed, 0),
    TEXT(EngineRow, reason, REASON_SIZE),
    NUMBER(EngineRow, differs, CSV_OPTIONAL, -LARGEST, LARGEST, VALUE_DIGITS),
};

const CsvLayout map_layout =
    CSV_LAYOUT("maps", map_columns, MapCell, .max_rows = STABILITY_MAX_CELLS, .check = check_cells);
const CsvLayout border_layout =
    CSV_LAYOUT("stability", border_columns, BorderRow, .max_rows = STABILITY_MAX_BORDERS, .check = check_borders);
const CsvLayout unconverged_layout =
    CSV_LAYOUT("unconverged", unconverged_columns, MapCell, .max_rows = STABILITY_MAX_CELLS);
const CsvLayout refusal_layout = CSV_LAYOUT("refusals", refusal_columns, RefusalRow, .max_rows = STABILITY_MAX_RUNS);
const CsvLayout rest_layout = CSV_LAYOUT("rest", rest_columns, RunRow, .max_rows = STABILITY_MAX_RUNS);
const CsvLayout fallback_layout = CSV_LAYOUT("fallbacks", fallback_columns, RunRow, .max_rows = STABILITY_MAX_RUNS);
const CsvLayout engine_layout = CSV_LAYOUT("engines", engine_columns, EngineRow, .max_rows = STABILITY_MAX_RUNS);
