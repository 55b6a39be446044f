/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A picture: its layout, its plan, and the drawing of one moment. */
#include "pictures/picture.h"

#include "base/base.h"
#include "base/numbers.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "pictures/pictures_internal.h"
#include "pixels/gl.h"
#include "runs/compare_runs.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* In smaller pictures even the smallest font would be too large. */
static const double MIN_TEXT_UNIT = 300;
static const double MIN_FONT = 10;          /* per em */
static const double TIMELINE_HEIGHT = 0.16; /* height of the curves / base unit */

static int pixels(double value) { return (int)rint(value); }
static int width_of(const Rect *rect) { return rect->right - rect->left; }
static int height_of(const Rect *rect) { return rect->bottom - rect->top; }

static Rect panel_size(const Layout *layout) {
    const Rect *area = &layout->area;
    return (Rect){0, 0, (width_of(area) - (layout->columns - 1) * layout->gap) / layout->columns,
                  (height_of(area) - (layout->rows - 1) * layout->row_gap) / layout->rows};
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

Layout layout_make(int width, int height, int panels, int columns, LayoutRows rows) {
    Layout layout = {.width = width, .height = height};
    /* All sizes are relative to this, so that pictures of all resolutions look alike. For portrait pictures it follows
       the width, or the header would not fit. */
    const double unit = fmin(height, UNIT_WIDTH * width);
    const bool text = unit >= MIN_TEXT_UNIT;
    const int margin = pixels(fmax(PAGE_MARGIN * unit, MIN_MARGIN));
    if (text) {
        layout.scene = font_pick(FONT_SEMIBOLD, fmax(SCENE_FONT * unit, MIN_FONT));
        layout.status = font_pick(FONT_REGULAR, fmax(STATUS_FONT * unit, MIN_FONT));
        layout.title = font_pick(FONT_SEMIBOLD, fmax(TITLE_FONT * unit, MIN_FONT));
        layout.method = font_pick(FONT_REGULAR, fmax(METHOD_FONT * unit, MIN_FONT));
        layout.axis = font_pick(FONT_REGULAR, fmax(AXIS_FONT * unit, MIN_FONT));
    }
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
    const int gutter = text ? font_width(&layout.axis, "-50") + 2 * layout.tick : 0;
    layout.caption_lines = rows.caption;
    layout.caption_pitch = text ? pixels(fmax(CAPTION_PITCH * unit, CAPTION_PITCH_EMS * layout.title.pixels)) : 0;
    const int title = text ? pixels(TITLE_ROW * unit) : 0, captions = title + (rows.caption - 1) * layout.caption_pitch,
              axis = text ? pixels(AXIS_ROW * unit) : 0;
    layout.header_lines = rows.title;
    layout.header_pitch = pixels(0.036 * unit);
    const int last_line = layout.header_baseline + (rows.title - 1) * layout.header_pitch;
    const int header = text ? last_line + pixels(HEADER_GAP * unit) : margin;

    /* The panels' area, from whose bottom timeline and legend are taken; pictures too small for text have no legend. */
    Rect area = {margin + gutter, header + captions, width - margin,
                 text ? height - pixels(PAGE_FOOT * unit) - axis : height - margin};
    int bottom = area.bottom + axis; /* of the content above the next row */
    if (rows.timeline) {
        const int top = area.bottom - pixels(TIMELINE_HEIGHT * unit);
        layout.timeline = (Rect){area.left, top, area.right, area.bottom};
        layout.key_baseline = top - layout.title_rise;
        bottom = top - (text ? title : layout.left);
    }
    if (rows.legend > 0 && text) {
        layout.legend_rows = rows.legend;
        layout.legend_pitch = pixels(LEGEND_PITCH * unit);
        layout.legend_baseline = bottom - pixels(LEGEND_DROP * unit) - (rows.legend - 1) * layout.legend_pitch;
        bottom -= pixels(LEGEND_ROW * unit) + (rows.legend - 1) * layout.legend_pitch;
    }
    area.bottom = bottom - axis;
    layout.area = area;
    layout.gap = margin;
    layout.row_gap = text ? captions + axis : margin;
    const Rect size = panel_size(&layout);
    place_panels(&layout, panels, area.left, area.top, size.right, size.bottom);
    return layout;
}

/* Between the scale in these panels and that at which what falls would stay in view. */
static double scale_in(const Layout *layout, const CameraFrame *frame) {
    const Extent *held = &frame->held, *room = &frame->room;
    const double width = width_of(&layout->panels[0]),
                 high = height_of(&layout->panels[0]) / (held->top - held->bottom);
    return sqrt(fmin(width / (held->right - held->left), high) * fmin(width / (room->right - room->left), high));
}

/* The usual panels: one row up to three of them, otherwise two; in portrait, columns instead of rows. A fixed view may
   have others. A moving camera comes closer. */
static Layout choose_grid(const Picture *picture, const CameraFrame *frame, int width, int height, LayoutRows rows) {
    const int count = picture->panel_count, few = count > 3 ? 2 : 1;
    const int usual = height > width ? few : (count + few - 1) / few;
    Layout best = layout_make(width, height, count, usual, rows);
    const double usual_scale = scale_in(&best, frame);
    if (picture->look.camera != LOOK_FIT) return best;
    double largest = 0;
    for (int columns = 1; columns <= count; columns++) {
        const Layout layout = layout_make(width, height, count, columns, rows);
        const Rect *panel = &layout.panels[0];
        if (width_of(panel) < caption_least_width(picture, false) || height_of(panel) <= 0) continue;
        const bool whole = width_of(panel) >= caption_least_width(picture, true);
        const double scale = scale_in(&layout, frame), worth = scale / (whole ? GAIN : GAIN_WITH_CUT_NAMES);
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

/* Sets the panels, from the look and the title, and the fixed camera; `legend`: its rows. Panels that a long or high
   scene would leave almost empty have its shape. Three panels are in a row or a column; only of five, a cell is
   empty. */
static void panels_arrange(Picture *picture, int width, int height, int legend) {
    const RenderLook *look = &picture->look;
    const int count = picture->count;
    picture->panel_count = look->compare == LOOK_OVERLAY ? 1 : look->compare == LOOK_DIFFERENCE ? count - 1 : count;
    LayoutRows rows = {1, 1, legend, (look->show & SHOW_TIMELINE) != 0};
    picture->layout = layout_make(width, height, 1, 1, rows); /* for the fonts */
    rows.title = int_min(caption_header_title(picture).count, TEXT_LINES_MAX);

    /* What the camera shows: that of the runs, unless the look has another. */
    const CameraFrame frame = look->view.width > 0      ? camera_frame_of(&look->view)
                              : look->approach          ? camera_frame_approach(picture->runs[0])
                              : look->view_from != NULL ? camera_frame(&look->view_from, 1)
                                                        : camera_frame(picture->runs, count);
    const Vec2 needs = camera_needs(&frame);
    Layout *layout = &picture->layout;
    for (rows.caption = 1;; rows.caption++) { /* narrow panels need more lines */
        *layout = choose_grid(picture, &frame, width, height, rows);
        if (look->camera == LOOK_FIT) {
            /* The names of an overlay's runs need the whole width. */
            const int whole = width_of(&layout->panels[0]), high = height_of(&layout->panels[0]);
            const double scale = camera_fit(&frame, whole, high).scale,
                         em = layout->title.glyphs != NULL ? layout->title.pixels : layout->left;
            const int narrow = look->compare == LOOK_OVERLAY
                                   ? whole
                                   : shrink(whole, scale * (double)needs.x, LEAST_SHARE_X, LEAST_PANEL_WIDTH * em);
            const int low = shrink(high, scale * (double)needs.y, LEAST_SHARE_Y, LEAST_PANEL_HEIGHT * em);
            const Rect size = panel_size(layout);
            if (narrow < whole || low < high) /* in the middle of their area */
                place_panels(layout, picture->panel_count,
                             layout->area.left + layout->columns * (size.right - narrow) / 2,
                             layout->area.top + layout->rows * (size.bottom - low) / 2, narrow, low);
        }
        if (caption_lines(picture) <= rows.caption) break;
    }
    picture->camera = camera_fit(&frame, width_of(&layout->panels[0]), height_of(&layout->panels[0]));
    picture->grid_scale = picture->camera.scale;
}

const char *const part_names[] = {"header", "caption", "axis", "legend", "timeline"};

enum { MARK_REACH = 8 }; /* pixels that the mark of the present time reaches beyond the curves, at most */

/* The height of a line of text below its baseline; above, it has that of its letters. */
static int below(const Font *font) { return font->pixels * 3 / 8; }

int parts_find(const Picture *picture, Part parts[PARTS_MAX]) {
    const Layout *layout = &picture->layout;
    const Font *axis = &layout->axis;
    const bool text = axis->glyphs != NULL;
    int count = 0;
    if (text)
        parts[count++] = (Part){
            PART_HEADER,
            -1,
            {0, 0, layout->width,
             layout->header_baseline + (layout->header_lines - 1) * layout->header_pitch + below(&layout->scene)}};
    for (int panel = 0; text && panel < picture->panel_count; panel++) {
        /* Labels at an end of an axis reach beyond it by half their size. The left axis is beside the first column
           only. */
        const Rect *rect = &layout->panels[panel];
        const int baseline = rect->top - layout->title_rise - (layout->caption_lines - 1) * layout->caption_pitch,
                  line = layout->hairline, half = axis->pixels / 2;
        parts[count++] =
            (Part){PART_CAPTION, panel, {rect->left, baseline - layout->title.pixels, rect->right, rect->top - line}};
        parts[count++] = (Part){PART_AXIS,
                                panel,
                                {rect->left - axis->pixels, rect->bottom, rect->right + line,
                                 rect->bottom + layout->axis_drop + below(axis)}};
        if (panel % layout->columns == 0)
            parts[count++] = (Part){PART_AXIS, panel, {0, rect->top - half, rect->left, rect->bottom + half}};
    }
    if (layout->legend_baseline > 0) {
        /* Half of the distance between rows, and a pixel for rounding, above and below the middle of the text: arrows
           are higher than characters. */
        const int middle = layout->legend_baseline - below(axis), half = layout->legend_pitch / 2 + 1,
                  more = (layout->legend_rows - 1) * layout->legend_pitch;
        parts[count++] = (Part){PART_LEGEND, -1, {0, middle - half, layout->width, middle + more + half}};
    }
    if (picture->curves != NULL) {
        /* The lane above the curves keeps the mark below their top where there is text, and the row of the key is
           above. */
        const Rect *plot = &layout->timeline;
        const int foot = text ? int_max(layout->axis_drop + below(axis), MARK_REACH) : MARK_REACH;
        const int top = text ? layout->key_baseline - layout->method.pixels : plot->top - layout->left;
        parts[count++] = (Part){PART_TIMELINE, -1, {0, top, layout->width, plot->bottom + foot}};
    }
    return count;
}

/* The plan. */

static bool assign_colours(Picture *picture, const ColourChoices *choices, Error *error) {
    const char *methods[RENDER_PANELS_MAX];
    for (int i = 0; i < picture->count; i++) methods[i] = picture->runs[i]->method;
    return colours_assign(methods, picture->count, choices, picture->colours, error);
}

bool picture_plan(Picture *picture, const Trajectory *const *runs, int count, int width, int height, Error *error) {
    if (width < RENDER_SIDE_MIN || height < RENDER_SIDE_MIN || width > RENDER_SIDE_MAX || height > RENDER_SIDE_MAX)
        return error_input(error, "render", "each side of the picture must be %d to %d pixels (got %d x %d)",
                           RENDER_SIDE_MIN, RENDER_SIDE_MAX, width, height);
    if (count < 1 || count > RENDER_PANELS_MAX)
        return error_input(error, "render", "the number of panels must be 1 to %d (got %d)", RENDER_PANELS_MAX, count);
    *picture = (Picture){.count = count, .theme = theme_get(LOOK_LIGHT), .mode_base = -1};
    for (int i = 0; i < count; i++) {
        if (runs[i]->dt != runs[0]->dt)
            return error_input(error, "render",
                               "panel %d (%s) has time steps of %g s, but the first panel has %g s; they must be equal",
                               i + 1, runs[i]->method, (double)runs[i]->dt, (double)runs[0]->dt);
        picture->runs[i] = runs[i];
        picture->frames = int_max(picture->frames, runs[i]->frames);
    }
    if (!assign_colours(picture, NULL, error)) return false;
    panels_arrange(picture, width, height, 0);
    for (int i = 1; i < count; i++)
        for (int frame = 0; frame < runs[i]->frames; frame++)
            picture->largest_distance =
                fmax(picture->largest_distance, picture_run_distance(picture, i, moment_stored(frame)));
    return true;
}

static bool title_fits(const TextLines *lines, const char *option, Error *error) {
    return lines->count <= TEXT_LINES_MAX ||
           error_input(error, option, "the text needs %d lines in pictures of this size, but at most %d fit",
                       lines->count, TEXT_LINES_MAX);
}

/* Titles and captions that the options set; a scene's name is cut instead. */
static bool texts_fit(const Picture *picture, Error *error) {
    const TextLines header = caption_header_title(picture), title = card_head(picture, MOMENT_TITLE),
                    end = card_head(picture, MOMENT_END);
    return (picture->title == NULL ||
            (title_fits(&header, "--title", error) && title_fits(&title, "--title", error))) &&
           (picture->look.end == NULL || title_fits(&end, "--end", error)) && captions_fit(picture, error);
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
        return texts_fit(picture, error);
    }
    if (!look_check(&picture->look, picture->runs, picture->count, error)) return false;
    picture->events = events_find(picture->runs, picture->count);
    if (picture->look.show & SHOW_MODES) picture->mode_base = trajectory_reference(picture->runs, picture->count);

    /* The entries of the legend depend on the scales, and the scales on the room that its rows leave. So more rows may
       need fewer: then the scales stay. */
    int needed = 0;
    for (int rows = 0; rows <= needed; rows++) {
        panels_arrange(picture, options->width, options->height, rows);
        if (!scales_choose(&picture->scales, picture->runs[0], &picture->layout, picture->camera.scale,
                           picture->largest_distance, error))
            return false;
        needed = legend_rows(picture);
    }
    panels_arrange(picture, options->width, options->height, needed);
    if (!texts_fit(picture, error)) return false;
    if (picture->look.camera != LOOK_FIT) {
        const Rect *panel = &picture->layout.panels[0];
        picture->path = camera_path(picture->runs, picture->frames, picture->look.camera, &picture->events,
                                    &picture->camera, width_of(panel), height_of(panel), error);
        if (picture->path == NULL) return false;
        double closest = picture->camera.scale;
        for (int frame = 0; frame < picture->frames; frame++) closest = fmax(closest, picture->path[frame].scale);
        picture->grid_scale = sqrt(picture->camera.scale * closest);
    }
    return timeline_plan(picture, error);
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
           (look->compare == LOOK_DIFFERENCE || (look->show & SHOW_GHOSTS) != 0);
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
    bool enabled = picture->look.compare == LOOK_DIFFERENCE || (picture->look.show & SHOW_DISTANCE) != 0;
    return enabled && run > 0;
}

double picture_run_distance(const Picture *picture, int run, Moment moment) {
    const Trajectory *a = picture->runs[0], *b = picture->runs[run];
    if (run == 0 || moment.frame >= a->frames || moment.frame >= b->frames) return NAN;
    if (moment.part == 0) return trajectory_distance(a, b, moment.frame);
    double largest = 0;
    for (int body = 0; body < int_min(a->bodies, b->bodies); body++)
        if (trajectory_has(a, moment.frame, body) && trajectory_has(b, moment.frame, body))
            largest = fmax(largest, pose_distance(pose_at(a, moment, body), pose_at(b, moment, body)));
    return largest;
}

double picture_distance(const Picture *picture, Moment moment) {
    double largest = NAN;
    for (int i = 1; i < picture->count; i++) largest = fmax(largest, picture_run_distance(picture, i, moment));
    return largest;
}

Events events_find(const Trajectory *const *runs, int count) {
    Events events = {.impact = -1, .divergence = -1, .run = -1, .body = -1};
    const Trajectory *first = runs[0];
    char what[256];
    for (int i = 0; i < count && events.impact < 0; i++) events.impact = trajectory_impact(runs[i]);
    for (int i = 1; i < count; i++) {
        if (trajectory_different_worlds(first, runs[i], what, sizeof what)) continue;
        int frames = int_min(first->frames, runs[i]->frames);
        if (events.divergence >= 0) frames = int_min(frames, events.divergence); /* earlier than all found so far */
        for (int frame = 0; frame < frames; frame++)
            for (int body = 0; body < first->bodies; body++)
                if (trajectory_state_difference(first, runs[i], frame, body).distance > EVENTS_VISIBLE_DISTANCE) {
                    events.divergence = frames = frame, events.run = i, events.body = body;
                    break;
                }
    }
    return events;
}

Camera picture_camera(const Picture *picture, Moment moment) {
    const Rect *panel = &picture->layout.panels[0];
    if (picture->path == NULL) return picture->camera;
    return camera_at(picture->path, picture->frames, moment, width_of(panel), height_of(panel));
}

void picture_draw(const Picture *picture, Moment moment, Drawing *drawing) {
    if (moment.kind == MOMENT_TITLE || moment.kind == MOMENT_END) {
        card_draw(picture, moment, drawing);
        return;
    }
    Picture now = *picture;
    now.camera = picture_camera(picture, moment);
    for (int i = 0; i < now.panel_count; i++) panel_draw_static(&now, i, moment, drawing);
    legend_draw(&now, drawing);
    timeline_draw_static(&now, drawing);
    drawing->static_shapes = drawing->shape_count;
    caption_header(&now, moment, drawing);
    for (int i = 0; i < now.panel_count; i++) {
        panel_draw_moving(&now, i, moment, drawing);
        caption_panel(&now, i, moment, drawing);
    }
    timeline_draw_moving(&now, moment, drawing);
}
