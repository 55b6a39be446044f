/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/border_marks.h"

#include <math.h>
#include <string.h>

/* mm; half_tile, half_sign: from the centre of a tile, arrow head or cross to its edge */
static const double bar_height = 1.2, half_tile = 1.15, half_sign = 0.75;

static const Pen bar_pen = {0xA3CBE5, 1, NO_COLOUR, 0, NULL}, sign_pen = {NO_COLOUR, 1, 0x000000, 1.6, NULL};

static bool holds_throughout(const BorderRow *row) {
    return isnan(row->fails_at) && !isnan(row->holds_at) && verdict_holds((Verdict)row->verdict);
}

static bool never_holds(const BorderRow *row) { return isnan(row->holds_at) && !isnan(row->fails_at); }

static double place_of(const BorderRows *rows, double value) { return plot_axis_place(&rows->panel->x, value); }

/* The other end of the bar that starts at a border: the next border of the same method in that direction, or the
   panel's edge. */
static double far_end(const BorderRows *rows, const BorderRow *row, bool low) {
    double end = low ? rows->panel->x.from : rows->panel->x.to, from = place_of(rows, row->holds_at);
    for (int i = 0; i < rows->table->count; i++) {
        const BorderRow *other = &rows->table->rows[i];
        if (other == row || !border_same_study(other, row) || !border_same_method(other, row)) continue;
        double place = place_of(rows, other->holds_at);
        if (low ? place <= from && place > end : place >= from && place < end) end = place;
    }
    return end;
}

static void put_bar(Sketch *sketch, double from, double to, double y) {
    sketch_rectangle(sketch, (Point){fmin(from, to), y - bar_height / 2}, (Point){fmax(from, to), y + bar_height / 2},
                     &bar_pen);
}

static void draw_bar(const BorderRows *rows, const BorderRow *row, double y) {
    if (isnan(row->holds_at)) return;
    if (holds_throughout(row)) {
        put_bar(rows->sketch, rows->panel->x.from, rows->panel->x.to, y);
        return;
    }
    const bool low = isnan(row->fails_at) ? !rows->falling : row->holds_at < row->fails_at;
    put_bar(rows->sketch, far_end(rows, row, low), place_of(rows, row->holds_at), y);
}

/* An arrow head. */
static void put_head(Sketch *sketch, Point tip, bool to_the_left) {
    const double back = tip.x + (to_the_left ? 2 : -2) * half_sign;
    sketch_path(sketch, (const Point[]){{back, tip.y + half_sign}, tip, {back, tip.y - half_sign}}, 3, &sign_pen);
}

static void put_cross(Sketch *sketch, Point at) {
    for (int up = -1; up <= 1; up += 2)
        sketch_line(sketch, (Point){at.x - half_sign, at.y - up * half_sign},
                    (Point){at.x + half_sign, at.y + up * half_sign}, &sign_pen);
}

/* In the margin next to the study's easiest value, or to its hardest one. */
static double margin_of(const BorderRows *rows, bool easy) {
    const PlotAxis *axis = &rows->panel->x;
    return easy == rows->falling ? axis->to - BORDER_AXIS_ROOM / 2 : axis->from + BORDER_AXIS_ROOM / 2;
}

/* Without fails_at: in the margin, as all values beyond holds_at are undecided. */
static double tile_place(const BorderRows *rows, const BorderRow *row) {
    return isnan(row->fails_at) ? margin_of(rows, isnan(row->holds_at)) : place_of(rows, row->fails_at);
}

static void draw_sign(const BorderRows *rows, const BorderRow *row, double y) {
    const double tip = rows->falling ? rows->panel->x.from + half_sign : rows->panel->x.to - half_sign;
    if (holds_throughout(row)) put_head(rows->sketch, (Point){tip, y}, rows->falling);
    if (never_holds(row)) put_cross(rows->sketch, (Point){margin_of(rows, true), y});
}

static double height_of(const BorderRows *rows, const BorderRow *row) {
    int i = 0;
    while (!border_same_method(&rows->table->rows[rows->methods[i]], row)) i++;
    return plot_axis_place(&rows->panel->y, i);
}

static void draw_each(const BorderRows *rows, void (*put)(const BorderRows *, const BorderRow *, double)) {
    for (int i = 0; i < rows->table->count; i++) {
        const BorderRow *row = &rows->table->rows[i];
        if (border_same_study(row, rows->study)) put(rows, row, height_of(rows, row));
    }
}

static void draw_tile(const BorderRows *rows, const BorderRow *row, double y) {
    const Tile tile = {.at = {tile_place(rows, row), y}, .look = row->verdict};
    if (holds_throughout(row)) return;
    verdict_draw_tiles(rows->sketch, &tile, 1, (TileSize){.width = 2 * half_tile, .height = 2 * half_tile});
}

void border_marks_draw(const BorderRows *rows) {
    draw_each(rows, draw_bar);
    draw_each(rows, draw_tile);
    draw_each(rows, draw_sign);
}

void border_sample_draw(Sketch *sketch, int sign, Point left, double width) {
    if (sign < 2) put_bar(sketch, left.x, left.x + width, left.y);
    if (sign == 1) put_head(sketch, (Point){left.x + width, left.y}, false);
    if (sign == 2) put_cross(sketch, (Point){left.x + width / 2, left.y});
}
