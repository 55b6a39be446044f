/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Panels: the grid in which they are arranged, their metre grid and axes, scales of arrows and colours, their
   layers. */
#include "base/base.h"
#include "base/numbers.h"
#include "engine/engine.h"
#include "pictures/pictures_internal.h"
#include "pictures/picture.h"
#include "pixels/gl.h"
#include "pixels/png.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static int panels_of(LookCompare compare, int count) {
    return compare == LOOK_OVERLAY ? 1 : compare == LOOK_DIFFERENCE ? count - 1 : count;
}

/* That of the runs, unless the look has another. */
static CameraFrame fixed_frame(const Picture *picture) {
    const RenderLook *look = &picture->look;
    if (look->view.width > 0) return camera_frame_of(&look->view);
    if (look->show & LOOK_APPROACH) return camera_frame_approach(picture->runs[0]);
    return look->view_from != NULL ? camera_frame(&look->view_from, 1) : camera_frame(picture->runs, picture->count);
}

static int width_of(const Rect *rect) { return rect->right - rect->left; }
static int height_of(const Rect *rect) { return rect->bottom - rect->top; }

/* Between the scale in these panels and that at which what falls would stay in view. */
static double scale_in(const Layout *layout, const CameraFrame *frame) {
    const Extent *held = &frame->held, *room = &frame->room;
    const double width = width_of(&layout->panels[0]),
                 high = height_of(&layout->panels[0]) / (held->top - held->bottom);
    return sqrt(fmin(width / (held->right - held->left), high) * fmin(width / (room->right - room->left), high));
}

/* A moving camera comes closer than the fixed view: it has the usual panels. */
static Layout choose_grid(const Picture *picture, const CameraFrame *frame, int width, int height, LayoutRows rows) {
    const int count = picture->panel_count, usual = layout_columns(width, height, count);
    Layout best = layout_make(width, height, count, usual, rows);
    const double usual_scale = scale_in(&best, frame);
    if (picture->look.camera != LOOK_FIT) return best;
    double largest = 0;
    for (int columns = 1; columns <= count; columns++) {
        const int lines = (count + columns - 1) / columns;
        const int empty = lines * columns - count;
        const Layout layout = layout_make(width, height, count, columns, rows);
        const Rect *panel = &layout.panels[0];
        if (empty > (count > 3) || width_of(panel) < caption_least_width(picture, false) || height_of(panel) <= 0)
            continue;
        const bool whole = width_of(panel) >= caption_least_width(picture, true);
        const double scale = scale_in(&layout, frame), worth = scale / (whole ? GAIN : GAIN_WITH_CUT_NAMES);
        if (worth <= usual_scale || worth <= largest) continue;
        largest = worth;
        best = layout;
    }
    return best;
}

/* The side of a panel that is `whole` pixels long and of which the scene needs `needed`. */
static int panel_shrink(int whole, double needed, double share, double least) {
    if (needed >= share * whole) return whole;
    return (int)fmin(whole, ceil(fmax(needed / FULL_SHARE, least)));
}

/* The names of an overlay's runs need the whole width. */
static void shrink_panels(Picture *picture, const CameraFrame *frame) {
    Layout *layout = &picture->layout;
    const Vec2 size = camera_needs(frame);
    const int width = width_of(&layout->panels[0]), height = height_of(&layout->panels[0]);
    const double scale = camera_fit(frame, width, height).scale,
                 em = layout->title.glyphs != NULL ? layout->title.pixels : layout->left;
    if (picture->look.camera != LOOK_FIT) return;
    const bool keep_width = picture->look.compare == LOOK_OVERLAY;
    const int narrow =
        keep_width ? width : panel_shrink(width, scale * (double)size.x, LEAST_SHARE_X, LEAST_PANEL_WIDTH * em);
    const int low = panel_shrink(height, scale * (double)size.y, LEAST_SHARE_Y, LEAST_PANEL_HEIGHT * em);
    if (narrow < width || low < height) layout_shrink_panels(layout, picture->panel_count, narrow, low);
}

void panels_arrange(Picture *picture, int width, int height, int legend) {
    picture->panel_count = panels_of(picture->look.compare, picture->count);
    LayoutRows rows = {1, 1, legend, (picture->look.show & LOOK_TIMELINE) != 0};
    picture->layout = layout_make(width, height, 1, 1, rows); /* for the fonts */
    rows.title = caption_header_title(picture).count;
    if (rows.title > TEXT_LINES_MAX) rows.title = TEXT_LINES_MAX;
    const CameraFrame frame = fixed_frame(picture);
    for (rows.caption = 1;; rows.caption++) { /* narrow panels need more lines */
        picture->layout = choose_grid(picture, &frame, width, height, rows);
        shrink_panels(picture, &frame);
        if (caption_lines(picture) <= rows.caption) break;
    }
    const Rect *first = &picture->layout.panels[0];
    picture->camera = camera_fit(&frame, width_of(first), height_of(first));
    picture->grid_scale = picture->camera.scale;
}

#define MINUS "\xE2\x88\x92"

/* Thin lines every `step` metres; every `strong`-th line is strong and labelled. */
typedef struct Steps {
    double step;
    int strong;
} Steps;

/* 0.1, 0.2, 0.5, 1, 2, 5, 10, ... */
static Steps nth_steps(int n) {
    static const Steps cycle[] = {{0.1, 5}, {0.2, 5}, {0.5, 2}};
    return (Steps){cycle[n % 3].step * pow(10, n / 3), cycle[n % 3].strong};
}

/* Steps of 1 m if they fit, otherwise the nearest that do. */
static Steps choose_steps(const Picture *picture) {
    Rect panel = picture->layout.panels[0];
    double height = panel.bottom - panel.top, scale = picture->grid_scale;
    int n = 3;
    while (nth_steps(n).step * scale < fmax(MIN_SPACING * height, MIN_PIXELS)) n++;
    while (n <= 3 && n > 0 && nth_steps(n).step * nth_steps(n).strong * scale > MAX_SPACING * height) n--;
    return nth_steps(n);
}

/* The lines across one side of a panel. Line i of `count` is number first + i, counted from 0 m. */
typedef struct Lines {
    double first, spacing, origin; /* pixels; `origin`: 0 m */
    int count;
} Lines;

static Lines lines_between(double origin, double spacing, double low, double high) {
    double first = ceil((low - origin) / spacing), last = floor((high - origin) / spacing);
    return (Lines){first, spacing, origin, (int)(last - first) + 1};
}

static Lines vertical_lines(const Picture *picture, Steps steps) {
    Rect panel = picture->layout.panels[0];
    double spacing = steps.step * picture->camera.scale;
    return lines_between(picture->camera.left, spacing, 0, panel.right - panel.left - 1);
}

/* Pixels counted upwards, like metres. */
static Lines horizontal_lines(const Picture *picture, Steps steps) {
    Rect panel = picture->layout.panels[0];
    double spacing = steps.step * picture->camera.scale;
    return lines_between(-picture->camera.top, spacing, -(panel.bottom - panel.top - 1), 0);
}

static double line_place(const Lines *lines, int i) { return lines->origin + (lines->first + i) * lines->spacing; }

static int line_pixel(const Lines *lines, int i) { return (int)rint(line_place(lines, i)); }

static bool is_strong(const Lines *lines, int i, Steps steps) { return fmod(lines->first + i, steps.strong) == 0; }

/* Strong lines have a tic and a number. Where fewer than three are in view, all lines have, if there is room. */
static bool all_have_tics(const Picture *picture, const Lines *lines, Steps steps) {
    int strong = 0;
    for (int i = 0; i < lines->count; i++) strong += is_strong(lines, i, steps);
    return strong < MIN_TICS && lines->spacing > NUMBER_SPACING * picture->layout.axis.pixels;
}

/* One line in how many has a number beside its tic, so that numbers of this many pixels have room. */
static double numbered(const Lines *lines, double tic, int room) {
    double every = 1;
    for (int i = 0; i < 30 && every * tic * lines->spacing < room; i++) every = round_up(1.5 * every);
    return every * tic;
}

static bool has_number(const Lines *lines, int i, double every) { return fmod(lines->first + i, every) == 0; }

/* Lines at whole pixels are crisp, but with a moving camera they would jitter: `off` restores the fraction lost by
   rounding. */
static void draw_line(const Picture *picture, int panel, Rect line, Point off, uint32_t color, Drawing *drawing) {
    if (picture->path == NULL) {
        drawing_add_rect(drawing, line, color);
        return;
    }
    Shape shape = {.x = (line.left + line.right) / 2.0 + off.x,
                   .y = (line.top + line.bottom) / 2.0 + off.y,
                   .half_width = (line.right - line.left) / 2.0,
                   .half_height = (line.bottom - line.top) / 2.0,
                   .cosine = 1,
                   .fill = color};
    drawing_add_shape(drawing, &shape, &picture->layout.panels[panel]);
}

static void draw_lines(const Picture *picture, int panel, bool strong, Drawing *drawing) {
    Steps steps = choose_steps(picture);
    Rect rect = picture->layout.panels[panel];
    Lines vertical = vertical_lines(picture, steps), horizontal = horizontal_lines(picture, steps);
    uint32_t color = strong ? picture->theme->grid_strong : picture->theme->grid;
    int thickness = picture->layout.hairline;
    for (int i = 0; i < vertical.count; i++) {
        int x = rect.left + line_pixel(&vertical, i);
        if (is_strong(&vertical, i, steps) == strong)
            draw_line(picture, panel, (Rect){x, rect.top, x + thickness, rect.bottom},
                      (Point){line_place(&vertical, i) - line_pixel(&vertical, i), 0}, color, drawing);
    }
    for (int i = 0; i < horizontal.count; i++) {
        int y = rect.top - line_pixel(&horizontal, i);
        if (is_strong(&horizontal, i, steps) == strong)
            draw_line(picture, panel, (Rect){rect.left, y, rect.right, y + thickness},
                      (Point){0, line_pixel(&horizontal, i) - line_place(&horizontal, i)}, color, drawing);
    }
}

static void grid_draw_lines(const Picture *picture, int panel, Drawing *drawing) {
    draw_lines(picture, panel, false, drawing);
    draw_lines(picture, panel, true, drawing);
}

static void format_metres(char *text, size_t size, double metres) {
    snprintf(text, size, "%s%g", metres < 0 ? MINUS : "", fabs(metres));
}

static int widest_number(const Font *font, const Lines *lines, Steps steps) {
    int widest = 0;
    for (int i = 0; i < lines->count; i++) {
        char text[32];
        if (!is_strong(lines, i, steps)) continue;
        format_metres(text, sizeof text, (lines->first + i) * steps.step);
        const int width = font_width(font, text);
        if (width > widest) widest = width;
    }
    return widest;
}

/* The unit is at the right end and replaces a number if there is no room for both. */
static void draw_bottom_axis(const Picture *picture, const Rect *rect, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    const Font *font = &layout->axis;
    Steps steps = choose_steps(picture);
    Lines lines = vertical_lines(picture, steps);
    int line = layout->hairline, baseline = rect->bottom + layout->axis_drop, gap = font->pixels / 2;
    int free_from = rect->left - font->pixels, unit = rect->right - font_width(font, "m");
    font_add(drawing, font, "m", unit, baseline, picture->theme->ink_soft);
    const bool all = all_have_tics(picture, &lines, steps);
    const double every = numbered(&lines, all ? 1 : steps.strong, widest_number(font, &lines, steps) + gap);
    for (int i = 0; i < lines.count; i++) {
        if (!all && !is_strong(&lines, i, steps)) continue;
        char text[32];
        format_metres(text, sizeof text, (lines.first + i) * steps.step);
        int x = rect->left + line_pixel(&lines, i), width = font_width(font, text), left = x - width / 2;
        drawing_add_rect(drawing, (Rect){x, rect->bottom + line, x + line, rect->bottom + line + layout->tick},
                         picture->theme->frame);
        if (!has_number(&lines, i, every) || left < free_from || left + width + gap > unit) continue;
        free_from = font_add(drawing, font, text, left, baseline, picture->theme->ink_soft) + gap;
    }
}

static void draw_left_axis(const Picture *picture, const Rect *rect, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    Steps steps = choose_steps(picture);
    Lines lines = horizontal_lines(picture, steps);
    int line = layout->hairline, rise = layout->axis.pixels * 3 / 8; /* half the height of a digit */
    const bool all = all_have_tics(picture, &lines, steps);
    const double every = numbered(&lines, all ? 1 : steps.strong, layout->axis.pixels);
    for (int i = 0; i < lines.count; i++) {
        if (!all && !is_strong(&lines, i, steps)) continue;
        char text[32];
        format_metres(text, sizeof text, (lines.first + i) * steps.step);
        int y = rect->top - line_pixel(&lines, i);
        int right = rect->left - line - layout->tick;
        drawing_add_rect(drawing, (Rect){right, y, rect->left - line, y + line}, picture->theme->frame);
        int left = right - layout->tick - font_width(&layout->axis, text);
        if (left >= 0 && has_number(&lines, i, every))
            font_add(drawing, &layout->axis, text, left, y + rise, picture->theme->ink_soft);
    }
}

/* Ticks and numbers below every panel, and left of the first column: all panels have the same camera. */
static void grid_draw_axes(const Picture *picture, int panel, Drawing *drawing) {
    if (picture->layout.axis.glyphs == NULL) return;
    draw_bottom_axis(picture, &picture->layout.panels[panel], drawing);
    if (panel % picture->layout.columns == 0) draw_left_axis(picture, &picture->layout.panels[panel], drawing);
}

static const double MAX_SPEED = 1e4; /* m/s; faster bodies, of an exploding run, do not count */

static double fastest(const Trajectory *run) {
    double square = 0;
    for (size_t i = 0; i < (size_t)run->frames * (size_t)run->bodies; i++) {
        double x = (double)run->velocity[i].x, y = (double)run->velocity[i].y, v = x * x + y * y;
        if (v > square && v < MAX_SPEED * MAX_SPEED) square = v;
    }
    return sqrt(square);
}

static int compare_floats(const void *a, const void *b) {
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* m: the median of the shorter sides of the dynamic bodies without the bomb; 1 without any. */
static bool median_box(const Trajectory *run, double *side, Error *error) {
    float *sides = malloc(((size_t)run->bodies + 1) * sizeof *sides);
    size_t count = 0;
    if (sides == NULL) return error_memory(error, "render");
    for (int body = 0; body < run->bodies; body++)
        if (!run->fixed[body] && body != run->bomb) sides[count++] = fminf(run->size[body].x, run->size[body].y);
    qsort(sides, count, sizeof *sides, compare_floats);
    *side = count > 0 ? (double)sides[count / 2] : 1;
    free(sides);
    return true;
}

/* Finds the 90th percentile of the positive impulses; 0 if there are none. */
static bool common_impulse(const Trajectory *run, double *impulse, Error *error) {
    size_t total = (size_t)run->contact_start[run->frames], count = 0;
    float *impulses = malloc((total + 1) * sizeof *impulses);
    if (impulses == NULL) return error_memory(error, "render");
    for (size_t i = 0; i < total; i++) {
        float normal = run->contacts[i].normal_impulse;
        if (normal > 0 && isfinite(normal)) impulses[count++] = normal;
    }
    qsort(impulses, count, sizeof *impulses, compare_floats);
    *impulse = count > 0 ? (double)impulses[count - 1 - count / 10] : 0;
    free(impulses);
    return true;
}

bool scales_measure(const Trajectory *run, ScaleMeasures *measures, Error *error) {
    measures->speed = fastest(run);
    return common_impulse(run, &measures->impulse, error) && median_box(run, &measures->box, error);
}

/* Sets the pixels per unit, and the value of the legend's arrow. */
static void panel_choose(double *scale, double *legend, double value, double pixels, double max_legend) {
    *scale = value > 1e-9 ? pixels / value : pixels;
    *legend = round_down(fmin(max_legend / *scale, 5e12));
}

bool scales_choose(Scales *scales, const Trajectory *run, const Layout *layout, double scale, double largest_distance,
                   Error *error) {
    Rect panel = layout->panels[0];
    double side = fmin(panel.right - panel.left, panel.bottom - panel.top);
    ScaleMeasures measures;
    if (!scales_measure(run, &measures, error)) return false;
    const double box = scales->box = scale * measures.box, legend = fmin(LEGEND_ARROW * side, LEGEND_ARROW_BOXES * box);
    scales->max_arrow = fmin(MAX_ARROW * side, MAX_ARROW_BOXES * box);
    panel_choose(&scales->impulse, &scales->legend_impulse, measures.impulse,
                 fmin(COMMON_ARROW * side, COMMON_ARROW_BOXES * box), legend);
    panel_choose(&scales->velocity, &scales->legend_velocity, measures.speed,
                 fmin(FASTEST_ARROW * side, FASTEST_ARROW_BOXES * box), legend);
    double power = 1;
    for (scales->last_decade = 0; power < largest_distance && scales->last_decade < SCALE_LAST_DECADE; power *= 10)
        scales->last_decade++;
    scales->exceeded = power < largest_distance;
    return true;
}

double scales_share(const Scales *scales, double distance) {
    if (!(distance > 1e-3)) return 0;
    return fmin(1, (log10(distance) - SCALE_FIRST_DECADE) / (scales->last_decade - SCALE_FIRST_DECADE));
}

Point panel_point(const Picture *picture, int panel, double x, double y) {
    const Camera *camera = &picture->camera;
    const Rect *rect = &picture->layout.panels[panel];
    return (Point){rect->left + camera->left + camera->scale * x, rect->top + camera->top - camera->scale * y};
}

double panel_side(const Picture *picture) {
    Rect panel = picture->layout.panels[0];
    return fmin(panel.right - panel.left, panel.bottom - panel.top);
}

static void draw_frame(const Rect *r, int thickness, uint32_t color, Drawing *drawing) {
    int left = r->left - thickness, right = r->right + thickness;
    drawing_add_rect(drawing, (Rect){left, r->top - thickness, right, r->top}, color);
    drawing_add_rect(drawing, (Rect){left, r->bottom, right, r->bottom + thickness}, color);
    drawing_add_rect(drawing, (Rect){left, r->top, r->left, r->bottom}, color);
    drawing_add_rect(drawing, (Rect){r->right, r->top, right, r->bottom}, color);
}

void panel_draw_static(const Picture *picture, int panel, Moment moment, Drawing *drawing) {
    const Rect *rect = &picture->layout.panels[panel];
    drawing_add_rect(drawing, *rect, picture->theme->panel);
    grid_draw_lines(picture, panel, drawing);
    body_draw_all(picture, panel, picture_run(picture, panel), moment, true, drawing);
    draw_frame(rect, picture->layout.hairline, picture->theme->frame, drawing);
    grid_draw_axes(picture, panel, drawing);
}

void panel_draw_moving(const Picture *picture, int panel, Moment moment, Drawing *drawing) {
    int run = picture_run(picture, panel), bomb = picture->runs[run]->bomb;
    marks_draw_below(picture, panel, moment, drawing);
    body_draw_all(picture, panel, run, moment, false, drawing);
    if (bomb >= 0) body_draw(picture, panel, run, moment, bomb, drawing);
    for (int other = 0; other < picture->count; other++)
        if (picture_draws_outlines(picture, panel, other)) body_draw_outlines(picture, panel, other, moment, drawing);
    marks_draw_above(picture, panel, moment, drawing);
}

int panel_count_out_of_view(const Picture *picture, int panel, Moment moment) {
    int run = picture_run(picture, panel), count = 0;
    const Trajectory *trajectory = picture->runs[run];
    const Rect *rect = &picture->layout.panels[panel];
    int frame = pose_moment(trajectory, moment).frame;
    for (int body = 0; body < trajectory->bodies; body++) {
        if (trajectory->fixed[body] || body == trajectory->bomb || !trajectory_has(trajectory, frame, body)) continue;
        Pose pose = pose_at(trajectory, moment, body);
        Point at = panel_point(picture, panel, pose.x, pose.y);
        bool inside = at.x >= rect->left && at.x < rect->right && at.y >= rect->top && at.y < rect->bottom;
        count += !inside;
    }
    return count;
}
