/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figures of moments of runs: strobe, strip, annotated. */
#include "base/base.h"
#include "engine/engine.h"
#include "figures/figure.h"
#include "figures/internal.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pixels/png.h"
#include "pixels/type.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Many moments of one run in one picture: the last is opaque, earlier ones are paler. */

enum { STROBE_MOMENTS = 9 }; /* by default */

static const double palest = 0.12, before_last = 0.5; /* opacity of the first moment, and of the one before the last */

typedef struct Strobe {
    const FigureSpec *spec;
    const Trajectory *run;
    MethodColour colour;
    int frames[FIGURE_MOMENTS_MAX], count;
    RunCells cells;
    Point low;
} Strobe;

static double opacity_of(const Strobe *strobe, int moment) {
    if (moment == strobe->count - 1) return 1;
    return strobe->count > 2 ? palest + (before_last - palest) * moment / (strobe->count - 2) : palest;
}

static void blend_over(Image *image, const Image *upper, double opacity) {
    for (size_t i = 0; i < 4 * (size_t)image->width * (size_t)image->height; i += 4) {
        int alpha = (int)lrint(opacity * upper->pixels[i + 3]);
        if (alpha > 0) pixel_over(image->pixels + i, upper->pixels + i, alpha);
    }
}

static bool draw_moments(Strobe *strobe, Sketch *sketch, Error *error) {
    Image *image = run_cells_render(&strobe->cells, strobe->run, strobe->frames[0], strobe->colour, STILL_FIXED, error);
    bool done = image != NULL;
    for (int i = 0; done && i < strobe->count; i++) {
        Image *moment =
            run_cells_render(&strobe->cells, strobe->run, strobe->frames[i], strobe->colour, STILL_MOVING, error);
        done = moment != NULL;
        if (done) blend_over(image, moment, opacity_of(strobe, i));
        image_destroy(moment);
    }
    if (done) sketch_image(sketch, image, strobe->low, strobe->cells.width);
    image_destroy(image);
    return done;
}

/* The bomb's centre on the page. False if it does not exist yet or is outside the picture. */
static bool find_bomb(const Strobe *strobe, const View *view, int frame, Point *at) {
    const Trajectory *run = strobe->run;
    if (!trajectory_has(run, frame, run->bomb)) return false;
    *at = view_place(view, run->position[(size_t)frame * (size_t)run->bodies + (size_t)run->bomb]);
    return at->x > view->low.x && at->x < view->high.x && at->y > view->low.y && at->y < view->high.y;
}

static void draw_bomb_path(const Strobe *strobe, Sketch *sketch, const View *view, LabelField *field) {
    const Pen pen = pen_line(BOMB.line, 1.4, NULL);
    Point p, q;
    for (int frame = strobe->frames[0]; frame < strobe->frames[strobe->count - 1]; frame++) {
        if (!find_bomb(strobe, view, frame, &p) || !find_bomb(strobe, view, frame + 1, &q)) continue;
        sketch_line(sketch, p, q, &pen);
        label_add_segment(field, (Segment){p.x, p.y, q.x, q.y});
    }
}

/* The times at the bomb's positions, where there is room. */
static void draw_times(const Strobe *strobe, Sketch *sketch, const View *view, LabelField *field) {
    const Trajectory *run = strobe->run;
    const double points = SMALL_TYPE * strobe->spec->points, height = points * MM_PER_POINT;
    const double half = 0.5 * (double)run->size[run->bomb].x * view->scale;
    Point at;
    for (int i = 0; i < strobe->count; i++)
        if (find_bomb(strobe, view, strobe->frames[i], &at))
            label_add_box(field, (PageBox){at.x - half, at.y - half, at.x + half, at.y + half});
    for (int i = strobe->count - 1; i >= 0; i--) {
        char text[32];
        PageBox box;
        if (!find_bomb(strobe, view, strobe->frames[i], &at)) continue;
        snprintf(text, sizeof text, "%.2f s", strobe->frames[i] * (double)run->dt);
        if (!label_place(field, at.x, at.y, 1.1 * half + 0.5, type_width(text, points) + 0.5, height, false, &box))
            continue;
        sketch_text(sketch, (Point){(box.left + box.right) / 2, (box.bottom + box.top) / 2},
                    &(TextStyle){points, TEXT_CENTER, BOMB.line, 0, true}, "%s", text);
    }
}

static bool draw_bomb(const Strobe *strobe, Sketch *sketch, Error *error) {
    if (strobe->run->bomb < 0) return true;
    const View view = run_cells_view(&strobe->cells, strobe->low);
    LabelField *field = calloc(1, sizeof *field);
    if (field == NULL) return error_memory(error, "figure");
    field->frame = (PageBox){view.low.x + 0.3, view.low.y + 0.3, view.high.x - 0.3, view.high.y - 0.3};
    draw_bomb_path(strobe, sketch, &view, field);
    draw_times(strobe, sketch, &view, field);
    free(field);
    return true;
}

static void strobe_draw_texts(const Strobe *strobe, Sketch *sketch) {
    const FigureSpec *spec = strobe->spec;
    const RunCells *cells = &strobe->cells;
    const double line = line_height(spec->points), y = strobe->low.y / 2 - 0.2;
    const double dt = (double)strobe->run->dt;
    const double first = strobe->frames[0] * dt, last = strobe->frames[strobe->count - 1] * dt;
    const Point top = {strobe->low.x, strobe->low.y + cells->height + 0.6 * line};
    const RunName name = run_name(spec, strobe->run);
    if (strobe->count > 1)
        draw_fitted(sketch, top, spec->points, INK, cells->width, "%s, %d moments from %.2f to %.2f s", name.text,
                    strobe->count, first, last);
    else
        draw_fitted(sketch, top, spec->points, INK, cells->width, "%s, %.2f s", name.text, last);
    run_cells_draw_scale_bar(cells, sketch, (Point){strobe->low.x, y}, spec->points);
    int outside = run_count_outside(strobe->run, strobe->frames[strobe->count - 1], &cells->window);
    if (outside > 0)
        sketch_text(sketch, (Point){strobe->low.x + cells->width, y},
                    &(TextStyle){spec->points, TEXT_RIGHT, INK_SOFT, 0, false}, "%d out of view at the end", outside);
}

static bool strobe_draw(Sketch *sketch, const FigureSpec *spec, Error *error) {
    Strobe strobe = {.spec = spec, .run = spec->runs[0]};
    const double max_height = 120, max_aspect = 1.2; /* mm; height / width */
    const double line = line_height(spec->points), width = spec->width - 2 * PAGE_EDGE;
    const double height = fmin(max_height, max_aspect * width);
    run_colours(spec, &strobe.colour);
    if (!run_frames(spec, STROBE_MOMENTS, 0, strobe.frames, &strobe.count, error)) return false;
    WorldWindow window = run_window(strobe.spec, strobe.frames, strobe.count);
    run_window_widen(&window, width / height);
    bool done = run_cells_begin(&strobe.cells, &window, width, height, spec->dpi, error);
    if (done) {
        strobe.low = (Point){(spec->width - strobe.cells.width) / 2, 1.2 * line};
        sketch_begin(sketch, spec->width, strobe.cells.height + 2.4 * line);
        done = draw_moments(&strobe, sketch, error) && draw_bomb(&strobe, sketch, error);
    }
    if (done) {
        run_cells_frame(&strobe.cells, sketch, strobe.low);
        strobe_draw_texts(&strobe, sketch);
    }
    run_cells_free(&strobe.cells);
    return done;
}

static void strobe_caption(FILE *out, const FigureSpec *spec) {
    fputs("One run of the ", out);
    caption_scene(out, spec);
    caption_times(out, spec);
    fputs(" in one picture; earlier moments are paler. Method: ", out);
    caption_run(out, spec, spec->runs[0]);
    fputs(".", out);
}

const FigureKind figure_strobe = {
    .name = "strobe",
    .summary = "many moments of a run in one picture, fading",
    .example = "strobe engine.npz --at 0.3,0.4,0.5,0.6 -o strobe.png",
    .min_runs = 1,
    .max_runs = 1,
    .takes_times = true,
    .takes_view = true,
    .takes_moments = true,
    .draw = strobe_draw,
    .caption = strobe_caption,
};

/* Moments of runs: a row per run, a column per moment, all with one camera. */

static const double strip_gap = 1.2; /* mm: between cells */

enum { STRIP_MOMENTS = 5 }; /* by default */

typedef struct Strip {
    const FigureSpec *spec;
    int frames[FIGURE_MOMENTS_MAX], count;
    RunCells cells;
    MethodColour colours[FIGURE_RUNS_MAX];
    double left, top, foot; /* mm: space beside, above and below the cells */
    double start;           /* left end of the first cell */
} Strip;

static double strip_height(const Strip *strip) {
    return strip->top + strip->foot + strip->spec->run_count * (strip->cells.height + strip_gap) - strip_gap;
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
    const double width = (spec->width - PAGE_EDGE - strip->left - (strip->count - 1) * strip_gap) / strip->count;
    const double height = ((spec->height > 0 ? spec->height : FIGURE_HEIGHT_MAX) - strip->top - strip->foot -
                           (spec->run_count - 1) * strip_gap) /
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
    const double used = strip->left + PAGE_EDGE + strip->count * strip->cells.width + (strip->count - 1) * strip_gap;
    strip->start = (spec->width - used) / 2 + strip->left;
    return true;
}

static bool names_fit(const Strip *strip) {
    for (int i = 0; i < strip->spec->run_count; i++)
        if (type_width(run_name(strip->spec, strip->spec->runs[i]).text, strip->spec->points) > strip->cells.height)
            return false;
    return true;
}

static bool strip_lay_out(Strip *strip, Error *error) {
    if (!lay_out_beside(strip, 1, error)) return false;
    if (names_fit(strip)) return true;
    run_cells_free(&strip->cells);
    return lay_out_beside(strip, 2, error);
}

static Point cell_corner(const Strip *strip, int row, int column) {
    const RunCells *cells = &strip->cells;
    return (Point){strip->start + column * (cells->width + strip_gap),
                   strip->foot + (strip->spec->run_count - 1 - row) * (cells->height + strip_gap)};
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
    const double points = SMALL_TYPE * strip->spec->points, margin = 0.8;
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
    const Point low = cell_corner(strip, row, column);
    const int frame = strip->frames[column], outside = count_outside(strip, run, frame);
    if (!run_cells_draw(&cells, sketch, low, run, frame, strip->colours[row], error)) return false;
    run_cells_frame(&cells, sketch, low);
    if (outside > 0) draw_outside(strip, sketch, (Point){low.x + cells.width, low.y + cells.height}, outside);
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

static void strip_draw_texts(const Strip *strip, Sketch *sketch) {
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

static bool strip_draw(Sketch *sketch, const FigureSpec *spec, Error *error) {
    Strip strip = {.spec = spec};
    run_colours(spec, strip.colours);
    bool done = run_check_worlds(spec, error) && check_bodies(spec, error) &&
                run_frames(spec, STRIP_MOMENTS, 0, strip.frames, &strip.count, error) && strip_lay_out(&strip, error);
    if (done) sketch_begin(sketch, spec->width, strip_height(&strip));
    for (int row = 0; done && row < spec->run_count; row++)
        for (int column = 0; done && column < strip.count; column++)
            done = draw_cell(&strip, sketch, row, column, error);
    if (done) strip_draw_texts(&strip, sketch);
    run_cells_free(&strip.cells);
    return done;
}

static void strip_caption(FILE *out, const FigureSpec *spec) {
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
    .draw = strip_draw,
    .caption = strip_caption,
};

/* One moment with the contacts, normals and impulses of the step that starts there. The poses are those before the
   step, for which the contacts were found. */

static const double annotated_gap = 2;               /* mm: between cells */
static const double max_ring = 0.55, min_ring = 0.3; /* mm */
static const double ring_share = 0.06;               /* / the shortest side of a body */
static const double body_opacity = 0.4;              /* opacity of the bodies, so that the marks stand out */
static const double annotated_aspect = 1.3;          /* height / width of a cell, at most */

enum { MAX_PANELS = 3 };

typedef struct Annotated {
    const FigureSpec *spec;
    int frame;
    MethodColour colours[FIGURE_RUNS_MAX];
    RunCells cells;
    double top, foot, start; /* mm: above and below the cells; left end of the first cell */
    ContactLook look;
} Annotated;

/* The frame before the step in which the bomb first touches a box; otherwise the frame before the largest impulse;
   -1 without contacts. */
static int find_moment(const Trajectory *run) {
    int touch = trajectory_impact(run), frame = -1;
    if (touch > 0) return touch - 1;
    double largest = -1;
    for (int step = 1; step < run->frames; step++)
        for (int64_t i = run->contact_start[step]; i < run->contact_start[step + 1]; i++) {
            double size = impulse_magnitude(&run->contacts[i]);
            if (size > largest) largest = size, frame = step - 1;
        }
    return frame;
}

static bool choose_moment(Annotated *figure, Error *error) {
    const FigureSpec *spec = figure->spec;
    FigureSpec requested = *spec;
    int count, moment = find_moment(spec->runs[0]), contacts = 0;
    if (spec->time_count > 1)
        return error_input(error, "--at", "this kind of figure shows one moment (got %d)", spec->time_count);
    if (moment < 0) return error_input(error, spec->paths[0], "the run has no contacts with an impulse");
    if (spec->time_count == 0) {
        requested.time_count = 1;
        requested.times[0] = moment * (double)spec->runs[0]->dt;
    }
    int frames[FIGURE_MOMENTS_MAX];
    if (!run_frames(&requested, 1, 1, frames, &count, error)) return false;
    figure->frame = frames[0];
    for (int i = 0; i < spec->run_count; i++) {
        const int64_t *start = spec->runs[i]->contact_start + figure->frame + 1;
        for (int64_t k = start[0]; k < start[1]; k++) {
            if (!contact_is_finite(&spec->runs[i]->contacts[k])) continue;
            contacts++;
            figure->look.largest = fmax(figure->look.largest, impulse_magnitude(&spec->runs[i]->contacts[k]));
        }
    }
    return contacts > 0 || error_input(error, spec->paths[0], "has no contacts with an impulse in the step after %g s",
                                       requested.times[0]);
}

static double ring_radius(const Trajectory *run, double scale) {
    double side = HUGE_VAL;
    for (int i = 0; i < run->bodies; i++)
        if (!run->fixed[i]) side = fmin(side, fmin((double)run->size[i].x, (double)run->size[i].y));
    return fmin(fmax(ring_share * side * scale, min_ring), max_ring);
}

static bool annotated_lay_out(Annotated *figure, Error *error) {
    const FigureSpec *spec = figure->spec;
    const double line = line_height(spec->points), arrow_share = 0.22, max_arrow = 14;
    figure->top = 2.2 * line, figure->foot = 2.2 * line;
    const double width = (spec->width - 2 * PAGE_EDGE - (spec->run_count - 1) * annotated_gap) / spec->run_count;
    const double height = fmin(FIGURE_HEIGHT_MAX - figure->top - figure->foot, annotated_aspect * width);
    WorldWindow window = run_window(spec, &figure->frame, 1);
    run_window_widen(&window, width / height);
    if (!run_cells_begin(&figure->cells, &window, width, height, spec->dpi, error)) return false;
    figure->start = (spec->width - spec->run_count * figure->cells.width - (spec->run_count - 1) * annotated_gap) / 2;
    figure->look.points = spec->points;
    figure->look.ring = ring_radius(spec->runs[0], figure->cells.scale);
    if (figure->look.largest > 0)
        figure->look.arrow_scale = fmin(arrow_share * figure->cells.width, max_arrow) / figure->look.largest;
    return true;
}

static void draw_title(const Annotated *figure, Sketch *sketch, int panel, Point low, int count, int numbered) {
    const FigureSpec *spec = figure->spec;
    const Trajectory *run = spec->runs[panel];
    const double line = line_height(spec->points), top = low.y + figure->cells.height;
    char part[48] = "";
    draw_fitted(sketch, (Point){low.x, top + 1.6 * line}, spec->points, INK, figure->cells.width, "%s, %.3f s",
                run_name(spec, run).text, figure->frame * (double)run->dt);
    snprintf(part, sizeof part, run->no_impulses ? " found again" : ", impulses in N s");
    if (numbered < count && !run->no_impulses) text_add(part, sizeof part, ", %d labelled", numbered);
    draw_fitted(sketch, (Point){low.x, top + 0.6 * line}, SMALL_TYPE * spec->points, INK_SOFT, figure->cells.width,
                "%d %s%s", count, count == 1 ? "contact" : "contacts", part);
}

static bool draw_scene(Annotated *figure, Sketch *sketch, int panel, Point low, Error *error) {
    Image *image = run_cells_render(&figure->cells, figure->spec->runs[panel], figure->frame, figure->colours[panel],
                                    STILL_ALL, error);
    if (image == NULL) return false;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        image->pixels[4 * i + 3] = (uint8_t)lrint(body_opacity * image->pixels[4 * i + 3]);
    sketch_image(sketch, image, low, figure->cells.width);
    image_destroy(image);
    run_cells_frame(&figure->cells, sketch, low);
    return true;
}

static bool draw_panel(Annotated *figure, Sketch *sketch, int panel, Error *error) {
    const Point low = {figure->start + panel * (figure->cells.width + annotated_gap), figure->foot};
    const View view = run_cells_view(&figure->cells, low);
    int count, numbered;
    if (!draw_scene(figure, sketch, panel, low, error) ||
        !draw_contacts(sketch, &view, &figure->look, figure->spec->runs[panel], figure->frame + 1, &count, &numbered,
                       error))
        return false;
    draw_title(figure, sketch, panel, low, count, numbered);
    return true;
}

/* Two lines that explain the marks. */
static void draw_legend(const Annotated *figure, Sketch *sketch) {
    const FigureSpec *spec = figure->spec;
    const double line = line_height(spec->points), points = SMALL_TYPE * spec->points;
    const TextStyle words = {points, TEXT_LEFT, INK, 0, false};
    double x = figure->start + figure->cells.width * 0.25 + 12, y = figure->foot - 0.7 * line;
    run_cells_draw_scale_bar(&figure->cells, sketch, (Point){figure->start, y}, points);
    draw_contact_sample(sketch, (Point){x, y}, &figure->look);
    x = figure->start, y -= line;
    if (figure->look.largest > 0) {
        double shown = round_down(figure->look.largest), length = shown * figure->look.arrow_scale;
        sketch_arrow(sketch, (Point){x, y}, (Point){x + length, y}, HEAD_AT_END, ACCENT, 2.4);
        x += length + 1.2;
        sketch_text(sketch, (Point){x, y}, &words, "%g N s on the body with the higher number", shown);
    } else
        sketch_text(sketch, (Point){x, y}, &words,
                    spec->runs[0]->no_impulses ? "impulses are unknown" : "all impulses are 0");
}

static bool annotated_draw(Sketch *sketch, const FigureSpec *spec, Error *error) {
    Annotated figure = {.spec = spec};
    run_colours(spec, figure.colours);
    bool done = run_check_worlds(spec, error) && choose_moment(&figure, error) && annotated_lay_out(&figure, error);
    if (done) sketch_begin(sketch, spec->width, figure.top + figure.foot + figure.cells.height);
    for (int i = 0; done && i < spec->run_count; i++) done = draw_panel(&figure, sketch, i, error);
    if (done) draw_legend(&figure, sketch);
    run_cells_free(&figure.cells);
    return done;
}

static void annotated_caption(FILE *out, const FigureSpec *spec) {
    fputs("Contacts of the ", out);
    caption_scene(out, spec);
    caption_times(out, spec);
    fputs(": contact points, normals and impulses of the next step. ", out);
    fputs(spec->run_count > 1 ? "From left to right: " : "Method: ", out);
    caption_runs(out, spec, 0);
    fputs(".", out);
    for (int i = 0, said = 0; i < spec->run_count && !said; i++)
        if (spec->runs[i]->no_impulses)
            said = fputs(" Found again: contacts between the poses, of unknown impulses.", out) >= 0;
}

const FigureKind figure_annotated = {
    .name = "annotated",
    .summary = "one moment with contacts, normals and impulses",
    .example = "annotated engine.npz --at 0.55 -o contacts.pdf",
    .min_runs = 1,
    .max_runs = MAX_PANELS,
    .takes_times = true,
    .takes_view = true,
    .needs_contacts = true,
    .draw = annotated_draw,
    .caption = annotated_caption,
};
