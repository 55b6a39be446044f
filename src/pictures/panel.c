/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A panel: its metre grid and axes, and its layers. */
#include "base/numbers.h"
#include "pictures/pictures_internal.h"
#include "pictures/picture.h"
#include "pixels/gl.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdio.h>

#define MINUS "\xE2\x88\x92"

/* The lines across one side of a panel. Line i of `count` is number first + i, counted from 0 m; every `strong`-th is
   strong and labelled. */
typedef struct Lines {
    double step;                   /* m */
    double first, spacing, origin; /* pixels; `origin`: 0 m */
    int strong, count;
} Lines;

/* m: 0.1, 0.2, 0.5, 1, 2, 5, 10, ... */
static double nth_step(int n) {
    static const double cycle[] = {0.1, 0.2, 0.5};
    return cycle[n % 3] * pow(10, n / 3);
}

/* Pixels are counted like metres, upwards. Steps of 1 m if they fit, otherwise the nearest that do. */
static Lines lines_across(const Picture *picture, bool vertical) {
    static const int strong[] = {5, 5, 2};
    const Camera *camera = &picture->camera;
    const Rect *panel = &picture->layout.panels[0];
    const double width = panel->right - panel->left, height = panel->bottom - panel->top, scale = picture->grid_scale;
    int n = 3;
    double step = nth_step(n);
    while (step * scale < fmax(MIN_SPACING * height, MIN_PIXELS)) n++, step = nth_step(n);
    while (n <= 3 && n > 0 && step * strong[n % 3] * scale > MAX_SPACING * height) n--, step = nth_step(n);
    const double spacing = step * camera->scale, origin = vertical ? camera->left : -camera->top,
                 low = vertical ? 0 : -(height - 1), high = vertical ? width - 1 : 0;
    const double first = ceil((low - origin) / spacing), last = floor((high - origin) / spacing);
    return (Lines){step, first, spacing, origin, strong[n % 3], (int)(last - first) + 1};
}

static double line_place(const Lines *lines, int i) { return lines->origin + (lines->first + i) * lines->spacing; }
static int line_pixel(const Lines *lines, int i) { return (int)rint(line_place(lines, i)); }

static bool is_strong(const Lines *lines, int i) { return fmod(lines->first + i, lines->strong) == 0; }

/* Lines at whole pixels are crisp, but with a moving camera they would jitter: they keep the fraction lost by
   rounding. */
static void draw_lines(const Picture *picture, int panel, bool strong, Drawing *drawing) {
    const Rect *rect = &picture->layout.panels[panel];
    const uint32_t color = strong ? picture->theme->grid_strong : picture->theme->grid;
    const int thickness = picture->layout.hairline;
    for (int vertical = 1; vertical >= 0; vertical--) {
        const Lines lines = lines_across(picture, vertical == 1);
        for (int i = 0; i < lines.count; i++) {
            if (is_strong(&lines, i) != strong) continue;
            const int pixel = line_pixel(&lines, i), x = rect->left + pixel, y = rect->top - pixel;
            const double off = line_place(&lines, i) - pixel;
            const Rect line = vertical == 1 ? (Rect){x, rect->top, x + thickness, rect->bottom}
                                            : (Rect){rect->left, y, rect->right, y + thickness};
            const Shape moving = {.x = (line.left + line.right) / 2.0 + (vertical == 1 ? off : 0),
                                  .y = (line.top + line.bottom) / 2.0 - (vertical == 1 ? 0 : off),
                                  .half_width = (line.right - line.left) / 2.0,
                                  .half_height = (line.bottom - line.top) / 2.0,
                                  .cosine = 1,
                                  .fill = color};
            if (picture->path == NULL)
                drawing_add_rect(drawing, line, color);
            else
                drawing_add_shape(drawing, &moving, rect);
        }
    }
}

/* Which lines have a tic: strong ones, or all where fewer than three strong ones are in view, if there is room. One in
   how many has a number beside its tic, so that numbers of `room` pixels have room. */
typedef struct Tics {
    bool all;
    double every; /* line */
} Tics;

static Tics choose_tics(const Picture *picture, const Lines *lines, int room) {
    int strong = 0;
    for (int i = 0; i < lines->count; i++) strong += is_strong(lines, i);
    const bool all = strong < MIN_TICS && lines->spacing > NUMBER_SPACING * picture->layout.axis.pixels;
    const double tic = all ? 1 : lines->strong;
    double every = 1;
    for (int i = 0; i < 30 && every * tic * lines->spacing < room; i++) every = round_up(1.5 * every);
    return (Tics){all, every * tic};
}

/* The number of a line, in metres. */
static void format_line(char *text, size_t size, const Lines *lines, int i) {
    const double metres = (lines->first + i) * lines->step;
    snprintf(text, size, "%s%g", metres < 0 ? MINUS : "", fabs(metres));
}

/* The unit is at the right end and replaces a number if there is no room for both. */
static void draw_bottom_axis(const Picture *picture, const Rect *rect, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    const Font *font = &layout->axis;
    Lines lines = lines_across(picture, true);
    int line = layout->hairline, baseline = rect->bottom + layout->axis_drop, gap = font->pixels / 2, widest = 0;
    int free_from = rect->left - font->pixels, unit = rect->right - font_width(font, "m");
    char text[32];
    font_add(drawing, font, "m", unit, baseline, picture->theme->ink_soft);
    for (int i = 0; i < lines.count; i++) {
        if (!is_strong(&lines, i)) continue;
        format_line(text, sizeof text, &lines, i);
        widest = int_max(widest, font_width(font, text));
    }
    const Tics tics = choose_tics(picture, &lines, widest + gap);
    for (int i = 0; i < lines.count; i++) {
        if (!tics.all && !is_strong(&lines, i)) continue;
        format_line(text, sizeof text, &lines, i);
        int x = rect->left + line_pixel(&lines, i), width = font_width(font, text), left = x - width / 2;
        drawing_add_rect(drawing, (Rect){x, rect->bottom + line, x + line, rect->bottom + line + layout->tick},
                         picture->theme->frame);
        if (fmod(lines.first + i, tics.every) != 0 || left < free_from || left + width + gap > unit) continue;
        free_from = font_add(drawing, font, text, left, baseline, picture->theme->ink_soft) + gap;
    }
}

static void draw_left_axis(const Picture *picture, const Rect *rect, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    Lines lines = lines_across(picture, false);
    int line = layout->hairline, rise = layout->axis.pixels * 3 / 8; /* half the height of a digit */
    const Tics tics = choose_tics(picture, &lines, layout->axis.pixels);
    for (int i = 0; i < lines.count; i++) {
        if (!tics.all && !is_strong(&lines, i)) continue;
        char text[32];
        format_line(text, sizeof text, &lines, i);
        int y = rect->top - line_pixel(&lines, i);
        int right = rect->left - line - layout->tick;
        drawing_add_rect(drawing, (Rect){right, y, rect->left - line, y + line}, picture->theme->frame);
        int left = right - layout->tick - font_width(&layout->axis, text);
        if (left >= 0 && fmod(lines.first + i, tics.every) == 0)
            font_add(drawing, &layout->axis, text, left, y + rise, picture->theme->ink_soft);
    }
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

void panel_draw_static(const Picture *picture, int panel, Moment moment, Drawing *drawing) {
    const Rect *rect = &picture->layout.panels[panel];
    drawing_add_rect(drawing, *rect, picture->theme->panel);
    draw_lines(picture, panel, false, drawing);
    draw_lines(picture, panel, true, drawing);
    body_draw_all(picture, panel, picture_run(picture, panel), moment, true, drawing);

    const int thick = picture->layout.hairline, left = rect->left - thick, right = rect->right + thick;
    const uint32_t frame = picture->theme->frame;
    drawing_add_rect(drawing, (Rect){left, rect->top - thick, right, rect->top}, frame);
    drawing_add_rect(drawing, (Rect){left, rect->bottom, right, rect->bottom + thick}, frame);
    drawing_add_rect(drawing, (Rect){left, rect->top, rect->left, rect->bottom}, frame);
    drawing_add_rect(drawing, (Rect){rect->right, rect->top, right, rect->bottom}, frame);

    /* Numbers below every panel, and left of the first column: all panels have the same camera. */
    if (picture->layout.axis.glyphs == NULL) return;
    draw_bottom_axis(picture, rect, drawing);
    if (panel % picture->layout.columns == 0) draw_left_axis(picture, rect, drawing);
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
