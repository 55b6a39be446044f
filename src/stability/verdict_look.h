/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How verdicts are drawn: a tile with a symbol. Worse is darker, readable in grey and for the colour-blind; holding is
   light and round, failing dark and angular, readable in black and white. */
#pragma once
#include "chart/gnuplot_page.h"
#include "stability/verdict.h"

/* Continues Verdict: cells without a verdict. */
enum { LOOK_NOT_APPLICABLE = VERDICTS, LOOK_MISSING, VERDICT_LOOKS };

typedef struct VerdictLook {
    const char *name;
    const char *fill; /* of the tile; NULL: none */
    const char *ink;  /* of the symbol */
    int symbol;       /* gnuplot's; 0: a stroke across, -1: none */
    double size;      /* of the symbol, relative */
} VerdictLook;

extern const VerdictLook verdict_looks[VERDICT_LOOKS];

/* The size of tiles on a panel with linear axes. */
typedef struct TileScale {
    double unit_x, unit_y; /* mm of the page that one unit of the axis takes */
    double half;           /* mm: half a tile's side; 0: a tile fills its unit */
    double symbol_room;    /* mm: what a symbol may take; 0: its tile */
} TileScale;

/* x, y: centre, on the panel's axes. */
typedef struct Tile {
    double x, y;
    int look;
    bool bare; /* without its symbol */
} Tile;

/* Draws tiles on the open panel: all fills, then all symbols. */
void verdict_draw_tiles(GnuplotPage *page, const Tile *tiles, int count, TileScale scale);

/* The grid of a legend's items, row by row; rows are GNUPLOT_LEGEND_ROW apart. */
typedef struct LegendPlace {
    double left, top, width; /* mm: left edge and centre height of the first item; column width */
    int columns;
} LegendPlace;

/* Draws tiles and names of the used looks on a panel in mm. Returns their number. */
int verdict_draw_legend(GnuplotPage *page, const bool used[VERDICT_LOOKS], const LegendPlace *place);
