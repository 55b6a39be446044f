/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The layout of a picture, its plan, and the drawing of one moment. */
#include "pictures/picture.h"

#include "base/base.h"
#include "methods/methods.h"
#include "pictures/pictures_internal.h"
#include "pixels/gl.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* All sizes are relative to this, so that pictures of all resolutions look alike. For portrait pictures it follows
   the width, or the header would not fit. */
static double base_unit(int width, int height) { return fmin(height, UNIT_WIDTH * width); }

/* In smaller pictures even the smallest font would be too large. */
static const double MIN_TEXT_UNIT = 300;
static const double MIN_FONT = 10;          /* per em */
static const double TIMELINE_HEIGHT = 0.16; /* height of the curves / base unit */

static void pick_fonts(Layout *layout, double unit) {
    if (unit < MIN_TEXT_UNIT) return;
    layout->scene = font_pick(FONT_SEMIBOLD, fmax(SCENE_FONT * unit, MIN_FONT));
    layout->status = font_pick(FONT_REGULAR, fmax(STATUS_FONT * unit, MIN_FONT));
    layout->title = font_pick(FONT_SEMIBOLD, fmax(TITLE_FONT * unit, MIN_FONT));
    layout->method = font_pick(FONT_REGULAR, fmax(METHOD_FONT * unit, MIN_FONT));
    layout->axis = font_pick(FONT_REGULAR, fmax(AXIS_FONT * unit, MIN_FONT));
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

/* A last row that is not full is in the middle. */
static void place_panels(Layout *layout, int panels, int left, int top, int width, int height) {
    const int empty = layout->rows * layout->columns - panels;
    for (int i = 0; i < panels; i++) {
        const int in = i >= panels + empty - layout->columns ? empty * (width + layout->gap) / 2 : 0;
        const int x = left + in + i % layout->columns * (width + layout->gap);
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
        layout->legend_pitch = pixels(LEGEND_PITCH * unit);
        layout->legend_baseline = bottom - pixels(LEGEND_DROP * unit) - (rows.legend - 1) * layout->legend_pitch;
        bottom -= pixels(LEGEND_ROW * unit) + (rows.legend - 1) * layout->legend_pitch;
    }
    area.bottom = bottom - axis;
    return area;
}

Layout layout_make(int width, int height, int panels, int columns, LayoutRows rows) {
    Layout layout = {.width = width, .height = height};
    double unit = base_unit(width, height);
    bool text = unit >= MIN_TEXT_UNIT;
    int margin = pixels(fmax(PAGE_MARGIN * unit, MIN_MARGIN));
    pick_fonts(&layout, unit);
    layout.columns = columns;
    layout.rows = (panels + columns - 1) / columns;
    layout.left = margin;
    layout.right = width - margin;
    layout.header_baseline = margin + pixels(HEADER_RISE * unit);
    layout.title_rise = pixels(TITLE_RISE * unit);
    layout.tick = text ? pixels(AXIS_TICK * unit) : 0;
    layout.hairline = unit < 1500 ? 1 : pixels(unit / 1080);
    layout.axis_drop =
        pixels(fmax(AXIS_DROP * unit, layout.hairline + layout.tick + ceil(LABEL_CAP * layout.axis.pixels)));
    int gutter = text ? font_width(&layout.axis, "-50") + 2 * layout.tick : 0;
    layout.caption_lines = rows.caption;
    layout.caption_pitch = text ? pixels(fmax(CAPTION_PITCH * unit, CAPTION_PITCH_EMS * layout.title.pixels)) : 0;
    int title = text ? pixels(TITLE_ROW * unit) : 0, captions = title + (rows.caption - 1) * layout.caption_pitch,
        axis = text ? pixels(AXIS_ROW * unit) : 0;
    layout.header_lines = rows.title;
    layout.header_pitch = pixels(0.036 * unit);
    int last_line = layout.header_baseline + (rows.title - 1) * layout.header_pitch;
    int header = text ? last_line + pixels(HEADER_GAP * unit) : margin;
    Rect area = {margin + gutter, header + captions, width - margin, height - pixels(PAGE_FOOT * unit) - axis};
    if (!text) area.bottom = height - margin;
    layout.area = place_rows(&layout, area, unit, rows, title, axis);
    layout.gap = margin;
    layout.row_gap = text ? captions + axis : margin;
    const Rect size = panel_size(&layout);
    place_panels(&layout, panels, layout.area.left, layout.area.top, size.right, size.bottom);
    return layout;
}

static bool check_runs(const Trajectory *const *runs, int count, Error *error) {
    if (count < 1 || count > RENDER_PANELS_MAX)
        return error_input(error, "render", "the number of panels must be 1 to %d (got %d)", RENDER_PANELS_MAX, count);
    for (int i = 1; i < count; i++)
        if (runs[i]->dt != runs[0]->dt)
            return error_input(error, "render",
                               "panel %d (%s) has time steps of %g s, but the first panel has %g s; they must be equal",
                               i + 1, runs[i]->method, (double)runs[i]->dt, (double)runs[0]->dt);
    return true;
}

static bool check_size(int width, int height, Error *error) {
    if (width >= RENDER_SIDE_MIN && height >= RENDER_SIDE_MIN && width <= RENDER_SIDE_MAX && height <= RENDER_SIDE_MAX)
        return true;
    return error_input(error, "render", "each side of the picture must be %d to %d pixels (got %d x %d)",
                       RENDER_SIDE_MIN, RENDER_SIDE_MAX, width, height);
}

static void find_largest_distance(Picture *picture) {
    for (int i = 1; i < picture->count; i++)
        for (int frame = 0; frame < picture->runs[i]->frames; frame++)
            picture->largest_distance =
                fmax(picture->largest_distance, picture_run_distance(picture, i, moment_stored(frame)));
}

static bool assign_colours(Picture *picture, const ColourChoices *choices, Error *error) {
    const char *methods[RENDER_PANELS_MAX];
    for (int i = 0; i < picture->count; i++) methods[i] = picture->runs[i]->method;
    return colours_assign(methods, picture->count, choices, picture->colours, error);
}

bool picture_plan(Picture *picture, const Trajectory *const *runs, int count, int width, int height, Error *error) {
    if (!check_size(width, height, error) || !check_runs(runs, count, error)) return false;
    *picture = (Picture){.count = count, .theme = theme_get(LOOK_LIGHT)};
    for (int i = 0; i < count; i++) {
        picture->runs[i] = runs[i];
        if (runs[i]->frames > picture->frames) picture->frames = runs[i]->frames;
    }
    if (!assign_colours(picture, NULL, error)) return false;
    panels_arrange(picture, width, height, 0);
    find_largest_distance(picture);
    return true;
}

static bool plan_path(Picture *picture, Error *error) {
    if (picture->look.camera == LOOK_FIT) return true;
    Rect panel = picture->layout.panels[0];
    picture->path = camera_path(picture->runs, picture->frames, picture->look.camera, &picture->events,
                                &picture->camera, panel.right - panel.left, panel.bottom - panel.top, error);
    if (picture->path == NULL) return false;
    double closest = picture->camera.scale;
    for (int frame = 0; frame < picture->frames; frame++) closest = fmax(closest, picture->path[frame].scale);
    picture->grid_scale = sqrt(picture->camera.scale * closest);
    return true;
}

/* The entries of the legend depend on the scales, and the scales on the room that its rows leave. So more rows may need
   fewer: then the scales stay. */
static bool arrange_rows(Picture *picture, const RenderOptions *options, Error *error) {
    int needed = 0;
    for (int rows = 0; rows <= needed; rows++) {
        panels_arrange(picture, options->width, options->height, rows);
        if (!scales_choose(&picture->scales, picture->runs[0], &picture->layout, picture->camera.scale,
                           picture->largest_distance, error))
            return false;
        needed = legend_rows(picture);
    }
    panels_arrange(picture, options->width, options->height, needed);
    return true;
}

static bool title_fits(const TextLines *lines, const char *option, Error *error) {
    return lines->count <= TEXT_LINES_MAX ||
           error_input(error, option, "the text needs %d lines in pictures of this size, but at most %d fit",
                       lines->count, TEXT_LINES_MAX);
}

/* The titles that the options set; a scene's name is cut instead. */
static bool titles_fit(const Picture *picture, Error *error) {
    const TextLines header = caption_header_title(picture), title = card_head(picture, MOMENT_TITLE),
                    end = card_head(picture, MOMENT_END);
    return (picture->title == NULL ||
            (title_fits(&header, "--title", error) && title_fits(&title, "--title", error))) &&
           (picture->look.end == NULL || title_fits(&end, "--end", error));
}

bool picture_apply_options(Picture *picture, const RenderOptions *options, Error *error) {
    const RenderLook plain = {0};
    picture->title = options->title;
    for (int i = 0; i < picture->count; i++) {
        picture->captions[i] = options->captions[i];
        picture->notes[i] = options->notes[i];
        if (options->describe != NULL) picture->methods[i] = options->describe(picture->runs[i]->method);
    }
    if (!assign_colours(picture, &options->colours, error)) return false;
    if (options->end_card) card_plan(picture);
    picture->look = options->look;
    picture->theme = theme_get(options->look.theme);
    if (memcmp(&picture->look, &plain, sizeof plain) == 0) {
        panels_arrange(picture, picture->layout.width, picture->layout.height, 0);
        return titles_fit(picture, error) && captions_fit(picture, error);
    }
    if (!look_check(&picture->look, picture->runs, picture->count, error)) return false;
    picture->events = events_find(picture->runs, picture->count);
    return arrange_rows(picture, options, error) && titles_fit(picture, error) && captions_fit(picture, error) &&
           plan_path(picture, error) && timeline_plan(picture, error);
}

void picture_free(Picture *picture) {
    free(picture->path);
    free(picture->curves);
    picture->path = NULL;
    picture->curves = NULL;
}

bool picture_check(const Trajectory *const *runs, int count, const RenderOptions *options, Error *error) {
    Picture picture;
    if (!picture_plan(&picture, runs, count, options->width, options->height, error)) return false;
    const bool ok = picture_apply_options(&picture, options, error);
    picture_free(&picture);
    return ok;
}

int picture_run_frame(const Picture *picture, int run, int frame) {
    return pose_moment(picture->runs[run], moment_stored(frame)).frame;
}

int picture_run(const Picture *picture, int panel) {
    return picture->look.compare == LOOK_DIFFERENCE ? panel + 1 : panel;
}

bool picture_draws_outlines(const Picture *picture, int panel, int run) {
    const RenderLook *look = &picture->look;
    if (look->compare == LOOK_OVERLAY) return run > 0;
    return run == 0 && picture_run(picture, panel) > 0 &&
           (look->compare == LOOK_DIFFERENCE || (look->show & LOOK_GHOSTS) != 0);
}

const BodyColors *picture_body_colors(const Picture *picture, int run) {
    const RunColours *colours = &picture->colours[run];
    return picture->theme == theme_get(LOOK_DARK) ? &colours->dark : &colours->light;
}

uint32_t picture_ghost_color(const Picture *picture, int run) {
    const BodyColors *colors = picture_body_colors(picture, run);
    return picture->theme->ghost_is_band ? colors->band : colors->fill;
}

bool picture_colors_distance(const Picture *picture, int run) {
    bool enabled = picture->look.compare == LOOK_DIFFERENCE || (picture->look.show & LOOK_DISTANCE) != 0;
    return enabled && run > 0;
}

static double distance_between(const Trajectory *a, const Trajectory *b, Moment moment) {
    int bodies = a->bodies < b->bodies ? a->bodies : b->bodies;
    double largest = 0;
    for (int body = 0; body < bodies; body++) {
        if (!trajectory_has(a, moment.frame, body) || !trajectory_has(b, moment.frame, body)) continue;
        largest = fmax(largest, pose_distance(pose_at(a, moment, body), pose_at(b, moment, body)));
    }
    return largest;
}

double picture_run_distance(const Picture *picture, int run, Moment moment) {
    const Trajectory *first = picture->runs[0], *other = picture->runs[run];
    if (run == 0 || moment.frame >= first->frames || moment.frame >= other->frames) return NAN;
    return moment.part > 0 ? distance_between(first, other, moment) : trajectory_distance(first, other, moment.frame);
}

double picture_distance(const Picture *picture, Moment moment) {
    double largest = NAN;
    for (int i = 1; i < picture->count; i++) largest = fmax(largest, picture_run_distance(picture, i, moment));
    return largest;
}

static void draw_panels(const Picture *picture, Moment moment, Drawing *drawing) {
    for (int i = 0; i < picture->panel_count; i++) panel_draw_static(picture, i, moment, drawing);
    legend_draw(picture, drawing);
    timeline_draw_static(picture, drawing);
    drawing->static_shapes = drawing->shape_count;
    caption_header(picture, moment, drawing);
    for (int i = 0; i < picture->panel_count; i++) {
        panel_draw_moving(picture, i, moment, drawing);
        caption_panel(picture, i, moment, drawing);
    }
    timeline_draw_moving(picture, moment, drawing);
}

Camera picture_camera(const Picture *picture, Moment moment) {
    const Rect panel = picture->layout.panels[0];
    if (picture->path == NULL) return picture->camera;
    return camera_at(picture->path, picture->frames, moment, panel.right - panel.left, panel.bottom - panel.top);
}

void picture_draw(const Picture *picture, Moment moment, Drawing *drawing) {
    if (moment.kind == MOMENT_TITLE || moment.kind == MOMENT_END) {
        card_draw(picture, moment, drawing);
        return;
    }
    Picture now = *picture;
    now.camera = picture_camera(picture, moment);
    draw_panels(&now, moment, drawing);
}
