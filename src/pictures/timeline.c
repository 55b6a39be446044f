/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The curves of distances over time below the panels. */
#include "base/base.h"
#include "base/numbers.h"
#include "pictures/pictures_internal.h"
#include "pictures/picture.h"
#include "pixels/gl.h"
#include "pixels/png.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { MAX_TICKS = 200 };
static const double CURVE = 0.0024, MIN_CURVE = 1.3; /* thickness / the picture's height; pixels */
static const double TICK_SPACING = 5;                /* ems between two times on the axis */
static const double TOLERANCE = 0.2;                 /* pixels; largest deviation of a segment from the curve */
#define MICRO "\xC2\xB5"

/* Distinguishes runs in grey prints; the first run has no curve. */
static const Dash dashes[RENDER_PANELS_MAX] = {{0, 0, 0, 0}, {0, 0, 0, 0}, {5, 3, 0, 0},
                                               {1, 2, 0, 0}, {7, 2, 1, 2}, {3, 2, 3, 5}};

bool timeline_plan(Picture *picture, Error *error) {
    if ((picture->look.show & SHOW_TIMELINE) == 0) return true;
    int width = picture->layout.timeline.right - picture->layout.timeline.left, points = width;
    if (points > picture->frames) points = picture->frames;
    picture->curve_points = points;
    picture->curves = calloc((size_t)picture->count * (size_t)points, sizeof *picture->curves);
    if (picture->curves == NULL) return error_memory(error, "render");
    for (int run = 0; run < picture->count; run++)
        for (int i = 0; i < points; i++) {
            int first = (int)((long long)picture->frames * i / points);
            int end = (int)((long long)picture->frames * (i + 1) / points);
            double largest = NAN;
            for (int frame = first; frame < end; frame++)
                largest = fmax(largest, picture_run_distance(picture, run, moment_stored(frame)));
            picture->curves[run * points + i] = (float)largest;
        }
    return true;
}

static int highest_decade(const Picture *picture) {
    double power = 1;
    int decade = 0;
    while (power < picture->largest_distance && decade < HIGHEST_DECADE) power *= 10, decade++;
    while (power / 10 >= picture->largest_distance && decade > LOWEST_DECADE + MIN_DECADES) power /= 10, decade--;
    return decade;
}

static double x_at(const Picture *picture, double frame) {
    const Rect *plot = &picture->layout.timeline;
    int last = picture->frames > 1 ? picture->frames - 1 : 1;
    return plot->left + 0.5 + (plot->right - plot->left - 1) * frame / last;
}

/* Height of the lane above the curves, for the names of events. */
static int lane_height(const Picture *picture) { return picture->layout.axis.pixels * 3 / 2; }

static double y_of_decade(const Picture *picture, double decade) {
    const Rect *plot = &picture->layout.timeline;
    int highest = highest_decade(picture);
    double share = (fmin(decade, highest) - LOWEST_DECADE) / (highest - LOWEST_DECADE);
    return plot->bottom - (plot->bottom - plot->top - lane_height(picture)) * share;
}

static double y_at(const Picture *picture, double metres) {
    return y_of_decade(picture, metres > 1e-6 ? log10(metres) : LOWEST_DECADE);
}

static double thickness(const Picture *picture) { return fmax(CURVE * picture->layout.height, MIN_CURVE); }

/* The last point after `i` that a straight segment reaches with an error below TOLERANCE. Fewer segments have fewer
   joints, where antialiased edges add up. */
static int segment_end(const Picture *picture, const float *curve, int i) {
    double least = -HUGE_VAL, most = HUGE_VAL, y = y_at(picture, (double)curve[i]);
    int end = i + 1;
    for (int k = end; k < picture->curve_points && !isnan(curve[k]); k++) {
        double rise = y_at(picture, (double)curve[k]) - y, slope = rise / (k - i);
        if (slope < least || slope > most) break;
        least = fmax(least, (rise - TOLERANCE) / (k - i));
        most = fmin(most, (rise + TOLERANCE) / (k - i));
        end = k;
    }
    return end;
}

static void draw_curve(const Picture *picture, int run, Drawing *drawing) {
    const float *curve = picture->curves + (size_t)run * (size_t)picture->curve_points;
    DashedLine line = {thickness(picture), 0, picture_body_colors(picture, run)->fill, dashes[run]};
    Rect clip = picture->layout.timeline;
    clip.top -= 2, clip.bottom += 2;
    double every = (double)picture->frames / picture->curve_points;
    for (int i = 0, end; i + 1 < picture->curve_points && !isnan(curve[i]) && !isnan(curve[i + 1]); i = end) {
        end = segment_end(picture, curve, i);
        Point from = {x_at(picture, i * every), y_at(picture, (double)curve[i])};
        Point to = {x_at(picture, end * every), y_at(picture, (double)curve[end])};
        stroke_dashed(drawing, from, to, &line, &clip);
    }
}

/* A line per decade, a label every third. No logarithm: rounding to pixels must be the same on every machine. */
static void draw_distance_axis(const Picture *picture, Drawing *drawing) {
    static const char *const names[] = {"1 " MICRO "m", "1 mm", "1 m", "1 km"};
    const Layout *layout = &picture->layout;
    const Rect *plot = &layout->timeline;
    int line = layout->hairline, highest = highest_decade(picture);
    for (int decade = LOWEST_DECADE; decade <= highest; decade++) {
        int y = (int)rint(y_of_decade(picture, decade)), named = (decade - LOWEST_DECADE) % 3 == 0;
        if (decade > LOWEST_DECADE && decade < highest)
            drawing_add_rect(drawing, (Rect){plot->left, y, plot->right, y + line},
                             named ? picture->theme->grid_strong : picture->theme->grid);
        if (!named || layout->axis.glyphs == NULL) continue;
        const char *name = names[(decade - LOWEST_DECADE) / 3];
        int left = plot->left - 2 * layout->tick - font_width(&layout->axis, name);
        font_add(drawing, &layout->axis, name, left, y + layout->axis.pixels * 3 / 8, picture->theme->ink_soft);
    }
}

static void draw_time_axis(const Picture *picture, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    const Rect *plot = &layout->timeline;
    if (layout->axis.glyphs == NULL) return;
    const double dt = (double)picture->runs[0]->dt, duration = (picture->frames - 1) * dt;
    const double least = TICK_SPACING * layout->axis.pixels * duration / (plot->right - plot->left),
                 step = round_up(fmax(least, 1e-3)); /* s between two labels */
    int baseline = plot->bottom + layout->axis_drop, unit = plot->right - font_width(&layout->axis, "s");
    font_add(drawing, &layout->axis, "s", unit, baseline, picture->theme->ink_soft);
    for (int i = 0; i < MAX_TICKS && i * step / dt <= picture->frames - 1 + 1e-6; i++) {
        int x = (int)floor(x_at(picture, i * step / dt)), line = layout->hairline;
        char text[32];
        snprintf(text, sizeof text, "%g", i * step);
        int width = font_width(&layout->axis, text), left = x - width / 2;
        drawing_add_rect(drawing, (Rect){x, plot->bottom, x + line, plot->bottom + line + layout->tick},
                         picture->theme->frame);
        if (left + width + layout->axis.pixels / 2 <= unit)
            font_add(drawing, &layout->axis, text, left, baseline, picture->theme->ink_soft);
    }
}

/* A line over the full height with its name at the right, or at the left if it would reach beyond `right`. */
static void draw_event(const Picture *picture, int frame, const char *name, int right, Drawing *drawing) {
    const Layout *layout = &picture->layout;
    const Rect *plot = &layout->timeline;
    int x = (int)floor(x_at(picture, frame)), line = 2 * layout->hairline, gap = layout->axis.pixels / 3;
    drawing_add_rect(drawing, (Rect){x, plot->top, x + line, plot->bottom}, picture->theme->event);
    int width = font_width(&layout->axis, name), left = x + line + gap;
    if (left + width > right) left = x - gap - width;
    if (left > plot->left)
        font_add(drawing, &layout->axis, name, left, plot->top + layout->axis.pixels * 9 / 8, picture->theme->ink);
}

/* Lengths in the key of a sample line and of the spaces after it and after its name. */
typedef struct KeySpacing {
    int sample, before, gap;
} KeySpacing;

/* The title of the curves if there is room, and a sample line with the name of each run. */
static void draw_key(const Picture *picture, Drawing *drawing) {
    static const char *const formats[] = {"Largest distance from %s", "Distance from %s"};
    const Layout *layout = &picture->layout;
    const Font *font = &layout->method;
    const Rect clip = {0, 0, layout->width, layout->height};
    const int em = font->pixels, count = picture->count - 1, baseline = layout->key_baseline;
    KeySpacing spacing = {em * 5 / 2, em / 2, em * 3 / 2};
    char names[RENDER_PANELS_MAX][CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE], title[2 * CAPTION_TEXT_SIZE] = "";
    int widths[RENDER_PANELS_MAX], sum = 0, x = layout->timeline.left, room = layout->right - x, start = x;
    if (font->glyphs == NULL) return;
    for (int i = 0; i <= count; i++) {
        caption_method(picture, i, names[i], note);
        widths[i] = font_width(font, names[i]);
        if (i > 0) sum += widths[i];
    }
    int lines = count * (spacing.sample + spacing.before) + (count - 1) * spacing.gap; /* all but the names */
    for (int i = 0; i < 2 && start == x; i++) {
        snprintf(title, sizeof title, formats[i], names[0]);
        const int width = font_width(font, title) + 2 * em;
        if (width + sum + lines <= room) start = x + width;
    }
    if (start == x) title[0] = '\0';
    if (sum + lines > room) {
        spacing = (KeySpacing){em * 3 / 2, em / 3, em * 2 / 3};
        lines = count * (spacing.sample + spacing.before) + (count - 1) * spacing.gap;
    }
    const int most = caption_fair_width(widths + 1, count, layout->right - start - lines);
    font_add(drawing, font, title, x, baseline, picture->theme->ink_soft);
    x = start;
    for (int i = 1; i <= count; i++) {
        DashedLine line = {thickness(picture), 0, picture_body_colors(picture, i)->fill, dashes[i]};
        const double y = baseline - em * 0.36;
        stroke_dashed(drawing, (Point){x, y}, (Point){x + spacing.sample, y}, &line, &clip);
        x += spacing.sample + spacing.before;
        x = caption_name_draw(picture, font, names[i], x, baseline, int_min(widths[i], most), drawing);
        x += spacing.gap;
    }
}

void timeline_draw_static(const Picture *picture, Drawing *drawing) {
    if (picture->curves == NULL) return;
    const Rect *plot = &picture->layout.timeline;
    int line = picture->layout.hairline;
    drawing_add_rect(drawing, *plot, picture->theme->panel);
    draw_distance_axis(picture, drawing);
    /* The name of the earlier event must not reach the later one's line. */
    const int impact = picture->events.impact, divergence = picture->events.divergence;
    if (impact >= 0)
        draw_event(picture, impact, "impact", impact < divergence ? (int)x_at(picture, divergence) : plot->right,
                   drawing);
    if (divergence >= 0)
        draw_event(picture, divergence, "1 mm apart", divergence <= impact ? (int)x_at(picture, impact) : plot->right,
                   drawing);
    drawing_add_rect(drawing, (Rect){plot->left, plot->bottom, plot->right, plot->bottom + line},
                     picture->theme->frame);
    draw_time_axis(picture, drawing);
    for (int run = 1; run < picture->count; run++) draw_curve(picture, run, drawing);
    draw_key(picture, drawing);
}

void timeline_draw_moving(const Picture *picture, Moment moment, Drawing *drawing) {
    if (picture->curves == NULL) return;
    const Rect *plot = &picture->layout.timeline;
    double x = x_at(picture, moment.frame + moment_fraction(moment)), radius = 1.6 * thickness(picture);
    const Rect clip = {plot->left - 8, plot->top - 8, plot->right + 8, plot->bottom + 8};
    stroke_line(drawing, (Point){x, plot->top + lane_height(picture)}, (Point){x, plot->bottom},
                1.5 * picture->layout.hairline, picture->theme->ink, &clip);
    for (int run = 1; run < picture->count; run++) {
        double distance = picture_run_distance(picture, run, moment);
        if (isnan(distance)) continue;
        stroke_dot(drawing, (Point){x, y_at(picture, distance)}, radius, picture_body_colors(picture, run)->fill,
                   picture->theme->ink, &clip);
    }
}
