/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/grid.h"

#include "gl/stroke.h"

#include <math.h>
#include <stdio.h>

static const double MIN_SPACING = 0.010;  /* between thin lines / the panel's height */
static const double MIN_PIXELS = 6;       /* the same, in pixels */
static const double MAX_SPACING = 0.6;    /* between strong lines / the panel's height */
static const double NUMBER_SPACING = 2.5; /* ems between two lines that both have a number */
enum { MIN_TICS = 3 };
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

/* Every how manieth line with a tic has a number: 1, 2, 5, 10, ... until numbers of this many pixels have room. */
static double numbered(const Lines *lines, double tic, int room) {
    static const double steps[] = {1, 2, 5};
    double power = 1;
    for (int i = 0; i < 30; i++) {
        const double every = steps[i % 3] * power;
        if (every * tic * lines->spacing >= room) return every * tic;
        if (i % 3 == 2) power *= 10;
    }
    return HUGE_VAL;
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

void grid_draw_lines(const Picture *picture, int panel, Drawing *drawing) {
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

void grid_draw_axes(const Picture *picture, int panel, Drawing *drawing) {
    if (picture->layout.axis.glyphs == NULL) return;
    draw_bottom_axis(picture, &picture->layout.panels[panel], drawing);
    if (panel % picture->layout.columns == 0) draw_left_axis(picture, &picture->layout.panels[panel], drawing);
}
