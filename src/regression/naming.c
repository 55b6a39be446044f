/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every differing pixel gets an owner: a text, a body, or the rest of its panel. A region has the name of the change
   that owns most of its pixels, and is not of several bodies. */
#include "regression/naming.h"

#include "base/base.h"
#include "pixels/png.h"
#include "regression/compare.h"
#include "regression/regression_internal.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const int BORDER = 4; /* pixels; a panel's frame is drawn around its rectangle */

/* Adds a change. Returns its index, or -1 if there is no room. */
static int add_change(Naming *naming, const Change *change) {
    FrameChanges *changes = naming->changes;
    if (changes->count == CHANGES_MAX) return -1;
    changes->list[changes->count] = *change;
    if (naming->scene->view->panel_count < 2) changes->list[changes->count].panel = 0;
    return changes->count++;
}

static ViewRect clipped(const Naming *naming, ViewRect rect) {
    const FrameView *view = naming->scene->view;
    if (rect.left < 0) rect.left = 0;
    if (rect.top < 0) rect.top = 0;
    if (rect.right > view->width) rect.right = view->width;
    if (rect.bottom > view->height) rect.bottom = view->height;
    return rect;
}

/* Gives the unknown pixels of a rectangle, or of a box and `margin` pixels around it within the rectangle, to a change;
   -1: to none. Returns their number. */
static int64_t naming_take(Naming *naming, ViewRect rect, const BoxModel *box, double margin, int change) {
    int64_t taken = 0;
    rect = clipped(naming, rect);
    for (int y = rect.top; y < rect.bottom; y++)
        for (int x = rect.left; x < rect.right; x++) {
            uint8_t *owner = &naming->owners[(size_t)y * (size_t)naming->scene->view->width + (size_t)x];
            if (*owner != OWNER_UNKNOWN) continue;
            if (box != NULL && box_distance(box, x + 0.5, y + 0.5) > margin) continue;
            *owner = change < 0 ? OWNER_NONE : (uint8_t)(OWNER_FIRST + change);
            taken++;
        }
    if (change >= 0) naming->changes->list[change].pixels += taken;
    return taken;
}

static int nearest(double value, int low, int high) { return value <= low ? low : value >= high ? high : (int)value; }

static int64_t take_box(Naming *naming, ViewRect rect, const BoxModel *box, double margin, int change) {
    double bounds[4];
    box_bounds(box, margin + 1, bounds);
    ViewRect inside = {
        nearest(floor(bounds[0]), rect.left, rect.right), nearest(floor(bounds[1]), rect.top, rect.bottom),
        nearest(ceil(bounds[2]), rect.left, rect.right), nearest(ceil(bounds[3]), rect.top, rect.bottom)};
    return naming_take(naming, inside, box, margin, change);
}

/* Gives the unknown pixels of a rectangle to a new change, if there are any and there is room. */
static void name_rectangle(Naming *naming, ViewRect rect, ChangeSubject subject, int panel) {
    const Change change = {.subject = subject, .panel = panel};
    int at = add_change(naming, &change);
    if (at >= 0 && naming_take(naming, rect, NULL, 0, at) == 0) naming->changes->count--;
}

static void name_parts(Naming *naming) {
    static const ChangeSubject subjects[] = {SUBJECT_HEADER, SUBJECT_CAPTION, SUBJECT_AXIS, SUBJECT_LEGEND,
                                             SUBJECT_TIMELINE};
    const FrameView *view = naming->scene->view;
    for (int i = 0; i < view->part_count; i++)
        name_rectangle(naming, view->parts[i].rect, subjects[view->parts[i].kind], view->parts[i].panel);
}

/* Whether the bodies of a panel are known. */
static bool knows_bodies(const Naming *naming, int panel) {
    const NamingScene *scene = naming->scene;
    return !scene->view->follows && scene->runs[panel][0] != NULL && scene->runs[panel][1] != NULL;
}

static void name_rest(Naming *naming) {
    const FrameView *view = naming->scene->view;
    for (int i = 0; i < view->panel_count; i++) {
        ViewRect rect = view->panels[i].rect;
        if (!knows_bodies(naming, i)) naming_take(naming, rect, NULL, 0, -1); /* a body may be what changed */
        name_rectangle(naming,
                       (ViewRect){rect.left - BORDER, rect.top - BORDER, rect.right + BORDER, rect.bottom + BORDER},
                       view->marks ? SUBJECT_MARKS : SUBJECT_BACKGROUND, i + 1);
    }
    name_rectangle(naming, (ViewRect){0, 0, view->width, view->height}, SUBJECT_PAGE, 0);
}

/* Whether change i names a region better than change j: it is of one thing, not of several bodies; or it has more
   pixels. */
static bool names_better(const FrameChanges *changes, const int64_t *pixels, int i, int j) {
    bool several_i = changes->list[i].subject == SUBJECT_BODIES, several_j = changes->list[j].subject == SUBJECT_BODIES;
    return several_i != several_j ? several_j : pixels[i] > pixels[j];
}

static const double SEEN = 0.01;  /* pixels; the states of a body that moved less explain no pixel */
static const double AROUND = 1.5; /* pixels beyond its edge that a body may change */
enum { SINGLE = 6, CHANGED = 4 };

static Change change_of(const Panel *panel, const Drawn *body, ChangeKind kind) {
    const Trajectory *run = panel->runs[0];
    BodyLayer at = panel_layer(run, body->index);
    int fixed = 0;
    for (int i = 0; i < run->bodies && fixed < 2; i++) fixed += run->fixed[i] != 0;
    ChangeSubject subject = at == LAYER_BOMB      ? SUBJECT_BOMB
                            : at == LAYER_DYNAMIC ? SUBJECT_BODY
                            : fixed == 1          ? SUBJECT_GROUND
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
        if (body->exists[side]) taken += take_box(panel->naming, panel->view->rect, &body->box[side], AROUND, change);
    return taken;
}

/* Removes the last change if it has no pixels. */
static void drop_empty(Naming *naming, int change) {
    if (change >= 0 && naming->changes->list[change].pixels == 0) naming->changes->count--;
}

static int add_moved(Panel *panel, const Drawn *body) {
    ChangeKind kind = !body->exists[0] ? CHANGE_APPEARED : !body->exists[1] ? CHANGE_DISAPPEARED : CHANGE_MOVED;
    Change change = change_of(panel, body, kind);
    if (kind == CHANGE_MOVED) {
        const BoxModel *a = &body->box[0], *b = &body->box[1];
        change.right = b->x - a->x, change.up = a->y - b->y;
        change.turn = atan2(a->cosine * b->sine - a->sine * b->cosine, a->cosine * b->cosine + a->sine * b->sine);
    }
    return add_change(panel->naming, &change);
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
        others.subject = SUBJECT_BODIES, others.body = count - SINGLE;
        if (i == SINGLE) rest = add_change(panel->naming, &others);
        if (rest >= 0) take_body(panel, moved[i], rest);
    }
    drop_empty(panel->naming, rest);
    free(moved);
    return true;
}

static void count_unknown(Panel *panel) {
    const ViewRect rect = panel->view->rect;
    for (int i = 0; i < panel->count; i++) panel->bodies[i].pixels = 0;
    for (int y = rect.top; y < rect.bottom; y++)
        for (int x = rect.left; x < rect.right; x++) {
            size_t at = panel_pixel(panel, x, y);
            int top = panel->naming->tops[at];
            if (panel->naming->owners[at] == OWNER_UNKNOWN && top >= 0 && top < panel->count)
                panel->bodies[top].pixels++;
        }
}

/* The body with the most unknown pixels, by itself: those around it are its edge, also where it lies on others. False
   if there is none, or no room. */
static bool name_most(Panel *panel) {
    int most = 0, change;
    count_unknown(panel);
    for (int i = 1; i < panel->count; i++)
        if (panel->bodies[i].pixels > panel->bodies[most].pixels) most = i;
    if (panel->count == 0 || panel->bodies[most].pixels == 0) return false;
    const Change changed = change_of(panel, &panel->bodies[most], CHANGE_OTHER);
    if ((change = add_change(panel->naming, &changed)) < 0) return false;
    take_box(panel->naming, panel->view->rect, &panel->bodies[most].box[0], AROUND, change);
    drop_empty(panel->naming, change);
    return true;
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
    if ((change = add_change(panel->naming, &others)) < 0) return;
    for (int i = 0; i < panel->count; i++)
        if (panel->bodies[i].pixels > 0)
            take_box(panel->naming, panel->view->rect, &panel->bodies[i].box[0], AROUND, change);
    drop_empty(panel->naming, change);
}

/* Names the bodies of a panel: those whose states differ, then those whose pixels do. They must be known. */
static bool name_bodies(Naming *naming, int number, Error *error) {
    Panel panel;
    bool usable = false,
         ok = panel_open(&panel, naming, number, &usable, error) && (!usable || name_moved(&panel, error));
    if (ok && usable) {
        for (int i = 0; i < CHANGED && name_most(&panel); i++) {
        }
        name_others(&panel);
    }
    panel_close(&panel);
    return ok;
}

static void name_region(Naming *naming, int region) {
    FrameChanges *changes = naming->changes;
    const ImageRegion *r = &changes->regions.list[region];
    int64_t pixels[CHANGES_MAX] = {0};
    int best = -1, others = -1;
    for (int y = r->top; y < r->bottom; y++)
        for (int x = r->left; x < r->right; x++) {
            uint8_t owner = naming->owners[(size_t)y * (size_t)naming->scene->view->width + (size_t)x];
            if (owner >= OWNER_FIRST) pixels[owner - OWNER_FIRST]++;
        }
    for (int i = 0; i < changes->count; i++) {
        if (pixels[i] == 0) continue;
        others++;
        if (best < 0 || names_better(changes, pixels, i, best)) best = i;
    }
    changes->region_change[region] = (int16_t)best;
    changes->region_others[region] = (int16_t)(others > 0 ? others : 0);
}

static void mark_differences(Naming *naming, const uint8_t *masked) {
    const Image *a = naming->pictures[0], *b = naming->pictures[1];
    size_t width = (size_t)a->width, all = width * (size_t)a->height;
    for (size_t first = 0; first < all; first += width)
        for (size_t x = image_next_difference(a, b, first, 0); x < width; x = image_next_difference(a, b, first, x + 1))
            if ((masked == NULL || masked[first + x] == 0) && image_pixel_difference(a, b, first + x) > 0)
                naming->owners[first + x] = OWNER_UNKNOWN;
}

bool naming_find(const NamingScene *scene, const Image *expected, const Image *actual, const uint8_t *masked,
                 FrameChanges *changes, Error *error) {
    const FrameView *view = scene->view;
    size_t pixels = (size_t)view->width * (size_t)view->height;
    Naming naming = {scene, {expected, actual}, .changes = changes};
    changes->count = 0;
    memset(changes->region_change, -1, sizeof changes->region_change);
    memset(changes->region_others, 0, sizeof changes->region_others);
    if (view->width != expected->width || view->height != expected->height || pixels > NAMING_PIXELS_MAX) return true;
    naming.owners = calloc(pixels, 1);
    naming.tops = malloc(pixels * sizeof *naming.tops);
    bool ok = (naming.owners != NULL && naming.tops != NULL) || error_memory(error, "regions");
    if (ok) {
        mark_differences(&naming, masked);
        name_parts(&naming);
    }
    for (int panel = 0; ok && panel < view->panel_count; panel++)
        ok = !knows_bodies(&naming, panel) || name_bodies(&naming, panel, error);
    if (ok) name_rest(&naming);
    for (int i = 0; ok && i < changes->regions.kept; i++) name_region(&naming, i);
    free(naming.owners);
    free(naming.tops);
    return ok;
}
