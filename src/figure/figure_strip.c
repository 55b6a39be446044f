/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Moments of runs: a row per run, a column per moment, all with one camera. */
#include "figure/figure_kinds.h"
#include "figure/run_view.h"
#include "picture/style.h"
#include "sketch/type.h"

#include <math.h>
#include <string.h>

static const double gap = 1.2, edge = 0.2; /* mm: between cells; margin of the page, half a frame line */

enum { DEFAULT_MOMENTS = 5 };

typedef struct Strip {
    const FigureSpec *spec;
    int frames[FIGURE_MOMENTS_MAX], count;
    RunCells cells;
    double left, top, foot; /* mm: space beside, above and below the cells */
    double start;           /* left end of the first cell */
} Strip;

static double strip_height(const Strip *strip) {
    return strip->top + strip->foot + strip->spec->run_count * (strip->cells.height + gap) - gap;
}

static bool lay_out(Strip *strip, Error *error) {
    const FigureSpec *spec = strip->spec;
    const double line = line_height(spec->points);
    strip->left = 1.1 * line, strip->top = 1.15 * line, strip->foot = line + 0.6;
    const double width = (spec->width - edge - strip->left - (strip->count - 1) * gap) / strip->count;
    const double height =
        (FIGURE_HEIGHT_MAX - strip->top - strip->foot - (spec->run_count - 1) * gap) / spec->run_count;
    const double least = 5;
    if (width < least || height < least)
        return error_input(error, "figure",
                           "%d moments of %d runs leave %.1f x %.1f mm per cell at a width of %g mm; at least "
                           "%g mm are needed",
                           strip->count, spec->run_count, fmax(width, 0), fmax(height, 0), spec->width, least);
    const WorldWindow window = run_window(spec, strip->frames, strip->count);
    if (!run_cells_begin(&strip->cells, &window, width, height, spec->dpi, error)) return false;
    if (!sketch_check_pixels(spec->width, strip_height(strip), spec->dpi, error)) return false;
    const double used = strip->left + edge + strip->count * strip->cells.width + (strip->count - 1) * gap;
    strip->start = (spec->width - used) / 2 + strip->left;
    return true;
}

static Point cell_corner(const Strip *strip, int row, int column) {
    const RunCells *cells = &strip->cells;
    return (Point){strip->start + column * (cells->width + gap),
                   strip->foot + (strip->spec->run_count - 1 - row) * (cells->height + gap)};
}

static bool draw_cell(const Strip *strip, Sketch *sketch, int row, int column, Error *error) {
    RunCells cells = strip->cells;
    const FigureSpec *spec = strip->spec;
    const Trajectory *run = spec->runs[row];
    const Point low = cell_corner(strip, row, column), high = {low.x + cells.width, low.y + cells.height};
    const int frame = strip->frames[column], outside = run_count_outside(run, frame, &cells.window);
    if (!run_cells_draw(&cells, sketch, low, run, frame, row, error)) return false;
    sketch_rectangle(sketch, low, high, &(Pen){NO_COLOUR, 1, FRAME, 1.2, NULL});
    if (outside > 0)
        sketch_text(sketch, (Point){high.x - 0.8, high.y - line_height(spec->points) / 2},
                    &(TextStyle){spec->points * 0.85, TEXT_RIGHT, INK_SOFT, 0, true}, "%d out of view", outside);
    return true;
}

static void draw_texts(const Strip *strip, Sketch *sketch) {
    const FigureSpec *spec = strip->spec;
    const RunCells *cells = &strip->cells;
    const TextStyle upright = {spec->points, TEXT_CENTER, INK, 0, false};
    const TextStyle turned = {spec->points, TEXT_CENTER, INK, 90, false};
    for (int row = 0; row < spec->run_count; row++) {
        const Point low = cell_corner(strip, row, 0);
        char name[TRAJECTORY_NAME_SIZE];
        memcpy(name, spec->runs[row]->method, sizeof name);
        text_fit(name, spec->points, cells->height);
        sketch_text(sketch, (Point){low.x - strip->left / 2, low.y + cells->height / 2}, &turned, "%s", name);
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
    bool done = run_check_worlds(spec, error) &&
                run_frames(spec, DEFAULT_MOMENTS, 0, strip.frames, &strip.count, error) && lay_out(&strip, error);
    if (done) sketch_begin(sketch, spec->width, strip_height(&strip));
    for (int row = 0; done && row < spec->run_count; row++)
        for (int column = 0; done && column < strip.count; column++)
            done = draw_cell(&strip, sketch, row, column, error);
    if (done) draw_texts(&strip, sketch);
    run_cells_free(&strip.cells);
    return done;
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
    .draw = draw,
};
