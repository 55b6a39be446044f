/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A cell of a map of stability, as it is named on the command line. */
#pragma once
#include "simulate/method.h"
#include "stability/stability_table.h"

/* "MAP:METHOD:X,Y". The method may have settings, so it goes up to the last ':'. */
typedef struct StabilityCell {
    char map[CSV_NAME_SIZE], method[METHOD_TEXT_SIZE];
    double x, y;
} StabilityCell;

bool stability_cell_parse(StabilityCell *cell, const char *text, Error *error);

/* The row of the table that the cell names: numbers may be as short as the figure has them, within 1%; the nearest counts.
   NULL with error set, which names what there is, where there is none. */
const MapCell *stability_cell_find(const MapTable *table, const StabilityCell *cell, Error *error);

/* The first method that holds in the same cell, or NULL. */
const MapCell *stability_cell_holder(const MapTable *table, const MapCell *row);
