/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What figures of runs share: moments, windows and rendered cells; texts. */
#include "base/base.h"
#include "base/numbers.h"
#include "engine/engine.h"
#include "figures/figure.h"
#include "figures/figures_internal.h"
#include "figures/labels.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "methods/names.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pixels/png.h"
#include "pixels/type.h"
#include "runs/compare_runs.h"
#include "runs/trajectory.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* ERROR_INPUT for a time that a run does not have. */
static bool check_time(const FigureSpec *spec, double time, int after, Error *error) {
    for (int i = 0; i < spec->run_count; i++) {
        const Trajectory *run = spec->runs[i];
        const double last = (run->frames - 1 - after) * (double)run->dt;
        if (time < 0 || time > last + (double)run->dt / 2)
            return error_input(error, spec->paths[i], "has no moment at %g s%s; its moments are 0 to %g s", time,
                               after > 0 ? " with a step after it" : "", last);
    }
    return true;
}

bool run_frames(const FigureSpec *spec, int moments, int after, int *frames, int *count, Error *error) {
    const double dt = (double)spec->runs[0]->dt;
    double last = HUGE_VAL;
    if (!check_time(spec, 0, after, error)) return false;
    for (int i = 0; i < spec->run_count; i++)
        last = fmin(last, (spec->runs[i]->frames - 1 - after) * (double)spec->runs[i]->dt);
    *count = spec->time_count > 0 ? spec->time_count : spec->moments > 0 ? spec->moments : moments;
    for (int i = 0; i < *count; i++) {
        double time = spec->time_count > 0 ? spec->times[i] : *count > 1 ? last * i / (*count - 1) : last;
        if (!check_time(spec, time, after, error)) return false;
        frames[i] = (int)lrint(time / dt);
    }
    return true;
}

bool run_check_worlds(const FigureSpec *spec, Error *error) {
    char what[256];
    for (int i = 1; i < spec->run_count; i++)
        if (trajectory_different_worlds(spec->runs[0], spec->runs[i], what, sizeof what))
            return error_input(error, spec->paths[i], "cannot be shown beside %s: %s", spec->paths[0], what);
    return true;
}

WorldWindow run_window(const FigureSpec *spec, const int *frames, int count) {
    const double margin_share = 0.04, least_margin = 0.4; /* m */
    const Trajectory *const *runs = spec->view_from != NULL ? &spec->view_from : spec->runs;
    CameraView view = spec->view;
    if (view.width > 0 || camera_view_of(runs[0], &view))
        return (WorldWindow){view.x - view.width / 2, view.y - view.height / 2, view.width, view.height};
    const Extent all = framing_in_frames(runs, spec->view_from != NULL ? 1 : spec->run_count, frames, count);
    if (extent_is_empty(&all)) return (WorldWindow){-1, -1, 2, 2};
    double margin = fmax(margin_share * extent_side(&all), least_margin);
    return (WorldWindow){all.left - margin, all.bottom - margin, all.right - all.left + 2 * margin,
                         all.top - all.bottom + 2 * margin};
}

void run_window_widen(WorldWindow *window, double shape) {
    double more = fmax(shape * window->height - window->width, 0);
    window->left -= more / 2;
    window->width += more;
}

int run_count_outside(const Trajectory *run, int frame, const WorldWindow *window, const int *bodies, int count) {
    int outside = 0;
    for (int i = 0; i < (count > 0 ? count : run->bodies); i++) {
        const int body = count > 0 ? bodies[i] : i;
        if (run->fixed[body] || !trajectory_has(run, frame, body)) continue;
        const Vec2 at = run->position[trajectory_at(run, frame, body)];
        const double x = (double)at.x - window->left, y = (double)at.y - window->bottom;
        outside += !(x >= 0 && x <= window->width && y >= 0 && y <= window->height);
    }
    return outside;
}

bool run_cells_begin(RunCells *cells, const WorldWindow *window, double width, double height, double dpi,
                     Error *error) {
    const double dots = dpi / 25.4, scale = fmin(width / window->width, height / window->height);
    *cells = (RunCells){.window = *window};
    cells->columns = (int)fmax(floor(dots * scale * window->width), 1);
    cells->rows = (int)fmax(floor(dots * scale * window->height), 1);
    cells->width = cells->columns / dots;
    cells->height = cells->rows / dots;
    cells->scale = scale;
    cells->camera = (Camera){dots * scale, -dots * scale * window->left, cells->rows + dots * scale * window->bottom};
    if (!sketch_check_pixels(cells->width, cells->height, dpi, error)) return false;
    cells->still = still_create(cells->columns, cells->rows, error);
    return cells->still != NULL;
}

void run_cells_free(RunCells *cells) {
    still_destroy(cells->still);
    cells->still = NULL;
}

static StillShot shot_of(const RunCells *cells, const Trajectory *run, int frame, const RunColours *colours,
                         StillParts parts) {
    return (StillShot){run, frame, colours->light, parts, cells->camera, cells->labels, cells->label_least};
}

Image *run_cells_render(RunCells *cells, const Trajectory *run, int frame, const RunColours *colours, StillParts parts,
                        Error *error) {
    const StillShot shot = shot_of(cells, run, frame, colours, parts);
    Image *image = image_create(cells->columns, cells->rows, error);
    if (image == NULL || still_draw(cells->still, &shot, image, error)) return image;
    image_destroy(image);
    return NULL;
}

void run_cells_label(const RunCells *cells, Sketch *sketch, const Trajectory *run, int frame, const RunColours *colours,
                     Point low) {
    const StillShot shot = shot_of(cells, run, frame, colours, STILL_ALL);
    const double pixel = cells->width / cells->columns; /* mm */
    StillLabel label;
    for (int body = 0; body < run->bodies; body++)
        if (still_label(cells->still, &shot, body, &label))
            sketch_text(sketch, (Point){low.x + label.at.x * pixel, low.y + (cells->rows - label.at.y) * pixel},
                        &(TextStyle){label.size * pixel / MM_PER_POINT, TEXT_CENTER, label.ink, 0, false}, "%s",
                        label.text);
}

View run_cells_view(const RunCells *cells, Point low) {
    const WorldWindow *window = &cells->window;
    /* The camera's origin is the cell's lower left corner. */
    return (View){low,
                  {low.x + cells->width, low.y + cells->height},
                  {window->left + cells->width / 2 / cells->scale, window->bottom + cells->height / 2 / cells->scale},
                  cells->scale};
}

void run_cells_scale_bar(const RunCells *cells, Sketch *sketch, Flow *flow) {
    const double amount = round_down(cells->window.width / 4);
    const Point left = flow_place(flow, sketch_scale_bar_width(cells->scale, amount, "m", flow->points), 1);
    if (sketch != NULL) sketch_scale_bar(sketch, left, cells->scale, amount, "m", flow->points);
}

void run_cells_frame(const RunCells *cells, Sketch *sketch, Point low) {
    sketch_rectangle(sketch, low, (Point){low.x + cells->width, low.y + cells->height},
                     &(Pen){NO_COLOUR, 1, FRAME, 1.2, NULL});
}

WrappedText wrap_text(double points, double width, const char *format, ...) {
    WrappedText wrapped = {.points = points};
    PRINT_ARGUMENTS(wrapped.text, sizeof wrapped.text, format);
    wrapped.lines = text_wrap(wrapped.text, sizeof wrapped.text, points, width);
    return wrapped;
}

void draw_wrapped(Sketch *sketch, Point left, uint32_t ink, const WrappedText *text) {
    sketch_lines(sketch, left, &(TextStyle){text->points, TEXT_LEFT, ink, 0, false}, text->text);
}

double wrapped_width(const WrappedText *text) {
    double widest = 0;
    for (const char *line = text->text; *line != '\0';) {
        char words[sizeof text->text];
        const size_t length = strcspn(line, "\n");
        snprintf(words, sizeof words, "%.*s", (int)length, line);
        widest = fmax(widest, type_width(words, text->points));
        line += length + (line[length] == '\n');
    }
    return widest;
}

Point flow_place(Flow *flow, double width, int lines) {
    const double line = line_height(flow->points), gap = 2 * flow->points * MM_PER_POINT;
    if (flow->used > 0 && flow->used + gap + width > flow->width) flow->row++, flow->used = 0;
    if (flow->used > 0) flow->used += gap;
    const Point at = {flow->first.x + flow->used, flow->first.y - flow->row * line};
    flow->used = lines > 1 ? flow->width : flow->used + width;
    flow->row += lines - 1;
    return at;
}

void flow_text(Flow *flow, Sketch *sketch, uint32_t ink, const WrappedText *text) {
    const Point at = flow_place(flow, wrapped_width(text), text->lines);
    if (sketch != NULL) draw_wrapped(sketch, at, ink, text);
}

static int index_of(const FigureSpec *spec, const Trajectory *run) {
    int i = 0;
    while (i < spec->run_count - 1 && spec->runs[i] != run) i++;
    assert(spec->runs[i] == run);
    return i;
}

RunName run_name(const FigureSpec *spec, const Trajectory *run) {
    RunName name;
    const char *caption = spec->captions[index_of(spec, run)], *methods[FIGURE_RUNS_MAX];
    for (int i = 0; i < spec->run_count; i++) methods[i] = spec->runs[i]->method;
    if (caption != NULL && caption[0] != '\0')
        snprintf(name.text, sizeof name.text, "%s", caption);
    else
        method_name_among(name.text, sizeof name.text, methods, spec->run_count, index_of(spec, run));
    return name;
}

bool run_colours(const FigureSpec *spec, RunColours *colours, Error *error) {
    const char *methods[FIGURE_RUNS_MAX];
    for (int i = 0; i < spec->run_count; i++) methods[i] = spec->runs[i]->method;
    return colours_assign(methods, spec->run_count, &spec->colours, colours, error);
}
