/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/parts.h"

const char *const part_names[] = {"header", "caption", "axis", "legend", "timeline"};

enum { MARK_REACH = 8 }; /* pixels that the mark of the present time reaches beyond the curves, at most */

/* The heights of a line of text above and below its baseline. */
static int above(const Font *font) { return font->pixels; }
static int below(const Font *font) { return font->pixels * 3 / 8; }

static int max(int a, int b) { return a > b ? a : b; }

static int add(Part *parts, int count, PartKind kind, int panel, Rect rect) {
    parts[count] = (Part){kind, panel, rect};
    return count + 1;
}

/* Labels at an end of an axis reach beyond it by half their size. The left axis is beside the first column only. */
static int add_panel(Part *parts, int count, const Layout *layout, int panel) {
    const Rect *rect = &layout->panels[panel];
    const int baseline = rect->top - layout->title_rise, line = layout->hairline, half = layout->axis.pixels / 2;
    count = add(parts, count, PART_CAPTION, panel,
                (Rect){rect->left, baseline - above(&layout->title), rect->right, rect->top - line});
    count = add(parts, count, PART_AXIS, panel,
                (Rect){rect->left - layout->axis.pixels, rect->bottom, rect->right + line,
                       rect->bottom + layout->axis_drop + below(&layout->axis)});
    if (panel % layout->columns != 0) return count;
    return add(parts, count, PART_AXIS, panel, (Rect){0, rect->top - half, rect->left, rect->bottom + half});
}

/* Half of the distance between rows, and a pixel for rounding, above and below the middle of the text: arrows are higher
   than characters. */
static Rect legend_rect(const Layout *layout) {
    const int middle = layout->legend_baseline - below(&layout->axis), half = layout->legend_pitch / 2 + 1;
    return (Rect){0, middle - half, layout->width, middle + (layout->legend_rows - 1) * layout->legend_pitch + half};
}

/* The lane above the curves keeps the mark below their top where there is text, and the row of the key is above. */
static Rect timeline_rect(const Layout *layout) {
    const Rect *plot = &layout->timeline;
    const bool text = layout->axis.glyphs != NULL;
    const int foot = text ? max(layout->axis_drop + below(&layout->axis), MARK_REACH) : MARK_REACH;
    const int top = text ? layout->key_baseline - above(&layout->method) : plot->top - layout->left;
    return (Rect){0, top, layout->width, plot->bottom + foot};
}

int parts_find(const Picture *picture, Part parts[PARTS_MAX]) {
    const Layout *layout = &picture->layout;
    const bool text = layout->axis.glyphs != NULL;
    int count = 0;
    if (text)
        count = add(parts, count, PART_HEADER, -1,
                    (Rect){0, 0, layout->width,
                           layout->header_baseline + (layout->header_lines - 1) * layout->header_pitch +
                               below(&layout->scene)});
    for (int panel = 0; text && panel < picture->panel_count; panel++) count = add_panel(parts, count, layout, panel);
    if (layout->legend_baseline > 0) count = add(parts, count, PART_LEGEND, -1, legend_rect(layout));
    if (picture->curves != NULL) count = add(parts, count, PART_TIMELINE, -1, timeline_rect(layout));
    return count;
}
