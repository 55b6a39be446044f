/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/layout.h"

#include <math.h>

/* All sizes are relative to this, so that pictures of all resolutions look alike. For portrait pictures it follows
   the width, or the header would not fit. */
static double base_unit(int width, int height) { return fmin(height, 0.75 * width); }

/* In smaller pictures even the smallest font would be too large. */
static const double MIN_TEXT_UNIT = 300;
static const double MIN_FONT = 10;          /* per em */
static const double MIN_MARGIN = 4;         /* pixels */
static const double TIMELINE_HEIGHT = 0.16; /* height of the curves / base unit */

static void pick_fonts(Layout *layout, double unit) {
    if (unit < MIN_TEXT_UNIT) return;
    layout->scene = font_pick(FONT_SEMIBOLD, fmax(0.0300 * unit, MIN_FONT));
    layout->status = font_pick(FONT_REGULAR, fmax(0.0225 * unit, MIN_FONT));
    layout->title = font_pick(FONT_SEMIBOLD, fmax(0.0225 * unit, MIN_FONT));
    layout->method = font_pick(FONT_REGULAR, fmax(0.0205 * unit, MIN_FONT));
    layout->axis = font_pick(FONT_REGULAR, fmax(0.0170 * unit, MIN_FONT));
}

static int pixels(double value) { return (int)rint(value); }

/* One row up to three panels, otherwise two. In portrait, columns instead of rows. */
int layout_columns(int width, int height, int panels) {
    const int few = panels > 3 ? 2 : 1, many = (panels + few - 1) / few;
    return height > width ? few : many;
}

static Rect panel_size(const Layout *layout) {
    const Rect *area = &layout->area;
    return (Rect){0, 0, (area->right - area->left - (layout->columns - 1) * layout->gap) / layout->columns,
                  (area->bottom - area->top - (layout->rows - 1) * layout->row_gap) / layout->rows};
}

static void place_panels(Layout *layout, int panels, int left, int top, int width, int height) {
    for (int i = 0; i < panels; i++) {
        const int x = left + i % layout->columns * (width + layout->gap);
        const int y = top + i / layout->columns * (height + layout->row_gap);
        layout->panels[i] = (Rect){x, y, x + width, y + height};
    }
}

void layout_shrink_panels(Layout *layout, int panels, int width, int height) {
    const Rect whole = panel_size(layout);
    place_panels(layout, panels, layout->area.left + layout->columns * (whole.right - width) / 2,
                 layout->area.top + layout->rows * (whole.bottom - height) / 2, width, height);
}

/* Takes the rows from the bottom of the area and returns the rest. Pictures too small for text have no legend. */
static Rect place_rows(Layout *layout, Rect area, double unit, LayoutRows rows, int title, int axis) {
    bool text = unit >= MIN_TEXT_UNIT;
    int bottom = area.bottom + axis; /* of the content above the next row */
    if (rows.timeline) {
        int top = area.bottom - pixels(TIMELINE_HEIGHT * unit);
        layout->timeline = (Rect){area.left, top, area.right, area.bottom};
        layout->key_baseline = top - layout->title_rise;
        bottom = top - (text ? title : layout->left);
    }
    if (rows.legend > 0 && text) {
        layout->legend_rows = rows.legend;
        layout->legend_pitch = pixels(0.035 * unit);
        layout->legend_baseline = bottom - pixels(0.012 * unit) - (rows.legend - 1) * layout->legend_pitch;
        bottom -= pixels(0.046 * unit) + (rows.legend - 1) * layout->legend_pitch;
    }
    area.bottom = bottom - axis;
    return area;
}

Layout layout_make(int width, int height, int panels, int columns, LayoutRows rows) {
    Layout layout = {.width = width, .height = height};
    double unit = base_unit(width, height);
    bool text = unit >= MIN_TEXT_UNIT;
    int margin = pixels(fmax(0.030 * unit, MIN_MARGIN));
    pick_fonts(&layout, unit);
    layout.columns = columns;
    layout.rows = (panels + columns - 1) / columns;
    layout.left = margin;
    layout.right = width - margin;
    layout.header_baseline = margin + pixels(0.026 * unit);
    layout.title_rise = pixels(0.016 * unit);
    layout.axis_drop = pixels(0.0275 * unit);
    layout.tick = text ? pixels(0.006 * unit) : 0;
    layout.hairline = unit < 1500 ? 1 : pixels(unit / 1080);
    int gutter = text ? font_width(&layout.axis, "-50") + 2 * layout.tick : 0;
    int title = text ? pixels(0.058 * unit) : 0, axis = text ? pixels(0.038 * unit) : 0;
    layout.header_lines = rows.title;
    layout.header_pitch = pixels(0.036 * unit);
    int last_line = layout.header_baseline + (rows.title - 1) * layout.header_pitch;
    int header = text ? last_line + pixels(0.006 * unit) : margin;
    Rect area = {margin + gutter, header + title, width - margin, height - pixels(0.016 * unit) - axis};
    if (!text) area.bottom = height - margin;
    layout.area = place_rows(&layout, area, unit, rows, title, axis);
    layout.gap = margin;
    layout.row_gap = text ? title + axis : margin;
    const Rect size = panel_size(&layout);
    place_panels(&layout, panels, layout.area.left, layout.area.top, size.right, size.bottom);
    return layout;
}
