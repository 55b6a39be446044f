/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One moment with the contacts, normals and impulses of the step that starts there. The poses are those before the
   step, for which the contacts were found. */
#include "figure/contact_marks.h"
#include "figure/caption.h"
#include "figure/figure_kinds.h"
#include "figure/run_view.h"
#include "picture/style.h"

#include <math.h>
#include <string.h>

static const double gap = 2, edge = 0.2;             /* mm: between cells; margin of the page, half a frame line */
static const double max_ring = 0.55, min_ring = 0.3; /* mm */
static const double ring_share = 0.06;               /* / the shortest side of a body */
static const double body_opacity = 0.4;              /* opacity of the bodies, so that the marks stand out */
static const double max_aspect = 1.3;                /* height / width of a cell, at most */

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

static bool lay_out(Annotated *figure, Error *error) {
    const FigureSpec *spec = figure->spec;
    const double line = line_height(spec->points), arrow_share = 0.22, max_arrow = 14;
    figure->top = 2.2 * line, figure->foot = 2.2 * line;
    const double width = (spec->width - 2 * edge - (spec->run_count - 1) * gap) / spec->run_count;
    const double height = fmin(FIGURE_HEIGHT_MAX - figure->top - figure->foot, max_aspect * width);
    WorldWindow window = run_window(spec, &figure->frame, 1);
    run_window_widen(&window, width / height);
    if (!run_cells_begin(&figure->cells, &window, width, height, spec->dpi, error)) return false;
    figure->start = (spec->width - spec->run_count * figure->cells.width - (spec->run_count - 1) * gap) / 2;
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
    char title[CAPTION_SIZE + 32], counts[96], part[48] = "";
    snprintf(title, sizeof title, "%s, %.3f s", run_name(spec, run).text, figure->frame * (double)run->dt);
    text_fit(title, sizeof title, spec->points, figure->cells.width);
    sketch_text(sketch, (Point){low.x, top + 1.6 * line}, &(TextStyle){spec->points, TEXT_LEFT, INK, 0, false}, "%s",
                title);
    if (numbered < count) snprintf(part, sizeof part, ", %d labelled", numbered);
    snprintf(counts, sizeof counts, "%d %s, impulses in N s%s", count, count == 1 ? "contact" : "contacts", part);
    text_fit(counts, sizeof counts, CONTACT_TYPE * spec->points, figure->cells.width);
    sketch_text(sketch, (Point){low.x, top + 0.6 * line},
                &(TextStyle){CONTACT_TYPE * spec->points, TEXT_LEFT, INK_SOFT, 0, false}, "%s", counts);
}

static bool draw_scene(Annotated *figure, Sketch *sketch, int panel, Point low, Error *error) {
    Image *image = run_cells_render(&figure->cells, figure->spec->runs[panel], figure->frame, figure->colours[panel],
                                    STILL_ALL, error);
    if (image == NULL) return false;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        image->pixels[4 * i + 3] = (uint8_t)lrint(body_opacity * image->pixels[4 * i + 3]);
    sketch_image(sketch, image, low, figure->cells.width);
    image_destroy(image);
    sketch_rectangle(sketch, low, (Point){low.x + figure->cells.width, low.y + figure->cells.height},
                     &(Pen){NO_COLOUR, 1, FRAME, 1.2, NULL});
    return true;
}

static bool draw_panel(Annotated *figure, Sketch *sketch, int panel, Error *error) {
    const Point low = {figure->start + panel * (figure->cells.width + gap), figure->foot};
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
    const double line = line_height(spec->points), points = CONTACT_TYPE * spec->points;
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
        sketch_text(sketch, (Point){x, y}, &words, "all impulses are 0");
}

static bool draw(Sketch *sketch, const FigureSpec *spec, Error *error) {
    Annotated figure = {.spec = spec};
    run_colours(spec, figure.colours);
    bool done = run_check_worlds(spec, error) && choose_moment(&figure, error) && lay_out(&figure, error);
    if (done) sketch_begin(sketch, spec->width, figure.top + figure.foot + figure.cells.height);
    for (int i = 0; done && i < spec->run_count; i++) done = draw_panel(&figure, sketch, i, error);
    if (done) draw_legend(&figure, sketch);
    run_cells_free(&figure.cells);
    return done;
}

static void caption(FILE *out, const FigureSpec *spec) {
    fputs("Contacts of the ", out);
    caption_scene(out, spec);
    caption_times(out, spec);
    fputs(": contact points, normals and impulses of the next step. ", out);
    fputs(spec->run_count > 1 ? "From left to right: " : "Method: ", out);
    caption_runs(out, spec, 0);
    fputs(".", out);
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
    .draw = draw,
    .caption = caption,
};
