/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/border_marks.h"

#include <math.h>
#include <string.h>

/* mm; half_tile, half_sign: from the centre of a tile, arrow head or cross to its edge */
static const double bar_height = 1.2, half_tile = 1.15, half_sign = 0.75;

static const GnuplotLook bar_look = {"", {.colour = "#A3CBE5"}, 0, false, 1, false};
static const GnuplotLook sign_look = {"", {.colour = "black", .dashes = "solid"}, 1.6, false, 0, false};

static bool holds_throughout(const BorderRow *row) {
    return isnan(row->fails_at) && !isnan(row->holds_at) && verdict_holds((Verdict)row->verdict);
}

static bool never_holds(const BorderRow *row) { return isnan(row->holds_at) && !isnan(row->fails_at); }

/* The other end of the bar that starts at a border: the next border of the same method in that direction, or the
   panel's edge. */
static double far_end(const BorderRows *rows, const BorderRow *row, bool low) {
    double end = low ? 0 : rows->axis->width, from = border_axis_place(rows->axis, row->holds_at);
    for (int i = 0; i < rows->table->count; i++) {
        const BorderRow *other = &rows->table->rows[i];
        if (other == row || !border_same_study(other, row) || !border_same_method(other, row)) continue;
        double place = border_axis_place(rows->axis, other->holds_at);
        if (low ? place <= from && place > end : place >= from && place < end) end = place;
    }
    return end;
}

static void draw_bar(const BorderRows *rows, const BorderRow *row, int y) {
    if (isnan(row->holds_at)) return;
    bool whole = holds_throughout(row);
    double half = bar_height / 2 / rows->height;
    bool low = isnan(row->fails_at) ? !rows->axis->falling : row->holds_at < row->fails_at;
    double from = whole ? 0 : far_end(rows, row, low);
    double to = whole ? rows->axis->width : border_axis_place(rows->axis, row->holds_at);
    gnuplot_bar(rows->page, fmin(from, to), y - half, fmax(from, to), y + half);
}

/* An arrow head with its tip at x. `up`: axis units per mm. */
static void draw_head(GnuplotPage *page, double x, double y, double up, bool to_the_left) {
    double back = x + (to_the_left ? 2 : -2) * half_sign;
    gnuplot_point(page, back, y + half_sign * up);
    gnuplot_point(page, x, y);
    gnuplot_point(page, back, y - half_sign * up);
    gnuplot_gap(page);
}

static void draw_cross(GnuplotPage *page, double x, double y, double up) {
    gnuplot_segment(page, x - half_sign, y - half_sign * up, x + half_sign, y + half_sign * up);
    gnuplot_segment(page, x - half_sign, y + half_sign * up, x + half_sign, y - half_sign * up);
}

/* In the margin next to the study's easiest value. */
static double easy_end(const BorderAxis *axis) {
    return axis->falling ? axis->width - BORDER_AXIS_ROOM / 2 : BORDER_AXIS_ROOM / 2;
}

/* Without fails_at: in the margin, as all values beyond holds_at are undecided. */
static double tile_place(const BorderAxis *axis, const BorderRow *row) {
    if (!isnan(row->fails_at)) return border_axis_place(axis, row->fails_at);
    return isnan(row->holds_at) ? easy_end(axis) : axis->width - easy_end(axis);
}

static void draw_sign(const BorderRows *rows, const BorderRow *row, int y) {
    const BorderAxis *axis = rows->axis;
    double tip = axis->falling ? half_sign : axis->width - half_sign;
    if (holds_throughout(row)) draw_head(rows->page, tip, y, 1 / rows->height, axis->falling);
    if (never_holds(row)) draw_cross(rows->page, easy_end(axis), y, 1 / rows->height);
}

static int height_of(const BorderRows *rows, const BorderRow *row) {
    int i = 0;
    while (!border_same_method(&rows->table->rows[rows->methods[i]], row)) i++;
    return rows->method_count - 1 - i;
}

static void draw_each(const BorderRows *rows, void (*put)(const BorderRows *, const BorderRow *, int),
                      const GnuplotLook *look) {
    gnuplot_series_begin(rows->page);
    for (int i = 0; i < rows->table->count; i++) {
        const BorderRow *row = &rows->table->rows[i];
        if (border_same_study(row, rows->study)) put(rows, row, height_of(rows, row));
    }
    gnuplot_series_end(rows->page, look);
}

static void draw_tiles(const BorderRows *rows) {
    Tile tiles[STABILITY_MAX_BORDERS];
    int count = 0;
    for (int i = 0; i < rows->table->count; i++) {
        const BorderRow *row = &rows->table->rows[i];
        if (!border_same_study(row, rows->study) || holds_throughout(row)) continue;
        tiles[count++] = (Tile){.x = tile_place(rows->axis, row), .y = height_of(rows, row), .look = row->verdict};
    }
    verdict_draw_tiles(rows->page, tiles, count, (TileScale){.unit_x = 1, .unit_y = rows->height, .half = half_tile});
}

void border_marks_draw(const BorderRows *rows) {
    draw_each(rows, draw_bar, &bar_look);
    draw_tiles(rows);
    draw_each(rows, draw_sign, &sign_look);
}

void border_sample_draw(GnuplotPage *page, int sign, double x, double y, double width) {
    gnuplot_series_begin(page);
    if (sign < 2) gnuplot_bar(page, x, y - bar_height / 2, x + width, y + bar_height / 2);
    gnuplot_series_end(page, &bar_look);
    gnuplot_series_begin(page);
    if (sign == 1) draw_head(page, x + width, y, 1, false);
    if (sign == 2) draw_cross(page, x + width / 2, y, 1);
    gnuplot_series_end(page, &sign_look);
}
