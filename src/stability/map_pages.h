/* SPDX-License-Identifier: GPL-3.0-or-later */
/* map_pages.csv: which cells of the maps have a page that plays what happened there. */
#pragma once
#include "stability/stability_map.h"

/* Of a method in a map. */
enum { MAP_PAGES_EACH = 8 };

typedef struct MapPage {
    const char *map, *method, *setting; /* of the cell, as in maps.csv */
    double x, y;
    double time;      /* s: when the verdict was decided */
    int frame, body;  /* in the run; body -1: none */
    const char *page; /* "pages/NAME.html#t=0.55&body=7&run=1"; empty: left out */
    int bytes;
} MapPage;

extern const CsvLayout map_page_layout;

/* Places in a map; x, y: indices of its values. */
typedef struct MapPlace {
    int x, y;
} MapPlace;

/* The cells of a method that get a page: those that fail beside one that holds, at a border, are the ones that tell why; at
   most MAP_PAGES_EACH of them, evenly. Without a border, the first that fails. Returns their number. */
int map_pages_choose(const MapPanels *map, int panel, MapPlace places[MAP_PAGES_EACH]);

/* The row of a cell; NULL: none. */
const MapCell *map_panels_cell(const MapPanels *map, const MapTable *table, int panel, MapPlace place);
