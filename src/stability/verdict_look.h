/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How verdicts are drawn: a tile with a symbol. Worse is darker, readable in grey and for the colour-blind; holding is
   light and round, failing dark and angular, readable in black and white. */
#pragma once
#include "sketch/plot.h"
#include "stability/verdict.h"

/* Continues Verdict: cells without a verdict. */
enum { LOOK_NOT_APPLICABLE = VERDICTS, LOOK_MISSING, VERDICT_LOOKS };

typedef struct VerdictLook {
    const char *name;
    uint32_t fill; /* of the tile; NO_COLOUR: none */
    uint32_t ink;  /* of the symbol */
    int symbol;    /* of a PlotStyle; VERDICT_STROKE: a stroke across; VERDICT_BARE: none */
    bool open;
    double size; /* of the symbol, relative */
} VerdictLook;

enum { VERDICT_STROKE = PLOT_SYMBOLS, VERDICT_BARE };

extern const VerdictLook verdict_looks[VERDICT_LOOKS];

/* mm: the size of tiles. */
typedef struct TileSize {
    double width, height;
    double symbol_room; /* what a symbol may take; 0: its tile */
} TileSize;

typedef struct Tile {
    Point at; /* centre */
    int look;
    bool bare; /* without its symbol */
} Tile;

/* Draws all fills, then all symbols. */
void verdict_draw_tiles(Sketch *sketch, const Tile *tiles, int count, TileSize size);

/* The grid of a legend's items, row by row; rows are LEGEND_ROW apart. */
typedef struct LegendPlace {
    double left, top, width; /* mm: left edge and centre height of the first item; column width */
    int columns;
} LegendPlace;

/* Draws tiles and names of the used looks. Returns their number. */
int verdict_draw_legend(Sketch *sketch, const bool used[VERDICT_LOOKS], const LegendPlace *place);
