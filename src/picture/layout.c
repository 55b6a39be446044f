/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/layout.h"

#include <math.h>

/* All sizes are shares of this, so that pictures of every resolution look alike. Portrait pictures count by
   their width, or their header would not fit. */
static double base_unit(int width, int height) { return fmin(height, 0.75 * width); }

/* Below this even the smallest font would fill the picture. */
static const double LEAST_TEXT_UNIT = 300;
static const double LEAST_PIXELS = 10; /* an em */
static const double LEAST_MARGIN = 4;  /* pixels */
static const double TIMELINE = 0.16;   /* height of its curves */

static void pick_fonts(Layout *layout, double unit) {
    if (unit < LEAST_TEXT_UNIT) return;
    layout->scene = font_pick(FONT_SEMIBOLD, fmax(0.0300 * unit, LEAST_PIXELS));
    layout->status = font_pick(FONT_REGULAR, fmax(0.0225 * unit, LEAST_PIXELS));
    layout->title = font_pick(FONT_SEMIBOLD, fmax(0.0225 * unit, LEAST_PIXELS));
    layout->method = font_pick(FONT_REGULAR, fmax(0.0205 * unit, LEAST_PIXELS));
    layout->axis = font_pick(FONT_REGULAR, fmax(0.0170 * unit, LEAST_PIXELS));
}

static int pixels(double value) { return (int)rint(value); }

/* Six at most: one row up to three, then two. In a portrait picture the same with rows for columns. */
static void pick_grid(Layout *layout, int width, int height, int panels) {
    int few = panels > 3 ? 2 : 1, many = (panels + few - 1) / few;
    layout->rows = height > width ? many : few;
    layout->columns = height > width ? few : many;
}

static void place_panels(Layout *layout, Rect area, int panels, int gap, int row_gap) {
    int width = (area.right - area.left - (layout->columns - 1) * gap) / layout->columns;
    int height = (area.bottom - area.top - (layout->rows - 1) * row_gap) / layout->rows;
    for (int i = 0; i < panels; i++) {
        int left = area.left + i % layout->columns * (width + gap);
        int top = area.top + i / layout->columns * (height + row_gap);
        layout->panels[i] = (Rect){left, top, left + width, top + height};
    }
}

/* Takes the rows from the bottom of the area and returns what is left. Pictures too small for words have no legend. */
static Rect place_rows(Layout *layout, Rect area, double unit, LayoutRows rows, int title, int axis) {
    bool text = unit >= LEAST_TEXT_UNIT;
    int bottom = area.bottom + axis; /* of what stands above the next row */
    if (rows.timeline) {
        int top = area.bottom - pixels(TIMELINE * unit);
        layout->timeline = (Rect){area.left, top, area.right, area.bottom};
        layout->key_baseline = top - layout->title_rise;
        bottom = top - (text ? title : layout->left);
    }
    if (rows.legend > 0 && text) {
        layout->legend_pitch = pixels(0.035 * unit);
        layout->legend_baseline = bottom - pixels(0.012 * unit) - (rows.legend - 1) * layout->legend_pitch;
        bottom -= pixels(0.046 * unit) + (rows.legend - 1) * layout->legend_pitch;
    }
    area.bottom = bottom - axis;
    return area;
}

Layout layout_make(int width, int height, int panels, LayoutRows rows) {
    Layout layout = {.width = width, .height = height};
    double unit = base_unit(width, height);
    bool text = unit >= LEAST_TEXT_UNIT;
    int margin = pixels(fmax(0.030 * unit, LEAST_MARGIN));
    pick_fonts(&layout, unit);
    pick_grid(&layout, width, height, panels);
    layout.left = margin;
    layout.right = width - margin;
    layout.header_baseline = margin + pixels(0.026 * unit);
    layout.title_rise = pixels(0.016 * unit);
    layout.axis_drop = pixels(0.0275 * unit);
    layout.tick = text ? pixels(0.006 * unit) : 0;
    layout.hairline = unit < 1500 ? 1 : pixels(unit / 1080);
    int gutter = text ? font_width(&layout.axis, "-50") + 2 * layout.tick : 0;
    int title = text ? pixels(0.058 * unit) : 0, axis = text ? pixels(0.038 * unit) : 0;
    int header = text ? layout.header_baseline + pixels(0.006 * unit) : margin;
    Rect area = {margin + gutter, header + title, width - margin, height - pixels(0.016 * unit) - axis};
    if (!text) area.bottom = height - margin;
    area = place_rows(&layout, area, unit, rows, title, axis);
    place_panels(&layout, area, panels, margin, text ? title + axis : margin);
    return layout;
}
