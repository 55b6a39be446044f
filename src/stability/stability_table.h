/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The two tables of a stability study: maps.csv, a row a cell, and stability.csv, a row a border. */
#pragma once
#include "chart/csv_columns.h"
#include "stability/verdict_look.h"

enum { STABILITY_MAX_CELLS = 40000, STABILITY_MAX_BORDERS = 2000, STABILITY_MAX_PANELS = 512 };

/* A cell of a map. Names are plain (chart_plain); a setting is as it was given, and may be the path of a network. */
typedef struct MapCell {
    char map[CSV_NAME_SIZE], method[CSV_NAME_SIZE], setting[CSV_TEXT_SIZE];
    char x_parameter[CSV_NAME_SIZE], x_unit[CSV_NAME_SIZE];
    char y_parameter[CSV_NAME_SIZE], y_unit[CSV_NAME_SIZE];
    double x, y;
    int verdict;               /* a Verdict, or LOOK_NOT_APPLICABLE */
    double frame, body, value; /* of a VerdictReading; NAN where there is none */
    char unit[CSV_NAME_SIZE];
} MapCell;

/* A border of a method: the last value that holds and the first that fails, how. */
typedef struct BorderRow {
    char study[CSV_NAME_SIZE], method[CSV_NAME_SIZE], setting[CSV_TEXT_SIZE];
    char parameter[CSV_NAME_SIZE], unit[CSV_NAME_SIZE];
    double holds_at; /* NAN: nothing holds */
    double
        fails_at; /* NAN: nothing fails for sure: where the verdict is one of failing, luck decides beyond holds_at */
    int verdict;  /* how it fails; of what holds over the whole range, how it holds; or LOOK_NOT_APPLICABLE */
} BorderRow;

typedef struct MapTable {
    char path[512];
    int count;
    MapCell *cells; /* [count] */
} MapTable;

typedef struct BorderTable {
    char path[512];
    int count;
    BorderRow *rows; /* [count] */
} BorderTable;

/* Reads folder/maps.csv; one without rows has no cells. Refused, as "path:line:column: error: what": what
   csv_columns_read() refuses, a map whose name is no file name, maps, or methods of a map, whose rows do not stand
   together, and more than STABILITY_MAX_PANELS of these. */
bool map_table_read(MapTable *table, const char *folder, Error *error);
void map_table_free(MapTable *table);

/* Reads folder/stability.csv. Refused likewise: rows that give a study another parameter, and verdicts that do not fit
   their values: what fails somewhere cannot hold, and what is not applicable has no values. */
bool border_table_read(BorderTable *table, const char *folder, Error *error);
void border_table_free(BorderTable *table);

/* An error about row `row`, from 0, of such a table. Returns false. */
bool stability_row_error(const char *path, int row, Error *error, const char *format, ...) PRINTF_LIKE(4, 5);

/* A cell's method as method_parse() takes it: "engine:k=10". */
enum { MAP_METHOD_SIZE = CSV_NAME_SIZE + CSV_TEXT_SIZE };
void map_cell_method(char method[MAP_METHOD_SIZE], const MapCell *cell);

/* Where the clip of a cell goes, from the tables' folder, without an ending: "clips/MAP-METHOD-X_Y". */
enum { MAP_CLIP_SIZE = CSV_NAME_SIZE + MAP_METHOD_SIZE + 40 };
void map_cell_clip(char name[MAP_CLIP_SIZE], const MapCell *cell);

/* True where both cells are of the same method and setting. */
bool map_cell_same_method(const MapCell *a, const MapCell *b);

/* "engine, k=10, warm=off", plain, of at most so many characters, of a path its last part alone; and "Height (boxes)",
   for an axis. */
enum { STABILITY_TEXT_SIZE = CSV_NAME_SIZE + 2 * CSV_TEXT_SIZE + 8 };
void stability_method_text(char text[STABILITY_TEXT_SIZE], size_t most, const char *method, const char *setting);
void stability_axis_text(char text[STABILITY_TEXT_SIZE], const char *parameter, const char *unit);
