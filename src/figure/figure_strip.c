/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Moments of runs: a row per run, a column per moment, all with one camera. */
#include "common/method_look.h"
#include "figure/caption.h"
#include "figure/figure_kinds.h"
#include "figure/run_view.h"
#include "picture/extent.h"
#include "picture/style.h"
#include "type/type.h"

#include <math.h>
#include <string.h>

static const double gap = 1.2, edge = 0.2; /* mm: between cells; margin of the page, half a frame line */

enum { DEFAULT_MOMENTS = 5 };

typedef struct Strip {
    const FigureSpec *spec;
    int frames[FIGURE_MOMENTS_MAX], count;
    RunCells cells;
    MethodColour colours[FIGURE_RUNS_MAX];
    double left, top, foot; /* mm: space beside, above and below the cells */
    double start;           /* left end of the first cell */
} Strip;

static double strip_height(const Strip *strip) {
    return strip->top + strip->foot + strip->spec->run_count * (strip->cells.height + gap) - gap;
}

static bool check_bodies(const FigureSpec *spec, Error *error) {
    for (int i = 0; i < spec->body_count; i++)
        if (spec->bodies[i] >= spec->runs[0]->bodies)
            return error_input(error, "--bodies", "there is no body %d; the run has %d bodies", spec->bodies[i],
                               spec->runs[0]->bodies);
    return true;
}

/* Where the bodies in question are in the first run, at these moments, with a body's room around them. */
static WorldWindow window_of_bodies(const Strip *strip) {
    const FigureSpec *spec = strip->spec;
    const Trajectory *run = spec->runs[0];
    Extent all = extent_empty;
    double margin = 0.2; /* m, at least */
    for (int i = 0; i < spec->body_count; i++) {
        const Vec2 size = run->size[spec->bodies[i]];
        for (int moment = 0; moment < strip->count; moment++)
            extent_include(&all, run, strip->frames[moment], spec->bodies[i]);
        if (!run->fixed[spec->bodies[i]]) margin = fmax(margin, fmin((double)size.x, (double)size.y) / 2);
    }
    if (extent_is_empty(&all)) return run_window(spec, strip->frames, strip->count);
    return (WorldWindow){all.left - margin, all.bottom - margin, all.right - all.left + 2 * margin,
                         all.top - all.bottom + 2 * margin};
}

/* Cells beside names of this many lines. */
static bool lay_out_beside(Strip *strip, int lines, Error *error) {
    const FigureSpec *spec = strip->spec;
    const double line = line_height(spec->points);
    strip->left = (lines + 0.1) * line, strip->top = 1.15 * line, strip->foot = line + 0.6;
    const double width = (spec->width - edge - strip->left - (strip->count - 1) * gap) / strip->count;
    const double height = ((spec->height > 0 ? spec->height : FIGURE_HEIGHT_MAX) - strip->top - strip->foot -
                           (spec->run_count - 1) * gap) /
                          spec->run_count;
    const double least = 5;
    if (width < least || height < least)
        return error_input(error, "figure",
                           "%d moments of %d runs leave %.1f x %.1f mm per cell at a width of %g mm; at least "
                           "%g mm are needed",
                           strip->count, spec->run_count, fmax(width, 0), fmax(height, 0), spec->width, least);
    WorldWindow window = run_window(spec, strip->frames, strip->count);
    if (spec->body_count > 0) window = window_of_bodies(strip);
    if (spec->height > 0) run_window_fill(&window, width / height);
    if (!run_cells_begin(&strip->cells, &window, width, height, spec->dpi, error)) return false;
    if (!sketch_check_pixels(spec->width, strip_height(strip), spec->dpi, error)) return false;
    const double used = strip->left + edge + strip->count * strip->cells.width + (strip->count - 1) * gap;
    strip->start = (spec->width - used) / 2 + strip->left;
    return true;
}

static bool names_fit(const Strip *strip) {
    for (int i = 0; i < strip->spec->run_count; i++)
        if (type_width(run_name(strip->spec, strip->spec->runs[i]).text, strip->spec->points) > strip->cells.height)
            return false;
    return true;
}

static bool lay_out(Strip *strip, Error *error) {
    if (!lay_out_beside(strip, 1, error)) return false;
    if (names_fit(strip)) return true;
    run_cells_free(&strip->cells);
    return lay_out_beside(strip, 2, error);
}

static Point cell_corner(const Strip *strip, int row, int column) {
    const RunCells *cells = &strip->cells;
    return (Point){strip->start + column * (cells->width + gap),
                   strip->foot + (strip->spec->run_count - 1 - row) * (cells->height + gap)};
}

/* Of the bodies in question: that others are cut off is meant. */
static int count_outside(const Strip *strip, const Trajectory *run, int frame) {
    const FigureSpec *spec = strip->spec;
    if (spec->body_count == 0) return run_count_outside(run, frame, &strip->cells.window);
    int count = 0;
    for (int i = 0; i < spec->body_count; i++)
        count += !run->fixed[spec->bodies[i]] && run_is_outside(run, frame, spec->bodies[i], &strip->cells.window);
    return count;
}

/* In the upper right corner of a cell, in as many words as it has room for. */
static void draw_outside(const Strip *strip, Sketch *sketch, Point corner, int count) {
    const double points = 0.85 * strip->spec->points, margin = 0.8;
    char words[32];
    snprintf(words, sizeof words, "%d out of view", count);
    if (type_width(words, points) > strip->cells.width - 2 * margin) snprintf(words, sizeof words, "%d out", count);
    const double share = fmin(1, (strip->cells.width - 2 * margin) / type_width(words, points));
    sketch_text(sketch, (Point){corner.x - margin, corner.y - line_height(strip->spec->points) / 2},
                &(TextStyle){share * points, TEXT_RIGHT, INK_SOFT, 0, true}, "%s", words);
}

static bool draw_cell(const Strip *strip, Sketch *sketch, int row, int column, Error *error) {
    RunCells cells = strip->cells;
    const FigureSpec *spec = strip->spec;
    const Trajectory *run = spec->runs[row];
    const Point low = cell_corner(strip, row, column), high = {low.x + cells.width, low.y + cells.height};
    const int frame = strip->frames[column], outside = count_outside(strip, run, frame);
    if (!run_cells_draw(&cells, sketch, low, run, frame, strip->colours[row], error)) return false;
    sketch_rectangle(sketch, low, high, &(Pen){NO_COLOUR, 1, FRAME, 1.2, NULL});
    if (outside > 0) draw_outside(strip, sketch, high, outside);
    return true;
}

static const double SMALLEST_NAME = 0.6; /* share of the font size; a name longer than that is cut */

/* A line of a turned text beside a row, smaller if its row is too short for it. */
static void draw_turned(const Strip *strip, Sketch *sketch, Point at, const char *words) {
    const double points = strip->spec->points;
    const double room = fmin(1, strip->cells.height / type_width(words, points));
    sketch_text(sketch, at, &(TextStyle){room * points, TEXT_CENTER, INK, 90, false}, "%s", words);
}

/* The name of the method stays whole; its settings get a second line, and are cut to their row. */
static void draw_name(const Strip *strip, Sketch *sketch, const RunName *name, Point low) {
    const double middle = low.y + strip->cells.height / 2, points = strip->spec->points;
    const size_t head = method_name_head(name->text);
    if (type_width(name->text, points) <= strip->cells.height || name->text[head] == '\0') {
        RunName whole = *name;
        text_fit(whole.text, sizeof whole.text, points, strip->cells.height / SMALLEST_NAME);
        draw_turned(strip, sketch, (Point){low.x - 0.55 * line_height(points), middle}, whole.text);
        return;
    }
    RunName method = *name, settings = *name;
    method.text[head + 1] = '\0';
    memmove(settings.text, name->text + head + 1, sizeof settings.text - head - 1);
    text_fit(settings.text, sizeof settings.text, points, strip->cells.height);
    draw_turned(strip, sketch, (Point){low.x - 1.5 * line_height(points), middle}, method.text);
    draw_turned(strip, sketch, (Point){low.x - 0.55 * line_height(points), middle}, settings.text);
}

static void draw_texts(const Strip *strip, Sketch *sketch) {
    const FigureSpec *spec = strip->spec;
    const RunCells *cells = &strip->cells;
    const TextStyle upright = {spec->points, TEXT_CENTER, INK, 0, false};
    for (int row = 0; row < spec->run_count; row++) {
        const Point low = cell_corner(strip, row, 0);
        const RunName name = run_name(spec, spec->runs[row]);
        draw_name(strip, sketch, &name, low);
    }
    for (int column = 0; column < strip->count; column++) {
        const Point low = cell_corner(strip, 0, column);
        sketch_text(sketch, (Point){low.x + cells->width / 2, low.y + cells->height + strip->top / 2}, &upright,
                    "%.2f s", strip->frames[column] * (double)spec->runs[0]->dt);
    }
    run_cells_draw_scale_bar(cells, sketch, (Point){strip->start, strip->foot / 2 - 0.3}, spec->points);
}

static bool draw(Sketch *sketch, const FigureSpec *spec, Error *error) {
    Strip strip = {.spec = spec};
    run_colours(spec, strip.colours);
    bool done = run_check_worlds(spec, error) && check_bodies(spec, error) &&
                run_frames(spec, DEFAULT_MOMENTS, 0, strip.frames, &strip.count, error) && lay_out(&strip, error);
    if (done) sketch_begin(sketch, spec->width, strip_height(&strip));
    for (int row = 0; done && row < spec->run_count; row++)
        for (int column = 0; done && column < strip.count; column++)
            done = draw_cell(&strip, sketch, row, column, error);
    if (done) draw_texts(&strip, sketch);
    run_cells_free(&strip.cells);
    return done;
}

static void caption(FILE *out, const FigureSpec *spec) {
    fputs("The ", out);
    caption_scene(out, spec);
    caption_times(out, spec);
    fputs(spec->run_count > 1 ? ", a column each. Rows from top to bottom: " : ", by ", out);
    caption_runs(out, spec, 0);
    fputs(".", out);
}

const FigureKind figure_strip = {
    .name = "strip",
    .summary = "moments of runs: a row per run, a column per moment",
    .example = "strip engine.npz momentum.npz --at 0.5,0.6,0.8 -o strip.pdf",
    .min_runs = 1,
    .max_runs = FIGURE_RUNS_MAX,
    .takes_times = true,
    .takes_view = true,
    .takes_moments = true,
    .takes_height = true,
    .min_bodies = 1,
    .max_bodies = FIGURE_BODIES_MAX,
    .draw = draw,
    .caption = caption,
};
