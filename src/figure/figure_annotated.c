/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One moment with what the step from there on found and did: contacts, their normals, their impulses. Poses are those
   that the contacts were found for, not those after the step. */
#include "figure/label_place.h"
#include "figure/run_kinds.h"
#include "figure/run_view.h"
#include "figure/type.h"
#include "render/style.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double gap = 2, edge = 0.2; /* mm: between cells; of the page, for half of a frame's line */
static const double largest_ring = 0.55, least_ring = 0.3, least_arrow = 1; /* mm */
static const double ring_share = 0.06;                                      /* of the shortest side of a body */
static const double normal_rings = 3.1; /* how far a normal reaches on either side */
static const double faded = 0.4;        /* what is left of the bodies' colours, for the marks to stand out */
static const double small_type = 0.85;  /* of numbers */
static const double large_share = 0.3;  /* of the largest impulse: from here on a number is there, come what may */
static const double tallest = 1.3;      /* of a cell's width */

enum { MOST_PANELS = 3, MOST_NUMBERS = 600 };

/* A contact on its way to the page. */
typedef struct ShownContact {
    Point at;
    Vec2 normal, impulse; /* N s, on the body of the higher number */
    double size;          /* of the impulse */
} ShownContact;

typedef struct Annotated {
    const FigureSpec *spec;
    int frame;
    RunCells cells;
    double top, foot, start; /* mm: above and below the cells; where the first begins */
    double arrow_scale;      /* mm a N s */
    double largest;          /* N s */
    double ring;             /* mm, radius of a contact's mark */
} Annotated;

static Vec2 impulse_of(const TrajectoryContact *contact) {
    Vec2 tangent = vec2(contact->normal.y, -contact->normal.x);
    return vec2_add(vec2_scale(contact->normal_impulse, contact->normal),
                    vec2_scale(contact->tangent_impulse, tangent));
}

static double size_of(Vec2 v) { return sqrt((double)v.x * (double)v.x + (double)v.y * (double)v.y); }

static bool is_shown(const TrajectoryContact *contact) {
    Vec2 impulse = impulse_of(contact);
    return isfinite(impulse.x) && isfinite(impulse.y) && isfinite(contact->point.x) && isfinite(contact->point.y);
}

/* The frame that the bomb's first touch of a box came from; without one that of the largest impulse; -1: no contacts. */
static int find_moment(const Trajectory *run) {
    int touch = run_first_touch(run), frame = -1;
    if (touch > 0) return touch - 1;
    double largest = -1;
    for (int step = 1; step < run->frames; step++)
        for (int64_t i = run->contact_start[step]; i < run->contact_start[step + 1]; i++) {
            double size = size_of(impulse_of(&run->contacts[i]));
            if (size > largest) largest = size, frame = step - 1;
        }
    return frame;
}

static bool choose_moment(Annotated *figure, Error *error) {
    const FigureSpec *spec = figure->spec;
    FigureSpec asked = *spec;
    int count, moment = find_moment(spec->runs[0]), contacts = 0;
    if (spec->time_count > 1) return error_input(error, "--at", "this kind shows one moment, not %d", spec->time_count);
    if (moment < 0) return error_input(error, spec->paths[0], "the run has no contacts");
    if (spec->time_count == 0) {
        asked.time_count = 1;
        asked.times[0] = moment * (double)spec->runs[0]->dt;
    }
    int frames[FIGURE_MOMENTS_MAX];
    if (!run_frames(&asked, 1, 1, frames, &count, error)) return false;
    figure->frame = frames[0];
    for (int i = 0; i < spec->run_count; i++) {
        const int64_t *start = spec->runs[i]->contact_start + figure->frame + 1;
        contacts += start[1] > start[0];
        for (int64_t k = start[0]; k < start[1]; k++)
            if (is_shown(&spec->runs[i]->contacts[k]))
                figure->largest = fmax(figure->largest, size_of(impulse_of(&spec->runs[i]->contacts[k])));
    }
    return contacts > 0 ||
           error_input(error, spec->paths[0], "has no contacts in the step from %g s on", asked.times[0]);
}

static double ring_radius(const Trajectory *run, double scale) {
    double side = HUGE_VAL;
    for (int i = 0; i < run->bodies; i++)
        if (!run->fixed[i]) side = fmin(side, fmin((double)run->size[i].x, (double)run->size[i].y));
    return fmin(fmax(ring_share * side * scale, least_ring), largest_ring);
}

static bool lay_out(Annotated *figure, Error *error) {
    const FigureSpec *spec = figure->spec;
    const double line = line_height(spec->points), arrow_share = 0.22, longest_arrow = 14;
    figure->top = 2.2 * line, figure->foot = 2.2 * line;
    const double width = (spec->width - 2 * edge - (spec->run_count - 1) * gap) / spec->run_count;
    const double height = fmin(FIGURE_TALLEST - figure->top - figure->foot, tallest * width);
    WorldWindow window = run_window(spec->runs[0], &figure->frame, 1);
    run_window_widen(&window, width / height);
    if (!run_cells_begin(&figure->cells, &window, width, height, spec->dpi, error)) return false;
    figure->start = (spec->width - spec->run_count * figure->cells.width - (spec->run_count - 1) * gap) / 2;
    figure->ring = ring_radius(spec->runs[0], figure->cells.scale);
    if (figure->largest > 0)
        figure->arrow_scale = fmin(arrow_share * figure->cells.width, longest_arrow) / figure->largest;
    return true;
}

static int by_size(const void *a, const void *b) {
    const ShownContact *p = a, *q = b;
    if (p->size != q->size) return p->size < q->size ? 1 : -1;
    /* A total order, so that every sort finds the same. */
    if (p->at.y != q->at.y) return p->at.y < q->at.y ? 1 : -1;
    return (p->at.x > q->at.x) - (p->at.x < q->at.x);
}

/* Those inside the cell, the largest impulse first. NULL when memory is short. */
static ShownContact *gather(const Trajectory *run, int step, const View *view, int *count) {
    int64_t first = run->contact_start[step], end = run->contact_start[step + 1];
    ShownContact *shown = malloc((size_t)(end - first + 1) * sizeof *shown);
    *count = 0;
    for (int64_t i = first; shown != NULL && i < end; i++) {
        const TrajectoryContact *contact = &run->contacts[i];
        Point at = view_place(view, contact->point);
        if (!is_shown(contact) || at.x < view->low.x || at.x > view->high.x || at.y < view->low.y ||
            at.y > view->high.y)
            continue;
        Vec2 impulse = impulse_of(contact);
        shown[(*count)++] = (ShownContact){at, contact->normal, impulse, size_of(impulse)};
    }
    if (shown != NULL) qsort(shown, (size_t)*count, sizeof *shown, by_size);
    return shown;
}

static Point arrow_tip(const Annotated *figure, const ShownContact *contact) {
    return (Point){contact->at.x + figure->arrow_scale * (double)contact->impulse.x,
                   contact->at.y + figure->arrow_scale * (double)contact->impulse.y};
}

static void put_contact(const Annotated *figure, Sketch *sketch, const ShownContact *contact, LabelField *field) {
    const Pen circle = {0xFFFFFF, 1, ACCENT, 1.4, NULL}, thin = pen_line(INK_SOFT, 1.3, NULL);
    const Point at = contact->at, tip = arrow_tip(figure, contact);
    const double ring = figure->ring, x = normal_rings * ring * (double)contact->normal.x,
                 y = normal_rings * ring * (double)contact->normal.y;
    sketch_line(sketch, (Point){at.x - x, at.y - y}, (Point){at.x + x, at.y + y}, &thin);
    sketch_dot(sketch, at, ring, &circle);
    label_add_box(field, (PageBox){at.x - ring, at.y - ring, at.x + ring, at.y + ring});
    label_add_segment(field, (Segment){at.x - x, at.y - y, at.x + x, at.y + y});
    if (contact->size * figure->arrow_scale < least_arrow) return;
    sketch_arrow(sketch, at, tip, HEAD_AT_END, ACCENT, 2.4);
    label_add_segment(field, (Segment){at.x, at.y, tip.x, tip.y});
}

/* Three digits; nothing is just 0. */
static void write_number(char text[32], double value) {
    if (value < 0.005) {
        snprintf(text, 32, "0");
        return;
    }
    int decimals = value >= 99.95 ? 0 : value >= 9.995 ? 1 : 2;
    snprintf(text, 32, "%.*f", decimals, value);
}

/* Beside the tip or the point, whichever has room; returns whether one has. */
static bool put_number(const Annotated *figure, Sketch *sketch, const ShownContact *contact, LabelField *field) {
    const double points = small_type * figure->spec->points;
    const Point tip = arrow_tip(figure, contact), places[] = {tip, contact->at};
    char text[32];
    const bool must = contact->size >= large_share * figure->largest;
    PageBox box;
    write_number(text, contact->size);
    const double em = points * MM_PER_POINT, width = type_width(text, points) + 0.25 * em, height = em;
    for (int i = 0; i < 2; i++) {
        double away = i == 0 && contact->size * figure->arrow_scale >= least_arrow ? 0.7 : figure->ring + 0.5;
        if (!label_place(field, places[i].x, places[i].y, away, width, height, must, &box)) continue;
        sketch_text(sketch, (Point){(box.left + box.right) / 2, (box.bottom + box.top) / 2},
                    &(TextStyle){points, TEXT_CENTER, ACCENT, 0, true}, "%s", text);
        return true;
    }
    return false;
}

static void put_title(const Annotated *figure, Sketch *sketch, int panel, Point low, int count, int numbered) {
    const FigureSpec *spec = figure->spec;
    const Trajectory *run = spec->runs[panel];
    const double line = line_height(spec->points), top = low.y + figure->cells.height;
    char title[TRAJECTORY_NAME_SIZE + 32], counts[96], part[48] = "";
    snprintf(title, sizeof title, "%s, %.3f s", run->method, figure->frame * (double)run->dt);
    words_fit(title, spec->points, figure->cells.width);
    sketch_text(sketch, (Point){low.x, top + 1.6 * line}, &(TextStyle){spec->points, TEXT_LEFT, INK, 0, false}, "%s",
                title);
    if (numbered < count) snprintf(part, sizeof part, ", %d of them written", numbered);
    snprintf(counts, sizeof counts, "%d %s, impulses in N s%s", count, count == 1 ? "contact" : "contacts", part);
    words_fit(counts, small_type * spec->points, figure->cells.width);
    sketch_text(sketch, (Point){low.x, top + 0.6 * line},
                &(TextStyle){small_type * spec->points, TEXT_LEFT, INK_SOFT, 0, false}, "%s", counts);
}

static bool put_scene(Annotated *figure, Sketch *sketch, int panel, Point low, Error *error) {
    Image *image = run_cells_shoot(&figure->cells, figure->spec->runs[panel], figure->frame, panel, STILL_ALL, error);
    if (image == NULL) return false;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        image->pixels[4 * i + 3] = (uint8_t)lrint(faded * image->pixels[4 * i + 3]);
    sketch_image(sketch, image, low, figure->cells.width);
    image_destroy(image);
    sketch_rectangle(sketch, low, (Point){low.x + figure->cells.width, low.y + figure->cells.height},
                     &(Pen){NO_COLOUR, 1, FRAME, 1.2, NULL});
    return true;
}

static bool put_panel(Annotated *figure, Sketch *sketch, int panel, Error *error) {
    const Point low = {figure->start + panel * (figure->cells.width + gap), figure->foot};
    const View view = run_cells_view(&figure->cells, low);
    int count, numbered = 0;
    if (!put_scene(figure, sketch, panel, low, error)) return false;
    ShownContact *contacts = gather(figure->spec->runs[panel], figure->frame + 1, &view, &count);
    LabelField *field = calloc(1, sizeof *field);
    bool done = (contacts != NULL && field != NULL) || error_memory(error, "figure");
    if (done) {
        field->frame = (PageBox){view.low.x + 0.3, view.low.y + 0.3, view.high.x - 0.3, view.high.y - 0.3};
        for (int i = count - 1; i >= 0; i--) put_contact(figure, sketch, &contacts[i], field);
        for (int i = 0; i < count && i < MOST_NUMBERS; i++) numbered += put_number(figure, sketch, &contacts[i], field);
        put_title(figure, sketch, panel, low, count, numbered);
    }
    free(contacts);
    free(field);
    return done;
}

/* What the marks mean, in one line that goes on in a second where it is too long. */
static void put_legend(const Annotated *figure, Sketch *sketch) {
    const FigureSpec *spec = figure->spec;
    const double line = line_height(spec->points), points = small_type * spec->points;
    const TextStyle words = {points, TEXT_LEFT, INK, 0, false};
    const double ring = figure->ring, normal_reach = normal_rings * ring;
    double x = figure->start + figure->cells.width * 0.25 + 12, y = figure->foot - 0.7 * line;
    run_cells_bar(&figure->cells, sketch, (Point){figure->start, y}, points);
    sketch_line(sketch, (Point){x - normal_reach, y}, (Point){x + normal_reach, y},
                &(Pen){NO_COLOUR, 1, INK_SOFT, 1.3, NULL});
    sketch_dot(sketch, (Point){x, y}, ring, &(Pen){0xFFFFFF, 1, ACCENT, 1.4, NULL});
    sketch_text(sketch, (Point){x + normal_reach + 1, y}, &words, "contact, normal");
    x = figure->start, y -= line;
    if (figure->largest > 0) {
        double shown = round_down(figure->largest), length = shown * figure->arrow_scale;
        sketch_arrow(sketch, (Point){x, y}, (Point){x + length, y}, HEAD_AT_END, ACCENT, 2.4);
        x += length + 1.2;
        sketch_text(sketch, (Point){x, y}, &words, "%g N s on the body with the higher number", shown);
    } else
        sketch_text(sketch, (Point){x, y}, &words, "all impulses are 0");
}

static bool draw(Sketch *sketch, const FigureSpec *spec, Error *error) {
    Annotated figure = {.spec = spec};
    bool done = run_check_worlds(spec, error) && choose_moment(&figure, error) && lay_out(&figure, error);
    if (done) sketch_begin(sketch, spec->width, figure.top + figure.foot + figure.cells.height);
    for (int i = 0; done && i < spec->run_count; i++) done = put_panel(&figure, sketch, i, error);
    if (done) put_legend(&figure, sketch);
    run_cells_free(&figure.cells);
    return done;
}

const FigureKind figure_annotated = {
    .name = "annotated",
    .summary = "one moment with contacts, normals and impulses",
    .example = "annotated engine.npz --at 0.55 -o contacts.pdf",
    .least_runs = 1,
    .most_runs = MOST_PANELS,
    .takes_times = true,
    .draw = draw,
};
