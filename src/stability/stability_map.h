/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figure of a stability map: one panel per method, one tile per cell. */
#pragma once
#include "sketch/plot_page.h"
#include "stability/stability_table.h"

enum { MAP_MAX_VALUES = 128, MAP_MAX_METHODS = 24 };

/* A map's cells, arranged by method, x and y. */
typedef struct MapPanels {
    const MapCell *first; /* row of the map; the table outlives the map */
    int x_count, y_count, panel_count;
    double x[MAP_MAX_VALUES], y[MAP_MAX_VALUES]; /* values of all methods, ascending */
    const MapCell *methods[MAP_MAX_METHODS];     /* first row of each */
    unsigned char looks[MAP_MAX_METHODS][MAP_MAX_VALUES]
                       [MAP_MAX_VALUES]; /* [panel][x][y]; LOOK_MISSING without a row */
} MapPanels;

/* Gathers the map whose rows start at *row and advances *row past them. ERROR_INPUT, with path:line:column: a repeated
   cell, more than MAP_MAX_VALUES values or MAP_MAX_METHODS methods. */
bool map_panels_gather(MapPanels *map, const MapTable *table, int *row, Error *error);

/* Writes the figure and its caption. All cells have the same size; ticks show their values. */
void map_panels_write(const MapPanels *map, PlotPage *page);
