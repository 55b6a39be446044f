/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/verdict_look.h"

#include <math.h>

/* Blues, then orange to red to black: hues that the colour-blind can distinguish. */
const VerdictLook verdict_looks[VERDICT_LOOKS] = {
    [VERDICT_SETTLES] = {"settles", "#EAF3FA", "#7FA6BF", 7, 0.35},
    [VERDICT_SWAYS] = {"sways", "#CBE2F1", "#2F6C94", 6, 0.8},
    [VERDICT_CREEPS] = {"creeps", "#A3CBE5", "#14486B", 7, 0.8},
    [VERDICT_FALLS] = {"falls", "#EE9A2E", "#3D2000", 11, 1},
    [VERDICT_SINKS] = {"sinks", "#CF6414", "#FFFFFF", 4, 0.9},
    [VERDICT_TUNNELS] = {"tunnels", "#A83232", "#FFFFFF", 12, 1.15},
    [VERDICT_EXPLODES] = {"explodes", "#6E1650", "#FFFFFF", 3, 1.1},
    [VERDICT_NON_FINITE] = {"non-finite", "#140A1C", "#FFFFFF", 2, 0.9},
    [LOOK_NOT_APPLICABLE] = {"not applicable", NULL, "#909090", 0, 1},
    [LOOK_MISSING] = {"not run", NULL, "#909090", -1, 1},
};

/* mm */
static const double most_symbol = 2.0, seam = 0.07, least_with_seam = 1.2, legend_tile = 2.9, name_gap = 1.3;

/* Symbol width relative to a tile's smaller side; diameter of a gnuplot point of size 1 in mm. */
static const double symbol_share = 0.56, point_size_1 = 2.1;

static double tile_side(TileScale scale) { return scale.half > 0 ? 2 * scale.half : fmin(scale.unit_x, scale.unit_y); }

static double symbol_width(TileScale scale) {
    const double room = scale.symbol_room > 0 ? scale.symbol_room : tile_side(scale);
    return fmin(symbol_share * room, most_symbol);
}

/* Seams between small tiles would be most of what is seen. */
static double seam_of(TileScale scale) { return tile_side(scale) < least_with_seam ? 0 : seam; }

static void draw_fills(GnuplotPage *page, const Tile *tiles, int count, int look, TileScale scale) {
    const char *fill = verdict_looks[look].fill;
    double x = (scale.half > 0 ? scale.half / scale.unit_x : 0.5) - seam_of(scale) / scale.unit_x;
    double y = (scale.half > 0 ? scale.half / scale.unit_y : 0.5) - seam_of(scale) / scale.unit_y;
    GnuplotLook bars = {"", {.colour = fill}, 0, false, 1, false};
    gnuplot_series_begin(page);
    for (int i = 0; i < count; i++)
        if (tiles[i].look == look) gnuplot_bar(page, tiles[i].x - x, tiles[i].y - y, tiles[i].x + x, tiles[i].y + y);
    gnuplot_series_end(page, &bars);
}

static void draw_strokes(GnuplotPage *page, const Tile *tiles, int count, int look, TileScale scale) {
    double half = symbol_width(scale) / 2, x = half / scale.unit_x, y = half / scale.unit_y;
    const GnuplotLook line = {"", {.colour = verdict_looks[look].ink, .dashes = "solid"}, 1.2, false, 0, false};
    gnuplot_series_begin(page);
    for (int i = 0; i < count; i++)
        if (tiles[i].look == look && !tiles[i].bare)
            gnuplot_segment(page, tiles[i].x - x, tiles[i].y - y, tiles[i].x + x, tiles[i].y + y);
    gnuplot_series_end(page, &line);
}

static void draw_symbols(GnuplotPage *page, const Tile *tiles, int count, int look, TileScale scale) {
    const VerdictLook *is = &verdict_looks[look];
    const GnuplotLook nothing = {.line = 0};
    gnuplot_series_begin(page);
    for (int i = 0; i < count; i++)
        if (tiles[i].look == look && !tiles[i].bare) gnuplot_point(page, tiles[i].x, tiles[i].y);
    gnuplot_series_end(page, &nothing);
    if (page->points == 0 || page->plot == NULL) return;
    fprintf(page->plot, ", $d%d with points pt %d ps %.3g lw 1.2 lc rgb '%s'", page->block, is->symbol,
            is->size * symbol_width(scale) / point_size_1, is->ink);
}

void verdict_draw_tiles(GnuplotPage *page, const Tile *tiles, int count, TileScale scale) {
    for (int look = 0; look < VERDICT_LOOKS; look++)
        if (verdict_looks[look].fill != NULL) draw_fills(page, tiles, count, look, scale);
    for (int look = 0; look < VERDICT_LOOKS; look++) {
        if (verdict_looks[look].symbol > 0) draw_symbols(page, tiles, count, look, scale);
        if (verdict_looks[look].symbol == 0) draw_strokes(page, tiles, count, look, scale);
    }
}

/* A frame around the legend's sample of a look without fill. */
static void draw_frame(GnuplotPage *page, double x, double y) {
    const GnuplotLook line = {"", {.colour = "#909090", .dashes = "solid"}, 0.6, false, 0, false};
    const double half = legend_tile / 2 - seam;
    gnuplot_series_begin(page);
    for (int i = 0; i <= 4; i++)
        gnuplot_point(page, x + (i % 4 == 0 || i == 3 ? -half : half), y + (i % 4 < 2 ? -half : half));
    gnuplot_series_end(page, &line);
}

int verdict_draw_legend(GnuplotPage *page, const bool used[VERDICT_LOOKS], const LegendPlace *place) {
    Tile tiles[VERDICT_LOOKS];
    int count = 0;
    for (int look = 0; look < VERDICT_LOOKS; look++) {
        if (!used[look]) continue;
        double x = place->left + place->width * (count % place->columns),
               y = place->top - GNUPLOT_LEGEND_ROW * (count / place->columns);
        if (verdict_looks[look].fill == NULL) draw_frame(page, x + legend_tile / 2, y);
        tiles[count++] = (Tile){.x = x + legend_tile / 2, .y = y, .look = look};
        gnuplot_text(page, x + legend_tile + name_gap, y, "left", 7.5, verdict_looks[look].name);
    }
    verdict_draw_tiles(page, tiles, count, (TileScale){.unit_x = 1, .unit_y = 1, .half = legend_tile / 2});
    return count;
}
