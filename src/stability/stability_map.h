/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A map of where each method fails: a panel a method, a tile a cell. */
#pragma once
#include "chart/gnuplot_page.h"
#include "stability/stability_table.h"

enum { MAP_MAX_VALUES = 64, MAP_MAX_METHODS = 24 };

/* A map's cells in place. */
typedef struct MapPanels {
    const MapCell *first; /* of its rows; the table outlives the map */
    int x_count, y_count, panel_count;
    double x[MAP_MAX_VALUES], y[MAP_MAX_VALUES]; /* the values that any method has, rising */
    const MapCell *methods[MAP_MAX_METHODS];     /* the first row of each */
    unsigned char looks[MAP_MAX_METHODS][MAP_MAX_VALUES]
                       [MAP_MAX_VALUES]; /* [panel][x][y]; LOOK_MISSING without a row */
} MapPanels;

/* Gathers the map whose rows begin at *row, and moves *row behind them. Refused, with path:line:column: a cell that is
   there twice, more than MAP_MAX_VALUES values or MAP_MAX_METHODS methods. */
bool map_panels_gather(MapPanels *map, const MapTable *table, int *row, Error *error);

/* Writes the figure and its caption. Cells are equally large, whatever their values: these are the tics. */
void map_panels_write(const MapPanels *map, GnuplotPage *page);
