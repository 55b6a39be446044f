/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tables of a stability study: their rows and layouts (csv/csv_table.h), used by the study, the figures and the
   command line. Names are plain (csv_plain_length); a setting is stored as given and may contain the path of a network. */
#pragma once
#include "csv/csv_table.h"
#include "stability/verdict_look.h"

enum {
    STABILITY_MAX_CELLS = 200000,
    STABILITY_MAX_BORDERS = 2000,
    STABILITY_MAX_RUNS = 100000,
    STABILITY_MAX_PANELS = 512,
    STABILITY_SETTING_SIZE = 128
};

/* maps.csv: a cell of a map. */
typedef struct MapCell {
    const char *map, *method, *setting, *x_parameter, *x_unit, *y_parameter, *y_unit;
    double x, y;
    int verdict;               /* a Verdict, or LOOK_NOT_APPLICABLE */
    double frame, body, value; /* as in VerdictReading, or NAN */
    const char *unit;
} MapCell;

/* stability.csv: a border of a method: the last value that holds and the first that fails. */
typedef struct BorderRow {
    const char *study, *method, *setting, *parameter, *unit;
    double holds_at; /* NAN: nothing holds */
    double fails_at; /* NAN: no decided value fails; with a failing verdict, values beyond holds_at are undecided */
    int verdict;     /* how it fails; if it holds over the whole range, how it holds; or LOOK_NOT_APPLICABLE */
} BorderRow;

/* refusals.csv: why a method does not apply. */
typedef struct RefusalRow {
    const char *study, *method, *setting, *reason;
} RefusalRow;

/* rest.csv and fallbacks.csv: a run without a shift, at a value of the parameter. */
typedef struct RunRow {
    const char *study, *method, *setting, *parameter, *unit;
    double value;
    int steps;
    int verdict;                                              /* rest.csv */
    double drift, energy;                                     /* rest.csv: VerdictReading's drift and gained, or NAN */
    int not_finite, outside_cone, beyond_training, by_sweeps; /* fallbacks.csv: as in NetworkFallbacks */
} RunRow;

extern const CsvLayout map_layout, border_layout, refusal_layout, rest_layout, fallback_layout;

typedef struct MapTable {
    CsvTable csv;
    int count;
    const MapCell *cells; /* [count] */
} MapTable;

typedef struct BorderTable {
    CsvTable csv;
    int count;
    const BorderRow *rows; /* [count] */
} BorderTable;

/* Reads folder/maps.csv; without rows there are no cells. Refused, as "path:line:column: error: reason": what
   csv_table_read() refuses, a map whose name is not a file name, maps (or methods of a map) whose rows are not
   together, and more than STABILITY_MAX_PANELS methods of maps. */
bool map_table_read(MapTable *table, const char *folder, Error *error);
void map_table_free(MapTable *table);

/* Reads folder/stability.csv. Refused likewise: rows that give a study another parameter, and verdicts that contradict
   their values: a method that fails somewhere cannot hold, and one that does not apply has no values. */
bool border_table_read(BorderTable *table, const char *folder, Error *error);
void border_table_free(BorderTable *table);

bool border_same_method(const BorderRow *a, const BorderRow *b);
bool border_same_study(const BorderRow *a, const BorderRow *b);

/* A cell's method as for method_parse(): "engine:k=10". */
enum { MAP_METHOD_SIZE = CSV_NAME_SIZE + STABILITY_SETTING_SIZE };
void map_cell_method(char method[MAP_METHOD_SIZE], const MapCell *cell);

/* The path of a cell's clip, relative to the tables' folder and without extension: "clips/MAP-METHOD-X_Y". */
enum { MAP_CLIP_SIZE = CSV_NAME_SIZE + MAP_METHOD_SIZE + 40 };
void map_cell_clip(char name[MAP_CLIP_SIZE], const MapCell *cell);

bool map_cell_same_method(const MapCell *a, const MapCell *b);

/* For figures: "engine:k=10,warm=off" (common/method_look.h), plain and shortened to `most` mm; and
   "Height (boxes)" for an axis. */
enum { STABILITY_TEXT_SIZE = CSV_NAME_SIZE + 2 * STABILITY_SETTING_SIZE + 8 };
void stability_method_text(char text[STABILITY_TEXT_SIZE], double points, double most, const char *method,
                           const char *setting);
void stability_axis_text(char text[STABILITY_TEXT_SIZE], const char *parameter, const char *unit);
