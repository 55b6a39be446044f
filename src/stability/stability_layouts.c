/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_table.h"

#include "scene/scene.h"

#include <limits.h>

#define LARGEST 1e30

enum { REASON_SIZE = 2048, VALUE_DIGITS = 9, REST_DIGITS = 4 };

#define TEXT(Row, member, size) \
    { #member, CSV_TEXT, .offset = offsetof(Row, member), .maximum = (size)-1 }
#define NAME(Row, member) \
    { #member, CSV_NAME, .offset = offsetof(Row, member) }
#define VERDICT(Row) \
    { "verdict", CSV_WORD, .offset = offsetof(Row, verdict), .words = verdict_words }
#define NUMBER(Row, member, sort, least, most, count) \
    { #member, sort, .offset = offsetof(Row, member), .minimum = least, .maximum = most, .digits = count }
#define COUNT(member) NUMBER(RunRow, member, CSV_INTEGER, 0, INT_MAX, 0)

static const CsvColumn map_columns[] = {
    NAME(MapCell, map),
    NAME(MapCell, method),
    TEXT(MapCell, setting, STABILITY_SETTING_SIZE),
    NAME(MapCell, x_parameter),
    NAME(MapCell, x_unit),
    NUMBER(MapCell, x, CSV_NUMBER, -LARGEST, LARGEST, VALUE_DIGITS),
    NAME(MapCell, y_parameter),
    NAME(MapCell, y_unit),
    NUMBER(MapCell, y, CSV_NUMBER, -LARGEST, LARGEST, VALUE_DIGITS),
    VERDICT(MapCell),
    NUMBER(MapCell, frame, CSV_OPTIONAL, 0, SCENE_MAX_FRAMES, VALUE_DIGITS),
    NUMBER(MapCell, body, CSV_OPTIONAL, -1, SCENE_MAX_BODIES, VALUE_DIGITS),
    NUMBER(MapCell, value, CSV_OPTIONAL, -LARGEST, LARGEST, 0),
    NAME(MapCell, unit),
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
    COUNT(steps),
    NUMBER(RunRow, drift, CSV_OPTIONAL, 0, LARGEST, REST_DIGITS),
    NUMBER(RunRow, energy, CSV_OPTIONAL, -LARGEST, LARGEST, REST_DIGITS),
};

static const CsvColumn fallback_columns[] = {
    PARAMETER_COLUMNS(RunRow),
    NUMBER(RunRow, value, CSV_NUMBER, -LARGEST, LARGEST, VALUE_DIGITS),
    COUNT(steps),
    COUNT(not_finite),
    COUNT(outside_cone),
    COUNT(beyond_training),
    COUNT(by_sweeps),
};

const CsvLayout map_layout = CSV_LAYOUT("maps", map_columns, MapCell, .max_rows = STABILITY_MAX_CELLS);
const CsvLayout border_layout = CSV_LAYOUT("stability", border_columns, BorderRow, .max_rows = STABILITY_MAX_BORDERS);
const CsvLayout refusal_layout = CSV_LAYOUT("refusals", refusal_columns, RefusalRow, .max_rows = STABILITY_MAX_RUNS);
const CsvLayout rest_layout = CSV_LAYOUT("rest", rest_columns, RunRow, .max_rows = STABILITY_MAX_RUNS);
const CsvLayout fallback_layout = CSV_LAYOUT("fallbacks", fallback_columns, RunRow, .max_rows = STABILITY_MAX_RUNS);
