/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A cell of a stability map, as named on the command line. */
#pragma once
#include "simulate/method.h"
#include "stability/stability_table.h"

/* "MAP:METHOD:X,Y". The method may have settings, so it goes up to the last ':'. */
typedef struct StabilityCell {
    char map[CSV_NAME_SIZE], method[METHOD_TEXT_SIZE];
    double x, y;
} StabilityCell;

bool stability_cell_parse(StabilityCell *cell, const char *text, Error *error);

/* The row of the table that the cell names. Numbers may be rounded as in the figure: the nearest within 1% counts. NULL
   with error set if there is none; the error lists the known values. */
const MapCell *stability_cell_find(const MapTable *table, const StabilityCell *cell, Error *error);

/* The first method that holds in the same cell, or NULL. */
const MapCell *stability_cell_holder(const MapTable *table, const MapCell *row);
