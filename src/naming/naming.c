/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every differing pixel gets an owner: a text, a body, or the rest of its panel. A region has the name of the change that
   owns most of its pixels, and is not of several bodies. */
#include "naming/naming.h"

#include "naming/naming_bodies.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const int BORDER = 4; /* pixels; a panel's frame is drawn around its rectangle */

int naming_add(Naming *naming, const Change *change) {
    FrameChanges *changes = naming->changes;
    if (changes->count == CHANGES_MAX) return -1;
    changes->list[changes->count] = *change;
    if (naming->scene->view->panel_count < 2) changes->list[changes->count].panel = 0;
    return changes->count++;
}

static ViewRect clipped(const Naming *naming, ViewRect rect) {
    const View *view = naming->scene->view;
    if (rect.left < 0) rect.left = 0;
    if (rect.top < 0) rect.top = 0;
    if (rect.right > view->width) rect.right = view->width;
    if (rect.bottom > view->height) rect.bottom = view->height;
    return rect;
}

/* box NULL: the whole rectangle. */
static int64_t take(Naming *naming, ViewRect rect, const BoxModel *box, double margin, int change) {
    int64_t taken = 0;
    rect = clipped(naming, rect);
    for (int y = rect.top; y < rect.bottom; y++)
        for (int x = rect.left; x < rect.right; x++) {
            uint8_t *owner = &naming->owners[(size_t)y * (size_t)naming->scene->view->width + (size_t)x];
            if (*owner != OWNER_UNKNOWN) continue;
            if (box != NULL && box_distance(box, x + 0.5, y + 0.5) > margin) continue;
            *owner = (uint8_t)(OWNER_FIRST + change);
            taken++;
        }
    naming->changes->list[change].pixels += taken;
    return taken;
}

int64_t naming_take_rectangle(Naming *naming, ViewRect rect, int change) { return take(naming, rect, NULL, 0, change); }

static int nearest(double value, int low, int high) { return value <= low ? low : value >= high ? high : (int)value; }

int64_t naming_take_box(Naming *naming, ViewRect rect, const BoxModel *box, double margin, int change) {
    double bounds[4];
    box_bounds(box, margin + 1, bounds);
    ViewRect inside = {
        nearest(floor(bounds[0]), rect.left, rect.right), nearest(floor(bounds[1]), rect.top, rect.bottom),
        nearest(ceil(bounds[2]), rect.left, rect.right), nearest(ceil(bounds[3]), rect.top, rect.bottom)};
    return take(naming, inside, box, margin, change);
}

/* Gives the unknown pixels of a rectangle to a new change, if there are any and there is room. */
static void name_rectangle(Naming *naming, ViewRect rect, ChangeSubject subject, int panel) {
    const Change change = {.subject = subject, .panel = panel};
    int at = naming_add(naming, &change);
    if (at >= 0 && naming_take_rectangle(naming, rect, at) == 0) naming->changes->count--;
}

static void name_parts(Naming *naming) {
    static const ChangeSubject subjects[] = {SUBJECT_HEADER, SUBJECT_CAPTION, SUBJECT_AXIS, SUBJECT_LEGEND,
                                             SUBJECT_TIMELINE};
    const View *view = naming->scene->view;
    for (int i = 0; i < view->part_count; i++)
        name_rectangle(naming, view->parts[i].rect, subjects[view->parts[i].kind], view->parts[i].panel);
}

bool naming_knows_bodies(const Naming *naming, int panel) {
    const NamingScene *scene = naming->scene;
    return !scene->view->follows && scene->runs[panel][0] != NULL && scene->runs[panel][1] != NULL;
}

/* Leaves the unknown pixels of a rectangle without a name. */
static void leave_rectangle(Naming *naming, ViewRect rect) {
    for (int y = rect.top; y < rect.bottom; y++)
        for (int x = rect.left; x < rect.right; x++) {
            uint8_t *owner = &naming->owners[(size_t)y * (size_t)naming->scene->view->width + (size_t)x];
            if (*owner == OWNER_UNKNOWN) *owner = OWNER_NONE;
        }
}

static void name_rest(Naming *naming) {
    const View *view = naming->scene->view;
    for (int i = 0; i < view->panel_count; i++) {
        ViewRect rect = view->panels[i].rect;
        if (!naming_knows_bodies(naming, i)) leave_rectangle(naming, rect); /* a body may be what changed */
        name_rectangle(naming,
                       (ViewRect){rect.left - BORDER, rect.top - BORDER, rect.right + BORDER, rect.bottom + BORDER},
                       view->marks ? SUBJECT_MARKS : SUBJECT_BACKGROUND, i + 1);
    }
    name_rectangle(naming, (ViewRect){0, 0, view->width, view->height}, SUBJECT_PAGE, 0);
}

/* Whether change i names a region better than change j: it is of one thing, not of several bodies; or it has more pixels. */
static bool names_better(const FrameChanges *changes, const int64_t *pixels, int i, int j) {
    bool several_i = changes->list[i].subject == SUBJECT_BODIES, several_j = changes->list[j].subject == SUBJECT_BODIES;
    return several_i != several_j ? several_j : pixels[i] > pixels[j];
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
    const View *view = scene->view;
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
        ok = !naming_knows_bodies(&naming, panel) || naming_bodies(&naming, panel, error);
    if (ok) name_rest(&naming);
    for (int i = 0; ok && i < changes->regions.kept; i++) name_region(&naming, i);
    free(naming.owners);
    free(naming.tops);
    return ok;
}
