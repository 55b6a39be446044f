/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/verdict_look.h"

#include <math.h>

/* Blues, then orange to red to black: hues that the colour-blind can distinguish. */
const VerdictLook verdict_looks[VERDICT_LOOKS] = {
    [VERDICT_SETTLES] = {"settles", 0xEAF3FA, 0x7FA6BF, METHOD_CIRCLE, false, 0.35},
    [VERDICT_SWAYS] = {"sways", 0xCBE2F1, 0x2F6C94, METHOD_CIRCLE, true, 0.8},
    [VERDICT_CREEPS] = {"creeps", 0xA3CBE5, 0x14486B, METHOD_CIRCLE, false, 0.8},
    [VERDICT_FALLS] = {"falls", 0xEE9A2E, 0x3D2000, METHOD_INVERTED_TRIANGLE, false, 0.9},
    [VERDICT_SINKS] = {"sinks", 0xCF6414, 0xFFFFFF, METHOD_SQUARE, true, 0.9},
    [VERDICT_TUNNELS] = {"tunnels", 0xA83232, 0xFFFFFF, METHOD_DIAMOND, true, 0.95},
    [VERDICT_EXPLODES] = {"explodes", 0x6E1650, 0xFFFFFF, PLOT_STAR, false, 1.1},
    [VERDICT_NON_FINITE] = {"non-finite", 0x140A1C, 0xFFFFFF, PLOT_CROSS, false, 1.1},
    [LOOK_NOT_APPLICABLE] = {"not applicable", NO_COLOUR, 0x909090, VERDICT_STROKE, false, 1},
    [LOOK_MISSING] = {"not run", NO_COLOUR, 0x909090, VERDICT_BARE, false, 1},
};

/* mm. Seams between small tiles would be most of what is seen; these overlap instead, as half-covered pixels would let the
   page through. */
static const double most_symbol = 2.0, seam = 0.07, overlap = 0.02, least_with_seam = 1.2, legend_tile = 2.9,
                    name_gap = 1.3;

/* Symbol width relative to a tile's smaller side. */
static const double symbol_share = 0.56;

static double symbol_width(TileSize size) {
    const double room = size.symbol_room > 0 ? size.symbol_room : fmin(size.width, size.height);
    return fmin(symbol_share * room, most_symbol);
}

static void draw_symbol(Sketch *sketch, const Tile *tile, double width) {
    const VerdictLook *look = &verdict_looks[tile->look];
    const PlotStyle style = {.symbol = look->symbol, .open = look->open, .colour = look->ink};
    const double half = width / 2;
    const Pen pen = pen_line(look->ink, 1.2, NULL);
    if (look->symbol == VERDICT_STROKE)
        sketch_line(sketch, (Point){tile->at.x - half, tile->at.y - half},
                    (Point){tile->at.x + half, tile->at.y + half}, &pen);
    else if (look->symbol != VERDICT_BARE)
        plot_mark(sketch, tile->at, &style, look->size * half, 1.2);
}

void verdict_draw_tiles(Sketch *sketch, const Tile *tiles, int count, TileSize size) {
    const double inside = fmin(size.width, size.height) < least_with_seam ? -overlap : seam;
    const double x = size.width / 2 - inside, y = size.height / 2 - inside;
    for (int i = 0; i < count; i++) {
        const Point at = tiles[i].at;
        const uint32_t fill = verdict_looks[tiles[i].look].fill;
        if (fill == NO_COLOUR) continue;
        sketch_rectangle(sketch, (Point){at.x - x, at.y - y}, (Point){at.x + x, at.y + y},
                         &(Pen){fill, 1, NO_COLOUR, 0, NULL});
    }
    for (int i = 0; i < count; i++)
        if (!tiles[i].bare) draw_symbol(sketch, &tiles[i], symbol_width(size));
}

int verdict_draw_legend(Sketch *sketch, const bool used[VERDICT_LOOKS], const LegendPlace *place) {
    const Pen frame = pen_line(0x909090, 0.6, NULL); /* around a look without fill */
    const double half = legend_tile / 2 - seam;
    Tile tiles[VERDICT_LOOKS];
    int count = 0;
    for (int look = 0; look < VERDICT_LOOKS; look++) {
        if (!used[look]) continue;
        const double left = place->left + place->width * (count % place->columns);
        const Point at = {left + legend_tile / 2, place->top - LEGEND_ROW * (count / place->columns)};
        if (verdict_looks[look].fill == NO_COLOUR)
            sketch_rectangle(sketch, (Point){at.x - half, at.y - half}, (Point){at.x + half, at.y + half}, &frame);
        tiles[count++] = (Tile){.at = at, .look = look};
        plot_text(sketch, (Point){left + legend_tile + name_gap, at.y}, TEXT_LEFT, LEGEND_POINTS,
                  verdict_looks[look].name);
    }
    verdict_draw_tiles(sketch, tiles, count, (TileSize){.width = legend_tile, .height = legend_tile});
    return count;
}
