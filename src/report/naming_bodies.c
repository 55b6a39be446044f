/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/naming_bodies.h"

#include "report/body_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double SEEN = 0.01;     /* pixels; the states of a body that moved less explain no pixel */
static const double AROUND = 1.5;    /* pixels beyond its edge that a body may change */
static const double MODEL_REACH = 3; /* the same, for pixels that a fit takes in any case */
enum { FITS = 4, CANDIDATES = 4, SINGLE = 6, PAINTED_MAX = 64 /* times the panel, by all bodies */ };

/* A body as drawn in a panel. */
typedef struct Drawn {
    int index;
    bool exists[2];
    BoxModel box[2]; /* expected, actual */
    double moved;    /* pixels, of the corner that the states move farthest; infinite if it exists on one side only */
    int64_t pixels;  /* unknown ones on it */
    bool tried;
} Drawn;

typedef struct Panel {
    Naming *naming;
    int number; /* from 0 */
    const ViewPanel *view;
    const Trajectory *runs[2];
    int count;
    Drawn *bodies; /* [count], in the order of drawing: static, dynamic, bomb */
    FitPixels *pixels;
} Panel;

static bool place(const Panel *panel, const Trajectory *run, int body, BoxModel *box) {
    int frame = panel->naming->scene->frame < run->frames ? panel->naming->scene->frame : run->frames - 1;
    if (body >= run->bodies || !trajectory_has(run, frame, body)) return false;
    size_t i = (size_t)frame * (size_t)run->bodies + (size_t)body;
    const ViewPanel *view = panel->view;
    double angle = (double)run->angle[i], scale = view->scale;
    *box = (BoxModel){.x = view->rect.left + view->left + scale * (double)run->position[i].x,
                      .y = view->rect.top + view->top - scale * (double)run->position[i].y,
                      .cosine = cos(angle),
                      .sine = sin(angle),
                      .half_width = scale * (double)run->size[body].x / 2,
                      .half_height = scale * (double)run->size[body].y / 2,
                      .target = body == run->bomb};
    return true;
}

/* The largest movement of a corner. */
static double movement(const BoxModel *a, const BoxModel *b) {
    double reach = sqrt(a->half_width * a->half_width + a->half_height * a->half_height);
    double x = b->x - a->x, y = b->y - a->y, cosine = b->cosine - a->cosine, sine = b->sine - a->sine;
    return sqrt(x * x + y * y) + reach * sqrt(cosine * cosine + sine * sine);
}

static int layer(const Trajectory *run, int body) { return body == run->bomb ? 2 : run->fixed[body] ? 0 : 1; }

static void add_layer(Panel *panel, int wanted) {
    const Trajectory *expected = panel->runs[0], *actual = panel->runs[1];
    for (int body = 0; body < expected->bodies; body++) {
        if (layer(expected, body) != wanted) continue;
        Drawn drawn = {.index = body};
        drawn.exists[0] = place(panel, expected, body, &drawn.box[0]);
        drawn.exists[1] = place(panel, actual, body, &drawn.box[1]);
        if (drawn.exists[0] != drawn.exists[1]) drawn.moved = INFINITY;
        if (drawn.exists[0] && drawn.exists[1]) drawn.moved = movement(&drawn.box[0], &drawn.box[1]);
        if (drawn.exists[0] || drawn.exists[1]) panel->bodies[panel->count++] = drawn;
    }
}

/* The part of a box's bounds that is in the panel; empty if right <= left. */
static ViewRect bounds_in(const Panel *panel, const BoxModel *box, double margin) {
    double bounds[4];
    ViewRect rect = panel->view->rect;
    box_bounds(box, margin, bounds);
    if (bounds[0] > rect.left) rect.left = (int)fmin(floor(bounds[0]), rect.right);
    if (bounds[1] > rect.top) rect.top = (int)fmin(floor(bounds[1]), rect.bottom);
    if (bounds[2] < rect.right) rect.right = (int)fmax(ceil(bounds[2]), rect.left);
    if (bounds[3] < rect.bottom) rect.bottom = (int)fmax(ceil(bounds[3]), rect.top);
    return rect;
}

static size_t pixel_at(const Panel *panel, int x, int y) {
    return (size_t)y * (size_t)panel->naming->scene->view->width + (size_t)x;
}

/* The width of an outline, at most (picture/body.c). */
static double outline_reach(const Panel *panel) {
    const ViewRect *rect = &panel->view->rect;
    return 3 + 0.008 * fmin(rect->right - rect->left, rect->bottom - rect->top);
}

/* Outlines of other runs are above all bodies. */
static void paint_outlines(const Panel *panel, const Trajectory *run) {
    const double reach = outline_reach(panel);
    for (int body = 0; body < run->bodies; body++) {
        BoxModel box;
        if (run->fixed[body] || !place(panel, run, body, &box)) continue;
        ViewRect rect = bounds_in(panel, &box, 1);
        for (int y = rect.top; y < rect.bottom; y++)
            for (int x = rect.left; x < rect.right; x++) {
                double distance = box_distance(&box, x + 0.5, y + 0.5);
                if (distance < 0.5 && distance > -reach) panel->naming->tops[pixel_at(panel, x, y)] = panel->count;
            }
    }
}

/* Paints the expected bodies into `tops`, half a pixel larger: with their smoothed edges. False if bodies so large and
   many are no picture of a scene. */
static bool paint_tops(const Panel *panel) {
    const ViewRect whole = panel->view->rect;
    int64_t painted = 0, most = PAINTED_MAX * (int64_t)(whole.right - whole.left) * (whole.bottom - whole.top);
    for (int y = whole.top; y < whole.bottom; y++)
        for (int x = whole.left; x < whole.right; x++) panel->naming->tops[pixel_at(panel, x, y)] = -1;
    for (int i = 0; i < panel->count && painted <= most; i++) {
        const BoxModel *box = &panel->bodies[i].box[0];
        if (!panel->bodies[i].exists[0]) continue;
        ViewRect rect = bounds_in(panel, box, 1);
        painted += (int64_t)(rect.right - rect.left) * (rect.bottom - rect.top);
        for (int y = rect.top; y < rect.bottom; y++)
            for (int x = rect.left; x < rect.right; x++)
                if (box_distance(box, x + 0.5, y + 0.5) < 0.5) panel->naming->tops[pixel_at(panel, x, y)] = i;
    }
    for (int i = 0; painted <= most && i < panel->view->outline_count; i++)
        if (panel->naming->scene->outlines[panel->number][i] != NULL)
            paint_outlines(panel, panel->naming->scene->outlines[panel->number][i]);
    return painted <= most;
}

static Change change_of(const Panel *panel, const Drawn *body, ChangeKind kind) {
    const Trajectory *run = panel->runs[0];
    int fixed = 0, at = layer(run, body->index);
    for (int i = 0; i < run->bodies && fixed < 2; i++) fixed += run->fixed[i] != 0;
    ChangeSubject subject = at == 2      ? SUBJECT_BOMB
                            : at == 1    ? SUBJECT_BODY
                            : fixed == 1 ? SUBJECT_GROUND
                                         : SUBJECT_FIXED;
    return (Change){.subject = subject, .kind = kind, .panel = panel->number + 1, .body = body->index};
}

static int by_movement(const void *a, const void *b) {
    const Drawn *x = *(const Drawn *const *)a, *y = *(const Drawn *const *)b;
    if (x->moved != y->moved) return x->moved > y->moved ? -1 : 1;
    return x->index < y->index ? -1 : 1;
}

static int64_t take_body(Panel *panel, const Drawn *body, int change) {
    int64_t taken = 0;
    for (int side = 0; side < 2; side++)
        if (body->exists[side])
            taken += naming_take_box(panel->naming, panel->view->rect, &body->box[side], AROUND, change);
    return taken;
}

/* Removes the last change if it has no pixels. */
static void drop_empty(Naming *naming, int change) {
    if (change >= 0 && naming->changes->list[change].pixels == 0) naming->changes->count--;
}

static int add_moved(Panel *panel, const Drawn *body) {
    ChangeKind kind = !body->exists[0] ? CHANGE_APPEARED : !body->exists[1] ? CHANGE_DISAPPEARED : CHANGE_MOVED;
    Change change = change_of(panel, body, kind);
    change.by_states = true;
    if (kind == CHANGE_MOVED) {
        const BoxModel *a = &body->box[0], *b = &body->box[1];
        change.right = b->x - a->x, change.up = a->y - b->y;
        change.turn = atan2(a->cosine * b->sine - a->sine * b->cosine, a->cosine * b->cosine + a->sine * b->sine);
    }
    return naming_add(panel->naming, &change);
}

/* Those that moved farthest get names, and the others their number. */
static bool name_moved(Panel *panel, Error *error) {
    const Drawn **moved = malloc(((size_t)panel->count + 1) * sizeof *moved);
    int count = 0, rest = -1;
    if (moved == NULL) return error_memory(error, "regions");
    for (int i = 0; i < panel->count; i++)
        if (panel->bodies[i].moved >= SEEN) moved[count++] = &panel->bodies[i];
    qsort(moved, (size_t)count, sizeof *moved, by_movement);
    for (int i = 0; i < count; i++) {
        if (i < SINGLE) {
            int change = add_moved(panel, moved[i]);
            if (change >= 0) take_body(panel, moved[i], change);
            drop_empty(panel->naming, change);
            continue;
        }
        Change others = change_of(panel, moved[i], CHANGE_MOVED);
        others.subject = SUBJECT_BODIES, others.by_states = true, others.body = count - SINGLE;
        if (i == SINGLE) rest = naming_add(panel->naming, &others);
        if (rest >= 0) take_body(panel, moved[i], rest);
    }
    drop_empty(panel->naming, rest);
    free(moved);
    return true;
}

static void colour_at(const Image *image, size_t pixel, double colour[3]) {
    for (int c = 0; c < 3; c++) colour[c] = image->pixels[4 * pixel + (size_t)c];
}

/* The panel's most frequent colour near a body, where no body is. */
static void find_background(const Panel *panel, ViewRect rect, double colour[3]) {
    const Image *image = panel->naming->pictures[0];
    int64_t votes = 0;
    memset(colour, 0, 3 * sizeof *colour);
    for (int y = rect.top; y < rect.bottom; y++)
        for (int x = rect.left; x < rect.right; x++) {
            size_t pixel = pixel_at(panel, x, y);
            double here[3];
            if (panel->naming->tops[pixel] >= 0) continue;
            colour_at(image, pixel, here);
            bool same = here[0] == colour[0] && here[1] == colour[1] && here[2] == colour[2];
            if (votes == 0) memcpy(colour, here, sizeof here);
            votes += same || votes == 0 ? 1 : -1;
        }
}

/* True if another body is within a pixel: what the body's smoothed edge is drawn over is then not known. */
static bool is_crowded(const Panel *panel, int x, int y, int self) {
    const ViewRect rect = panel->view->rect;
    for (int v = y - 1; v <= y + 1; v++)
        for (int u = x - 1; u <= x + 1; u++) {
            if (u < rect.left || v < rect.top || u >= rect.right || v >= rect.bottom) continue;
            int top = panel->naming->tops[pixel_at(panel, u, v)];
            if (top >= 0 && top != self) return true;
        }
    return false;
}

/* What is behind the smoothed edge at a pixel: the nearest pixel outside. */
static void behind_edge(const Panel *panel, const BoxModel *box, int x, int y, double colour[3]) {
    const ViewRect rect = panel->view->rect;
    double farthest = 0.5;
    for (int i = 0; i < 9; i++) {
        int u = x + i % 3 - 1, v = y + i / 3 - 1;
        double distance = box_distance(box, u + 0.5, v + 0.5);
        if (distance < farthest || u < rect.left || v < rect.top || u >= rect.right || v >= rect.bottom) continue;
        farthest = distance;
        colour_at(panel->naming->pictures[0], pixel_at(panel, u, v), colour);
    }
}

/* Adds the pixel to those of a fit unless it says nothing about the body. */
static void add_pixel(Panel *panel, int self, int x, int y, const double background[3]) {
    const Naming *naming = panel->naming;
    const BoxModel *box = &panel->bodies[self].box[0];
    size_t at = pixel_at(panel, x, y);
    double distance = box_distance(box, x + 0.5, y + 0.5), after[3];
    if (naming->tops[at] > self) return; /* a body drawn later hides it */
    if (distance > MODEL_REACH && naming->owners[at] == OWNER_NONE) return;
    if (distance > -0.5 && distance < AROUND && is_crowded(panel, x, y, self)) return;
    FitPixel *pixel = &panel->pixels->list[panel->pixels->count++];
    *pixel = (FitPixel){.x = x + 0.5, .y = y + 0.5};
    colour_at(naming->pictures[0], at, pixel->before);
    colour_at(naming->pictures[1], at, after);
    bool masked = naming->owners[at] != OWNER_UNKNOWN; /* equal, or changed by something else */
    for (int c = 0; c < 3; c++) pixel->difference[c] = masked ? 0 : after[c] - pixel->before[c];
    memcpy(pixel->behind, background, sizeof pixel->behind);
    if (distance >= 0.5)
        memcpy(pixel->behind, pixel->before, sizeof pixel->behind);
    else if (distance > -0.5)
        behind_edge(panel, box, x, y, pixel->behind);
}

/* Far inside, boxes are of one colour. */
static double depth_of(const BoxModel *box) { return fmax(0.5 * fmin(box->half_width, box->half_height), 8); }

/* Takes every n-th row if there are too many pixels. */
static void collect(Panel *panel, int self, ViewRect rect) {
    const BoxModel *box = &panel->bodies[self].box[0];
    double depth = depth_of(box), background[3];
    find_background(panel, rect, background);
    for (int stride = 1;; stride *= 2) {
        bool full = false;
        panel->pixels->count = 0;
        for (int y = rect.top; y < rect.bottom && !full; y++)
            for (int x = rect.left + y % stride; x < rect.right && !full; x += stride) {
                full = panel->pixels->count == FIT_PIXELS_MAX;
                if (!full && box_distance(box, x + 0.5, y + 0.5) >= -depth) add_pixel(panel, self, x, y, background);
            }
        if (!full) return;
    }
}

/* The bounds of the panel's unknown pixels; empty if there are none. */
static ViewRect unknown_bounds(const Panel *panel) {
    const ViewRect rect = panel->view->rect;
    ViewRect found = {rect.right, rect.bottom, rect.left, rect.top};
    for (int y = rect.top; y < rect.bottom; y++)
        for (int x = rect.left; x < rect.right; x++) {
            if (panel->naming->owners[pixel_at(panel, x, y)] != OWNER_UNKNOWN) continue;
            if (x < found.left) found.left = x;
            if (x >= found.right) found.right = x + 1;
            if (y < found.top) found.top = y;
            if (y >= found.bottom) found.bottom = y + 1;
        }
    return found;
}

static ViewRect join(ViewRect a, ViewRect b) {
    return (ViewRect){a.left < b.left ? a.left : b.left, a.top < b.top ? a.top : b.top,
                      a.right > b.right ? a.right : b.right, a.bottom > b.bottom ? a.bottom : b.bottom};
}

/* How far a side moved that now is where the changes end; 0 for a side that the panel does not show. */
static double start_of(double side, double changed, int low, int high) {
    return side > low && side < high ? changed - side : 0;
}

/* A body that moved far changes the picture at its old and its new place: the bounds of all changes show how far. */
static BodyFit fit(Panel *panel, int self, ViewRect changed) {
    const BoxModel *box = &panel->bodies[self].box[0];
    const ViewRect *rect = &panel->view->rect;
    double bounds[4], starts[MOVEMENT_STARTS_MAX][2];
    int count = 0;
    box_bounds(box, 0, bounds);
    const double x[3] = {0, start_of(bounds[0], changed.left, rect->left, rect->right),
                         start_of(bounds[2], changed.right, rect->left, rect->right)};
    const double y[3] = {0, start_of(bounds[1], changed.top, rect->top, rect->bottom),
                         start_of(bounds[3], changed.bottom, rect->top, rect->bottom)};
    for (int i = 1; i < 9; i++)
        if (x[i % 3] != 0 || y[i / 3] != 0) starts[count][0] = x[i % 3], starts[count++][1] = y[i / 3];
    collect(panel, self, join(changed, bounds_in(panel, box, MODEL_REACH)));
    return body_fit(box, panel->pixels, (const double(*)[2])starts, count);
}

static void count_unknown(Panel *panel) {
    const ViewRect rect = panel->view->rect;
    for (int i = 0; i < panel->count; i++) panel->bodies[i].pixels = 0;
    for (int y = rect.top; y < rect.bottom; y++)
        for (int x = rect.left; x < rect.right; x++) {
            size_t at = pixel_at(panel, x, y);
            int top = panel->naming->tops[at];
            if (panel->naming->owners[at] == OWNER_UNKNOWN && top >= 0 && top < panel->count)
                panel->bodies[top].pixels++;
        }
}

/* The body not yet tried with the most unknown pixels, or -1. */
static int next_candidate(const Panel *panel) {
    int best = -1;
    for (int i = 0; i < panel->count; i++) {
        if (panel->bodies[i].tried || panel->bodies[i].pixels == 0) continue;
        if (best < 0 || panel->bodies[i].pixels > panel->bodies[best].pixels) best = i;
    }
    return best;
}

/* Names the body whose change explains most. False if no body has unknown pixels. */
static bool name_best(Panel *panel) {
    BodyFit best = {.explained = -1};
    int body = -1;
    const ViewRect changed = unknown_bounds(panel);
    count_unknown(panel);
    for (int i = 0; i < panel->count; i++) panel->bodies[i].tried = false;
    for (int tried = 0, at; tried < CANDIDATES && (at = next_candidate(panel)) >= 0; tried++) {
        panel->bodies[at].tried = true;
        BodyFit found = fit(panel, at, changed);
        if (body >= 0 && found.explained <= best.explained) continue;
        best = found, body = at;
    }
    if (body < 0) return false;
    Drawn drawn = panel->bodies[body];
    Change change = change_of(panel, &drawn, best.kind);
    change.right = best.right, change.up = best.up, change.turn = best.turn;
    /* Changes that the fit does not see are inside the body: its colours, or a bomb's target. */
    if (best.total <= 0) change.kind = CHANGE_COLOUR;
    drawn.exists[1] = true;
    drawn.box[1] = drawn.box[0];
    drawn.box[1].x += best.right, drawn.box[1].y -= best.up;
    drawn.box[1].cosine = cos(best.turn) * drawn.box[0].cosine - sin(best.turn) * drawn.box[0].sine;
    drawn.box[1].sine = sin(best.turn) * drawn.box[0].cosine + cos(best.turn) * drawn.box[0].sine;
    int added = naming_add(panel->naming, &change);
    bool took = added >= 0 && take_body(panel, &drawn, added) > 0;
    drop_empty(panel->naming, added);
    return took;
}

/* Bodies that still have unknown pixels: their number, or the only one. */
static void name_others(Panel *panel) {
    int count = 0, last = -1, change;
    count_unknown(panel);
    for (int i = 0; i < panel->count; i++)
        if (panel->bodies[i].pixels > 0) count++, last = i;
    if (count == 0) return;
    Change others = change_of(panel, &panel->bodies[last], CHANGE_OTHER);
    if (count > 1) others.subject = SUBJECT_BODIES, others.body = count;
    if ((change = naming_add(panel->naming, &others)) < 0) return;
    for (int i = 0; i < panel->count; i++)
        if (panel->bodies[i].pixels > 0)
            naming_take_box(panel->naming, panel->view->rect, &panel->bodies[i].box[0], AROUND, change);
    drop_empty(panel->naming, change);
}

bool naming_bodies(Naming *naming, int number, Error *error) {
    Panel panel = {naming, number, &naming->scene->view->panels[number],
                   .runs = {naming->scene->runs[number][0], naming->scene->runs[number][1]}};
    panel.bodies = calloc((size_t)panel.runs[0]->bodies + 1, sizeof *panel.bodies);
    panel.pixels = malloc(sizeof *panel.pixels);
    bool ok = (panel.bodies != NULL && panel.pixels != NULL) || error_memory(error, "regions");
    for (int wanted = 0; ok && wanted < 3; wanted++) add_layer(&panel, wanted);
    if (ok && paint_tops(&panel)) {
        ok = name_moved(&panel, error);
        for (int i = 0; ok && i < FITS && name_best(&panel); i++) {
        }
        if (ok) name_others(&panel);
    }
    free(panel.bodies);
    free(panel.pixels);
    return ok;
}
