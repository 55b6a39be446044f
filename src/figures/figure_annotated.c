/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figure of one moment with the contacts, normals and impulses of the step that starts there. The poses are those
   before the step, for which the contacts were found. */
#include "base/base.h"
#include "base/numbers.h"
#include "engine/engine.h"
#include "figures/figure.h"
#include "figures/figures_internal.h"
#include "figures/labels.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pixels/png.h"
#include "pixels/type.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdlib.h>

#define NORMAL_RINGS 3.1 /* length of a normal on either side / radius of the point's mark */

static const double min_arrow = 1;     /* mm */
static const double long_arrow = 3;    /* mm; the number is at its tip, else at its point */
static const double crowd = 5;         /* mm; numbers of points nearer than this to each other stand apart from them */
static const double large_share = 0.3; /* impulses above this share of the largest get a number even far away */

enum { MAX_NUMBERS = 600 };

/* How contacts are drawn. */
typedef struct ContactLook {
    double ring;        /* mm, radius of a point's mark */
    double arrow_scale; /* mm per N s */
    double largest;     /* N s, largest impulse of all panels */
    double points;      /* font size */
} ContactLook;

/* A contact in page coordinates. */
typedef struct ShownContact {
    Point at;
    Vec2 normal, impulse; /* N s, on the body with the higher number */
    double size;          /* magnitude of the impulse */
} ShownContact;

static Vec2 impulse_of(const TrajectoryContact *contact) {
    Vec2 tangent = vec2(contact->normal.y, -contact->normal.x);
    return vec2_add(vec2_scale(contact->normal_impulse, contact->normal),
                    vec2_scale(contact->tangent_impulse, tangent));
}

static double impulse_magnitude(const TrajectoryContact *contact) {
    return vec2_distance(impulse_of(contact), vec2(0, 0));
}

/* False for NaN or infinity, which a damaged file may contain. */
static bool contact_is_finite(const TrajectoryContact *contact) {
    Vec2 impulse = impulse_of(contact);
    return isfinite(impulse.x) && isfinite(impulse.y) && isfinite(contact->point.x) && isfinite(contact->point.y);
}

static int by_size(const void *a, const void *b) {
    const ShownContact *p = a, *q = b;
    if (p->size != q->size) return p->size < q->size ? 1 : -1;
    /* a total order, so that every qsort gives the same result */
    if (p->at.y != q->at.y) return p->at.y < q->at.y ? 1 : -1;
    return (p->at.x > q->at.x) - (p->at.x < q->at.x);
}

/* The contacts inside the cell, largest impulse first. NULL if out of memory. */
static ShownContact *gather_contacts(const Trajectory *run, int step, const View *view, int *count) {
    int64_t first = run->contact_start[step], end = run->contact_start[step + 1];
    ShownContact *shown = malloc((size_t)(end - first + 1) * sizeof *shown);
    *count = 0;
    for (int64_t i = first; shown != NULL && i < end; i++) {
        const TrajectoryContact *contact = &run->contacts[i];
        Point at = view_place(view, contact->point);
        if (!contact_is_finite(contact) || at.x < view->low.x || at.x > view->high.x || at.y < view->low.y ||
            at.y > view->high.y)
            continue;
        Vec2 impulse = impulse_of(contact);
        shown[(*count)++] = (ShownContact){at, contact->normal, impulse, impulse_magnitude(contact)};
    }
    if (shown != NULL) qsort(shown, (size_t)*count, sizeof *shown, by_size);
    return shown;
}

static Point arrow_tip(const ContactLook *look, const ShownContact *contact) {
    return (Point){contact->at.x + look->arrow_scale * (double)contact->impulse.x,
                   contact->at.y + look->arrow_scale * (double)contact->impulse.y};
}

/* The point and its normal, `normal` long on either side. */
static void draw_contact_point(Sketch *sketch, Point at, Point normal, double ring) {
    const Pen circle = {0xFFFFFF, 1, ACCENT, 1.4, NULL}, thin = pen_line(INK_SOFT, 1.3, NULL);
    sketch_line(sketch, (Point){at.x - normal.x, at.y - normal.y}, (Point){at.x + normal.x, at.y + normal.y}, &thin);
    sketch_dot(sketch, at, ring, &circle);
}

/* Three significant digits, or "0", outside the pile of contacts, whose middle is at `middle`: beside the arrow's tip,
   or beside the point, with a line to it if it is not near. False if there is no room. */
static bool draw_number(const ContactLook *look, Sketch *sketch, const ShownContact *contact, LabelField *field,
                        double middle, bool crowded) {
    const double points = SMALL_TYPE * look->points, em = points * MM_PER_POINT, value = contact->size;
    const double farthest = value >= large_share * look->largest ? 30 : 12;
    const bool arrow = value * look->arrow_scale >= long_arrow;
    const Point tip = arrow_tip(look, contact);
    char text[32];
    PageBox box;
    Segment leader;
    bool led = false;
    snprintf(text, sizeof text, "%.*f", value < 0.005 || value >= 99.95 ? 0 : value >= 9.995 ? 1 : 2, value);
    LabelWish wish = {.x = contact->at.x,
                      .y = contact->at.y,
                      .clear = look->ring,
                      .nearest = crowded ? crowd : 0,
                      .farthest = farthest,
                      .width = type_width(text, points) + 0.4 * em,
                      .height = 1.15 * em,
                      .left = contact->at.x < middle,
                      .shelf = true};
    if ((!arrow || !label_place(field, tip.x, tip.y, 0.7, wish.width, wish.height, false, &box)) &&
        !label_place_led(field, &wish, &box, &leader, &led)) {
        wish.nearest = 0;
        if (!label_place_led(field, &wish, &box, &leader, &led)) return false;
    }
    const Pen thin = pen_line(ACCENT, 0.8, NULL);
    if (led) draw_leader(sketch, &leader, &box, &thin);
    sketch_text(sketch, (Point){(box.left + box.right) / 2, (box.bottom + box.top) / 2},
                &(TextStyle){points, TEXT_CENTER, ACCENT, 0, true}, "%s", text);
    return true;
}

/* Draws the contacts of a step inside the view, over a picture of its bodies: points, normals, and impulses as arrows
   and numbers. *numbered of *count have their impulse as a number; for the others there was no room. */
static bool draw_contacts(Sketch *sketch, const View *view, const ContactLook *look, const Trajectory *run, int step,
                          int *count, int *numbered, Error *error) {
    ShownContact *contacts = gather_contacts(run, step, view, count);
    LabelField *field = calloc(1, sizeof *field);
    const bool done = (contacts != NULL && field != NULL) || error_memory(error, "figure");
    const double ring = look->ring;
    double middle = 0;
    *numbered = 0;
    if (done) field->frame = (PageBox){view->low.x + 0.3, view->low.y + 0.3, view->high.x - 0.3, view->high.y - 0.3};
    for (int i = *count - 1; done && i >= 0; i--) {
        const ShownContact *contact = &contacts[i];
        const Point at = contact->at, tip = arrow_tip(look, contact);
        const double x = NORMAL_RINGS * ring * (double)contact->normal.x,
                     y = NORMAL_RINGS * ring * (double)contact->normal.y;
        draw_contact_point(sketch, at, (Point){x, y}, ring);
        label_add_box(field, (PageBox){at.x - ring, at.y - ring, at.x + ring, at.y + ring});
        label_add_segment(field, (Segment){at.x - x, at.y - y, at.x + x, at.y + y});
        if (contact->size * look->arrow_scale < min_arrow) continue;
        sketch_arrow(sketch, at, tip, ACCENT, 2.4);
        label_add_segment(field, (Segment){at.x, at.y, tip.x, tip.y});
    }
    for (int i = 0; done && i < *count; i++) middle += contacts[i].at.x;
    middle /= fmax(*count, 1);
    for (int i = 0; done && i < *count && i < MAX_NUMBERS && !run->no_impulses; i++) {
        /* Another contact is so near that a number between them could belong to either. */
        bool crowded = false;
        for (int k = 0; k < *count; k++)
            crowded |=
                k != i && hypot(contacts[k].at.x - contacts[i].at.x, contacts[k].at.y - contacts[i].at.y) < crowd;
        *numbered += draw_number(look, sketch, &contacts[i], field, middle, crowded);
    }
    free(contacts);
    free(field);
    return done;
}

static const double annotated_gap = 2;               /* mm: between cells */
static const double max_ring = 0.55, min_ring = 0.3; /* mm */
static const double ring_share = 0.06;               /* / the shortest side of a body */
static const double body_opacity = 0.4;              /* opacity of the bodies, so that the marks stand out */
static const double annotated_aspect = 1.3;          /* height / width of a cell, at most */

enum { MAX_PANELS = 3 };

typedef struct Annotated {
    const FigureSpec *spec;
    int frame;
    RunColours colours[FIGURE_RUNS_MAX];
    RunCells cells;
    double top, foot, start; /* mm: above and below the cells; left end of the first cell */
    int title_lines;         /* of the panel with the most */
    ContactLook look;
} Annotated;

/* Without a requested time: the frame before the step in which the bomb first touches a box; otherwise the frame before
   the largest impulse. */
static bool choose_moment(Annotated *figure, Error *error) {
    const FigureSpec *spec = figure->spec;
    const Trajectory *first = spec->runs[0];
    FigureSpec requested = *spec;
    if (spec->time_count > 1)
        return error_input(error, "--at", "this kind of figure shows one moment (got %d)", spec->time_count);
    int moment = trajectory_impact(first) - 1;
    if (moment < 0) {
        double largest = -1;
        for (int step = 1; step < first->frames; step++)
            for (int64_t i = first->contact_start[step]; i < first->contact_start[step + 1]; i++) {
                const double size = impulse_magnitude(&first->contacts[i]);
                if (size > largest) largest = size, moment = step - 1;
            }
        if (largest < 0) return error_input(error, spec->paths[0], "the run has no contacts with an impulse");
    }
    if (spec->time_count == 0) {
        requested.time_count = 1;
        requested.times[0] = moment * (double)first->dt;
    }
    int frames[FIGURE_MOMENTS_MAX], count, contacts = 0;
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

static WrappedText annotated_title(const Annotated *figure, int panel, double width) {
    const FigureSpec *spec = figure->spec;
    const Trajectory *run = spec->runs[panel];
    return wrap_text(spec->points, width, "%s, %.3f s", run_name(spec, run).text, figure->frame * (double)run->dt);
}

/* What the numbers are, and how many contacts have one. */
static WrappedText contacts_line(const Annotated *figure, int panel, double width, int count, int numbered) {
    const bool unknown = figure->spec->runs[panel]->no_impulses;
    char part[48] = "";
    snprintf(part, sizeof part, unknown ? " found again" : ", impulses in N s");
    if (numbered < count && !unknown) text_add(part, sizeof part, ", %d labelled", numbered);
    return wrap_text(SMALL_TYPE * figure->spec->points, width, "%d %s%s", count, count == 1 ? "contact" : "contacts",
                     part);
}

/* What explains the marks. Returns the rows; without a sketch, it only counts them. */
static int annotated_legend(const Annotated *figure, Sketch *sketch) {
    const FigureSpec *spec = figure->spec;
    const double points = SMALL_TYPE * spec->points, largest = figure->look.largest;
    const double width = spec->width - PAGE_EDGE - figure->start;
    Flow flow = {.first = {figure->start, figure->foot - 0.7 * line_height(points)}, .width = width, .points = points};
    run_cells_scale_bar(&figure->cells, sketch, &flow);
    const char *contact = "contact, normal";
    const double reach = NORMAL_RINGS * figure->look.ring;
    Point at = flow_place(&flow, 2 * reach + 1 + type_width(contact, points), 1);
    if (sketch != NULL) {
        draw_contact_point(sketch, (Point){at.x + reach, at.y}, (Point){reach, 0}, figure->look.ring);
        sketch_text(sketch, (Point){at.x + 2 * reach + 1, at.y}, &(TextStyle){points, TEXT_LEFT, INK, 0, false}, "%s",
                    contact);
    }
    if (largest > 0) {
        const double shown = round_down(largest), arrow = shown * figure->look.arrow_scale, gap = gap_to_text(points);
        const WrappedText words =
            wrap_text(points, width - arrow - gap, "%g N s on the body with the higher number", shown);
        at = flow_place(&flow, arrow + gap + wrapped_width(&words), words.lines);
        if (sketch == NULL) return flow.row + 1;
        sketch_arrow(sketch, at, (Point){at.x + arrow, at.y}, ACCENT, 2.4);
        draw_wrapped(sketch, (Point){at.x + arrow + gap, at.y}, INK, &words);
    } else {
        const WrappedText words =
            wrap_text(points, width, spec->runs[0]->no_impulses ? "impulses are unknown" : "all impulses are 0");
        flow_text(&flow, sketch, INK, &words);
    }
    return flow.row + 1;
}

static bool annotated_lay_out(Annotated *figure, Error *error) {
    const FigureSpec *spec = figure->spec;
    const Trajectory *first = spec->runs[0];
    const double line = line_height(spec->points), arrow_share = 0.22, max_arrow = 14, foot_lines = 5;
    const double width = (spec->width - 2 * PAGE_EDGE - (spec->run_count - 1) * annotated_gap) / spec->run_count;
    /* Room above the cells for the titles, and for the lines about contacts. */
    int below = 0;
    for (int panel = 0; panel < spec->run_count; panel++) {
        const int lines = annotated_title(figure, panel, width).lines;
        const int contacts = contacts_line(figure, panel, width, 99999, 9999).lines;
        if (lines > figure->title_lines) figure->title_lines = lines;
        if (contacts > below) below = contacts;
    }
    figure->top = (figure->title_lines + 0.2) * line + below * fmin(line, SMALL_TYPE * line + 0.5);

    const double height = fmin(FIGURE_HEIGHT_MAX - figure->top - foot_lines * line, annotated_aspect * width);
    WorldWindow window = run_window(spec, &figure->frame, 1);
    run_window_widen(&window, width / height);
    if (!run_cells_begin(&figure->cells, &window, width, height, spec->dpi, error)) return false;
    figure->start = (spec->width - spec->run_count * figure->cells.width - (spec->run_count - 1) * annotated_gap) / 2;

    double side = HUGE_VAL;
    for (int i = 0; i < first->bodies; i++)
        if (!first->fixed[i]) side = fmin(side, fmin((double)first->size[i].x, (double)first->size[i].y));
    figure->look.points = spec->points;
    figure->look.ring = fmin(fmax(ring_share * side * figure->cells.scale, min_ring), max_ring);
    if (figure->look.largest > 0)
        figure->look.arrow_scale = fmin(arrow_share * figure->cells.width, max_arrow) / figure->look.largest;
    figure->foot = annotated_legend(figure, NULL) * line_height(SMALL_TYPE * spec->points) + 0.2 * line;
    return true;
}

static bool draw_panel(Annotated *figure, Sketch *sketch, int panel, Error *error) {
    const Trajectory *run = figure->spec->runs[panel];
    const double line = line_height(figure->spec->points), width = figure->cells.width;
    const Point low = {figure->start + panel * (width + annotated_gap), figure->foot};
    const View view = run_cells_view(&figure->cells, low);
    Image *image = run_cells_render(&figure->cells, run, figure->frame, &figure->colours[panel], STILL_ALL, error);
    if (image == NULL) return false;
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        image->pixels[4 * i + 3] = (uint8_t)lrint(body_opacity * image->pixels[4 * i + 3]);
    sketch_image(sketch, image, low, width);
    image_destroy(image);
    run_cells_frame(&figure->cells, sketch, low);
    int count, numbered;
    if (!draw_contacts(sketch, &view, &figure->look, run, figure->frame + 1, &count, &numbered, error)) return false;
    const WrappedText title = annotated_title(figure, panel, width);
    const WrappedText contacts = contacts_line(figure, panel, width, count, numbered);
    const double top = sketch->height - 0.6 * line;
    draw_wrapped(sketch, (Point){low.x, top}, INK, &title);
    draw_wrapped(sketch, (Point){low.x, top - title.lines * line}, INK_SOFT, &contacts);
    return true;
}

static bool annotated_draw(Sketch *sketch, const FigureSpec *spec, Error *error) {
    Annotated figure = {.spec = spec};
    bool done = run_colours(spec, figure.colours, error) && run_check_worlds(spec, error) &&
                choose_moment(&figure, error) && annotated_lay_out(&figure, error);
    if (done) sketch_begin(sketch, spec->width, figure.top + figure.foot + figure.cells.height);
    for (int i = 0; done && i < spec->run_count; i++) done = draw_panel(&figure, sketch, i, error);
    if (done) annotated_legend(&figure, sketch);
    run_cells_free(&figure.cells);
    return done;
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
};
