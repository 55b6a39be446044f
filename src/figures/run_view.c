/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What figures of runs share: contacts with their numbers; moments, windows and rendered cells; texts. */
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
#include "runs/trajectory.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#define NORMAL_RINGS 3.1 /* length of a normal on either side / radius of the point's mark */

static const double min_arrow = 1;     /* mm */
static const double long_arrow = 3;    /* mm; the number is at its tip, else at its point */
static const double crowd = 5;         /* mm; numbers of points nearer than this to each other stand apart from them */
static const double large_share = 0.3; /* impulses above this share of the largest get a number even far away */

enum { MAX_NUMBERS = 600 };

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

double impulse_magnitude(const TrajectoryContact *contact) { return vec2_distance(impulse_of(contact), vec2(0, 0)); }

bool contact_is_finite(const TrajectoryContact *contact) {
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

static const char contact_words[] = "contact, normal";

double contact_sample_width(const ContactLook *look) {
    return 2 * NORMAL_RINGS * look->ring + 1 + type_width(contact_words, SMALL_TYPE * look->points);
}

void draw_contact_sample(Sketch *sketch, Point left, const ContactLook *look) {
    const double reach = NORMAL_RINGS * look->ring;
    draw_contact_point(sketch, (Point){left.x + reach, left.y}, (Point){reach, 0}, look->ring);
    sketch_text(sketch, (Point){left.x + 2 * reach + 1, left.y},
                &(TextStyle){SMALL_TYPE * look->points, TEXT_LEFT, INK, 0, false}, "%s", contact_words);
}

/* Three significant digits, or "0", outside the pile of contacts, whose middle is at `middle`: beside the arrow's tip, or
   beside the point, with a line to it if it is not near. False if there is no room. */
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

bool draw_contacts(Sketch *sketch, const View *view, const ContactLook *look, const Trajectory *run, int step,
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

static double last_time(const Trajectory *run, int after) { return (run->frames - 1 - after) * (double)run->dt; }

static bool check_time(const FigureSpec *spec, double time, int after, Error *error) {
    for (int i = 0; i < spec->run_count; i++) {
        double last = last_time(spec->runs[i], after);
        if (time < 0 || time > last + (double)spec->runs[i]->dt / 2)
            return error_input(error, spec->paths[i], "has no moment at %g s%s; its moments are 0 to %g s", time,
                               after > 0 ? " with a step after it" : "", last);
    }
    return true;
}

bool run_frames(const FigureSpec *spec, int moments, int after, int *frames, int *count, Error *error) {
    const double dt = (double)spec->runs[0]->dt;
    if (!check_time(spec, 0, after, error)) return false;
    double last = HUGE_VAL;
    for (int i = 0; i < spec->run_count; i++) last = fmin(last, last_time(spec->runs[i], after));
    *count = spec->time_count > 0 ? spec->time_count : spec->moments > 0 ? spec->moments : moments;
    for (int i = 0; i < *count; i++) {
        double time = spec->time_count > 0 ? spec->times[i] : *count > 1 ? last * i / (*count - 1) : last;
        if (!check_time(spec, time, after, error)) return false;
        frames[i] = (int)lrint(time / dt);
    }
    if (spec->facts != NULL) {
        spec->facts->frame_count = *count;
        memcpy(spec->facts->frames, frames, (size_t)*count * sizeof *frames);
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

bool run_check_bodies(const FigureSpec *spec, Error *error) {
    for (int i = 0; i < spec->body_count; i++)
        if (spec->bodies[i] >= spec->runs[0]->bodies)
            return error_input(error, "--bodies", "there is no body %d; the run has %d bodies", spec->bodies[i],
                               spec->runs[0]->bodies);
    return true;
}

static WorldWindow window_of_view(const CameraView *view) {
    return (WorldWindow){view->x - view->width / 2, view->y - view->height / 2, view->width, view->height};
}

WorldWindow run_window(const FigureSpec *spec, const int *frames, int count) {
    const double margin_share = 0.04, least_margin = 0.4; /* m */
    const Trajectory *const *runs = spec->view_from != NULL ? &spec->view_from : spec->runs;
    CameraView set;
    if (spec->view.width > 0) return window_of_view(&spec->view);
    if (camera_view_of(runs[0], &set)) return window_of_view(&set);
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

void run_window_fill(WorldWindow *window, double shape) {
    run_window_widen(window, shape);
    window->height = fmax(window->height, window->width / shape);
}

bool run_is_outside(const Trajectory *run, int frame, int body, const WorldWindow *window) {
    if (!trajectory_has(run, frame, body)) return false;
    const Vec2 at = run->position[trajectory_at(run, frame, body)];
    const double x = (double)at.x - window->left, y = (double)at.y - window->bottom;
    return !(x >= 0 && x <= window->width && y >= 0 && y <= window->height);
}

int run_count_outside(const Trajectory *run, int frame, const WorldWindow *window) {
    int count = 0;
    for (int body = 0; body < run->bodies; body++)
        count += !run->fixed[body] && run_is_outside(run, frame, body, window);
    return count;
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

Image *run_cells_render(RunCells *cells, const Trajectory *run, int frame, const RunColours *colours, StillParts parts,
                        Error *error) {
    const StillShot shot = {run, frame, colours->light, parts, cells->camera};
    Image *image = image_create(cells->columns, cells->rows, error);
    if (image == NULL || still_draw(cells->still, &shot, image, error)) return image;
    image_destroy(image);
    return NULL;
}

bool run_cells_draw(RunCells *cells, Sketch *sketch, Point low, const Trajectory *run, int frame,
                    const RunColours *colours, Error *error) {
    Image *image = run_cells_render(cells, run, frame, colours, STILL_ALL, error);
    if (image == NULL) return false;
    sketch_image(sketch, image, low, cells->width);
    image_destroy(image);
    return true;
}

View run_cells_view(const RunCells *cells, Point low) {
    const WorldWindow *window = &cells->window;
    /* The camera's origin is the cell's lower left corner. */
    return (View){low,
                  {low.x + cells->width, low.y + cells->height},
                  {window->left + cells->width / 2 / cells->scale, window->bottom + cells->height / 2 / cells->scale},
                  cells->scale};
}

void run_cells_draw_scale_bar(const RunCells *cells, Sketch *sketch, Point left, double points) {
    sketch_scale_bar(sketch, left, cells->scale, round_down(cells->window.width / 4), "m", points);
}

void run_cells_flow_scale_bar(const RunCells *cells, Sketch *sketch, Flow *flow) {
    const double amount = round_down(cells->window.width / 4);
    const Point left = flow_place(flow, sketch_scale_bar_width(cells->scale, amount, "m", flow->points), 1);
    if (sketch != NULL) run_cells_draw_scale_bar(cells, sketch, left, flow->points);
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

RunName run_method_name(const FigureSpec *spec, const Trajectory *run) {
    RunName name;
    const char *methods[FIGURE_RUNS_MAX];
    for (int i = 0; i < spec->run_count; i++) methods[i] = spec->runs[i]->method;
    method_name_among(name.text, sizeof name.text, methods, spec->run_count, index_of(spec, run));
    return name;
}

RunName run_name(const FigureSpec *spec, const Trajectory *run) {
    RunName name;
    const char *caption = spec->captions[index_of(spec, run)];
    if (caption == NULL || caption[0] == '\0') return run_method_name(spec, run);
    snprintf(name.text, sizeof name.text, "%s", caption);
    return name;
}

bool run_colours(const FigureSpec *spec, RunColours *colours, Error *error) {
    const char *methods[FIGURE_RUNS_MAX];
    for (int i = 0; i < spec->run_count; i++) methods[i] = spec->runs[i]->method;
    return colours_assign(methods, spec->run_count, &spec->colours, colours, error);
}
