/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/panels_arrange.h"

#include "picture/caption.h"

#include <math.h>

/* An unusual grid must make the scene at least this much larger: one in which names are whole, one in which they are not. */
static const double GAIN = 1.05, GAIN_WITH_CUT_NAMES = 1.5;
/* Of a panel's width and height: what the scene covers at least, or the panel shrinks until it covers the third share. */
static const double LEAST_SHARE_X = 0.2, LEAST_SHARE_Y = 0.4, FULL_SHARE = 0.65;
static const double LEAST_WIDTH = 22, LEAST_HEIGHT = 5; /* ems of the captions, of a panel that shrinks */

static int panels_of(LookCompare compare, int count) {
    return compare == LOOK_OVERLAY ? 1 : compare == LOOK_DIFFERENCE ? count - 1 : count;
}

/* The camera of the first run, unless the look has another. */
static Camera fixed_camera(const Picture *picture, int width, int height) {
    const RenderLook *look = &picture->look;
    if (look->view.width > 0) return camera_show(&look->view, width, height);
    return camera_fit(look->view_from != NULL ? look->view_from : picture->runs[0], width, height);
}

static Vec2 needs(const Picture *picture) {
    const RenderLook *look = &picture->look;
    if (look->view.width > 0) return vec2((float)look->view.width, (float)look->view.height);
    return camera_needs(look->view_from != NULL ? look->view_from : picture->runs[0]);
}

static int width_of(const Rect *rect) { return rect->right - rect->left; }
static int height_of(const Rect *rect) { return rect->bottom - rect->top; }

static double scale_in(const Layout *layout, Vec2 size) {
    const Rect *panel = &layout->panels[0];
    return fmin(width_of(panel) / (double)size.x, height_of(panel) / (double)size.y);
}

/* A moving camera comes closer than the fixed view: it has the usual panels. */
static Layout choose_grid(const Picture *picture, Vec2 size, int width, int height, LayoutRows rows) {
    const int count = picture->panel_count, usual = layout_columns(width, height, count);
    Layout best = layout_make(width, height, count, usual, rows);
    const double usual_scale = scale_in(&best, size);
    if (picture->look.camera != LOOK_FIT) return best;
    double largest = 0;
    for (int columns = 1; columns <= count; columns++) {
        const int lines = (count + columns - 1) / columns;
        const bool wasteful = columns > 1 && (count + columns - 2) / (columns - 1) == lines;
        const Layout layout = layout_make(width, height, count, columns, rows);
        const Rect *panel = &layout.panels[0];
        if (wasteful || width_of(panel) < caption_least_width(picture, false) || height_of(panel) <= 0) continue;
        const bool whole = width_of(panel) >= caption_least_width(picture, true);
        const double scale = scale_in(&layout, size), worth = scale / (whole ? GAIN : GAIN_WITH_CUT_NAMES);
        if (worth <= usual_scale || worth <= largest) continue;
        largest = worth;
        best = layout;
    }
    return best;
}

/* The side of a panel that is `whole` pixels long and of which the scene needs `needed`. */
static int shrink(int whole, double needed, double share, double least) {
    if (needed >= share * whole) return whole;
    return (int)fmin(whole, ceil(fmax(needed / FULL_SHARE, least)));
}

/* The names of an overlay's runs need the whole width. */
static void shrink_panels(Picture *picture, Vec2 size) {
    Layout *layout = &picture->layout;
    const double scale = scale_in(layout, size),
                 em = layout->title.glyphs != NULL ? layout->title.pixels : layout->left;
    const int width = width_of(&layout->panels[0]), height = height_of(&layout->panels[0]);
    if (picture->look.camera != LOOK_FIT) return;
    const bool keep_width = picture->look.compare == LOOK_OVERLAY;
    const int narrow = keep_width ? width : shrink(width, scale * (double)size.x, LEAST_SHARE_X, LEAST_WIDTH * em);
    const int low = shrink(height, scale * (double)size.y, LEAST_SHARE_Y, LEAST_HEIGHT * em);
    if (narrow < width || low < height) layout_shrink_panels(layout, picture->panel_count, narrow, low);
}

void panels_arrange(Picture *picture, int width, int height, int legend) {
    picture->panel_count = panels_of(picture->look.compare, picture->count);
    LayoutRows rows = {1, legend, (picture->look.show & LOOK_TIMELINE) != 0};
    picture->layout = layout_make(width, height, 1, 1, rows); /* for the fonts */
    rows.title = caption_header_title(picture).count;
    if (rows.title > TEXT_LINES_MAX) rows.title = TEXT_LINES_MAX;
    const Vec2 size = needs(picture);
    picture->layout = choose_grid(picture, size, width, height, rows);
    shrink_panels(picture, size);
    const Rect *first = &picture->layout.panels[0];
    picture->camera = fixed_camera(picture, width_of(first), height_of(first));
    picture->grid_scale = picture->camera.scale;
}
