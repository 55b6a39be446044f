/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a verdict looks like: a tile with a symbol. The worse, the darker, so that the order reads in grey and for the
   colour-blind; what holds is light and round, what fails is dark and angular, so that it reads in black and white. */
#pragma once
#include "chart/figure_page.h"
#include "stability/verdict.h"

/* Behind the verdicts: cells that have none. */
enum { LOOK_NOT_APPLICABLE = VERDICTS, LOOK_MISSING, VERDICT_LOOKS };

typedef struct VerdictLook {
    const char *name;
    const char *fill; /* of the tile; NULL: none */
    const char *ink;  /* of the symbol */
    int symbol;       /* gnuplot's; 0: a stroke across, -1: none */
    double size;      /* of the symbol, over that of the largest */
} VerdictLook;

extern const VerdictLook verdict_looks[VERDICT_LOOKS];

/* How large tiles are, on a panel with linear axes. */
typedef struct TileScale {
    double unit_x, unit_y; /* mm of the page that one unit of the axis takes */
    double half;           /* of a tile's side, mm; 0: it fills its unit */
} TileScale;

/* A tile's place, on the panel's axes. */
typedef struct Tile {
    double x, y;
    int look;
} Tile;

/* Draws tiles upon the open panel: all fills, then all symbols. */
void verdict_put_tiles(FigurePage *page, const Tile *tiles, int count, TileScale scale);

/* Where a legend's items go: row by row, FIGURE_LEGEND_ROW apart. */
typedef struct LegendPlace {
    double left, top, width; /* mm: left edge and middle of the first; from column to column */
    int columns;
} LegendPlace;

/* Puts tiles and names of the looks that are used upon a panel in mm. Returns how many. */
int verdict_put_legend(FigurePage *page, const bool used[VERDICT_LOOKS], const LegendPlace *place);
