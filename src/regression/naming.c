/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every differing pixel gets an owner: a text, a body, or the rest of its panel. A region has the name of the change
   that owns most of its pixels, and is not of several bodies. */
#include "regression/naming.h"

#include "base/base.h"
#include "base/numbers.h"
#include "regression/image_compare.h"
#include "regression/view.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    PAINTED_MAX = 64, /* times a panel, by all its bodies: more are no picture of a scene */
    BORDER = 4,       /* pixels; a panel's frame is drawn around its rectangle */
    SINGLE = 6,       /* bodies of a panel that get a name because they moved, */
    CHANGED = 4       /* and because their pixels changed */
};
static const double SEEN = 0.01;  /* pixels; the states of a body that moved less explain no pixel */
static const double AROUND = 1.5; /* pixels beyond its edge that a body may change */

/* Owners of differing pixels: CHANGE i is OWNER_FIRST + i. */
enum { OWNER_NONE, OWNER_UNKNOWN, OWNER_FIRST };

typedef struct Naming {
    const NamingScene *scene;
    size_t width;
    ViewRect inside; /* all pixels that differ */
    uint8_t *owners; /* [height, width], of the differing pixels */
    int32_t *tops;   /* [height, width] what is drawn on top in the expected picture: a body in the order of
                        drawing, or (their number) an outline; -1: nothing */
    FrameChanges *changes;
} Naming;

/* A box as twinbox draws it. Pixels, y down. */
typedef struct DrawnBox {
    double x, y;         /* centre */
    double cosine, sine; /* of the angle, counter-clockwise on the screen */
    double half_width, half_height;
} DrawnBox;

/* A body as drawn in a panel. */
typedef struct Drawn {
    int index;
    bool exists[2];
    DrawnBox box[2]; /* expected, actual */
    double moved;    /* pixels, of the corner that the states move farthest; infinite if it exists on one side only */
    int64_t pixels;  /* unknown ones on it */
} Drawn;

typedef struct Panel {
    Naming *naming;
    int number; /* from 0 */
    const ViewPanel *view;
    const Trajectory *runs[2];
    int count;
    Drawn *bodies; /* [count], in the order of drawing */
} Panel;

/* Signed distance of a point from the edge, negative inside. */
static double distance(const DrawnBox *box, double x, double y) {
    const double along = box->cosine * (x - box->x) - box->sine * (y - box->y);
    const double up = -box->sine * (x - box->x) - box->cosine * (y - box->y);
    const double side = fabs(along) - box->half_width, end = fabs(up) - box->half_height;
    return side > 0 && end > 0 ? sqrt(side * side + end * end) : fmax(side, end);
}

/* The part of the rectangle that a box and a margin around it may reach; empty if right <= left. */
static ViewRect bounds(const DrawnBox *box, double margin, ViewRect rect) {
    const double cosine = fabs(box->cosine), sine = fabs(box->sine);
    const double x = cosine * box->half_width + sine * box->half_height + margin;
    const double y = sine * box->half_width + cosine * box->half_height + margin;
    if (box->x - x > rect.left) rect.left = (int)fmin(floor(box->x - x), rect.right);
    if (box->y - y > rect.top) rect.top = (int)fmin(floor(box->y - y), rect.bottom);
    if (box->x + x < rect.right) rect.right = (int)fmax(ceil(box->x + x), rect.left);
    if (box->y + y < rect.bottom) rect.bottom = (int)fmax(ceil(box->y + y), rect.top);
    return rect;
}

/* The part of a rectangle in which pixels differ; empty if right <= left or bottom <= top. */
static ViewRect clip(const Naming *naming, ViewRect rect) {
    const ViewRect *inside = &naming->inside;
    return (ViewRect){int_max(rect.left, inside->left), int_max(rect.top, inside->top),
                      int_min(rect.right, inside->right), int_min(rect.bottom, inside->bottom)};
}

/* Adds a change. Returns its index, or -1 if there is no room. */
static int add_change(Naming *naming, const Change *change) {
    FrameChanges *changes = naming->changes;
    if (changes->count == CHANGES_MAX) return -1;
    changes->list[changes->count] = *change;
    if (naming->scene->view->panel_count < 2) changes->list[changes->count].panel = 0;
    return changes->count++;
}

/* Gives the unknown pixels of a rectangle, or of a box and `margin` pixels around it within the rectangle, to a change;
   -1: to none. */
static void take(Naming *naming, ViewRect rect, const DrawnBox *box, double margin, int change) {
    int64_t taken = 0;
    rect = clip(naming, box != NULL ? bounds(box, margin + 1, rect) : rect);
    for (int y = rect.top; y < rect.bottom; y++) {
        uint8_t *const row = naming->owners + (size_t)y * naming->width;
        for (int x = rect.left; x < rect.right; x++) {
            const uint8_t *next = memchr(row + x, OWNER_UNKNOWN, (size_t)(rect.right - x));
            if (next == NULL) break;
            x = (int)(next - row);
            if (box != NULL && distance(box, x + 0.5, y + 0.5) > margin) continue;
            row[x] = change < 0 ? OWNER_NONE : (uint8_t)(OWNER_FIRST + change);
            taken++;
        }
    }
    if (change >= 0) naming->changes->list[change].pixels += taken;
}

/* Removes the last change if it has no pixels. */
static void drop_empty(Naming *naming, int change) {
    if (change >= 0 && naming->changes->list[change].pixels == 0) naming->changes->count--;
}

/* Gives the unknown pixels of a rectangle to a new change, if there are any and there is room. */
static void name_rectangle(Naming *naming, ViewRect rect, ChangeSubject subject, int panel) {
    const int change = add_change(naming, &(Change){.subject = subject, .panel = panel});
    if (change >= 0) take(naming, rect, NULL, 0, change);
    drop_empty(naming, change);
}

static bool place(const Panel *panel, const Trajectory *run, int body, DrawnBox *box) {
    int frame = panel->naming->scene->frame < run->frames ? panel->naming->scene->frame : run->frames - 1;
    if (body >= run->bodies || !trajectory_has(run, frame, body)) return false;
    size_t i = (size_t)frame * (size_t)run->bodies + (size_t)body;
    const ViewPanel *view = panel->view;
    double angle = (double)run->angle[i], scale = view->scale;
    *box = (DrawnBox){.x = view->rect.left + view->left + scale * (double)run->position[i].x,
                      .y = view->rect.top + view->top - scale * (double)run->position[i].y,
                      .cosine = cos(angle),
                      .sine = sin(angle),
                      .half_width = scale * (double)run->size[body].x / 2,
                      .half_height = scale * (double)run->size[body].y / 2};
    return true;
}

/* The order of drawing. */
typedef enum Layer { LAYER_STATIC, LAYER_DYNAMIC, LAYER_BOMB, LAYERS } Layer;

static Layer layer_of(const Trajectory *run, int body) {
    return body == run->bomb ? LAYER_BOMB : run->fixed[body] ? LAYER_STATIC : LAYER_DYNAMIC;
}

/* Paints a box into `tops`, where pixels differ: what is between these distances from its edge. */
static void paint(const Panel *panel, const DrawnBox *box, double from, double to, int top) {
    const ViewRect rect = clip(panel->naming, bounds(box, 1, panel->view->rect));
    for (int y = rect.top; y < rect.bottom; y++)
        for (int x = rect.left; x < rect.right; x++) {
            const double at = distance(box, x + 0.5, y + 0.5);
            if (at < to && at > from) panel->naming->tops[(size_t)y * panel->naming->width + (size_t)x] = top;
        }
}

/* Paints the expected bodies into `tops`, half a pixel larger: with their smoothed edges. Outlines of other runs are
   above all bodies. */
static void paint_tops(const Panel *panel) {
    const NamingScene *scene = panel->naming->scene;
    const ViewRect whole = panel->view->rect, rect = clip(panel->naming, whole);
    const double outline = 3 + 0.008 * int_min(whole.right - whole.left, whole.bottom - whole.top); /* at most
        (pictures/bodies.c) */
    for (int y = rect.top; y < rect.bottom; y++)
        for (int x = rect.left; x < rect.right; x++)
            panel->naming->tops[(size_t)y * panel->naming->width + (size_t)x] = -1;
    for (int i = 0; i < panel->count; i++)
        if (panel->bodies[i].exists[0]) paint(panel, &panel->bodies[i].box[0], -INFINITY, 0.5, i);
    for (int i = 0; i < panel->view->outline_count; i++) {
        const Trajectory *run = scene->outlines[panel->number][i];
        DrawnBox box;
        for (int body = 0; run != NULL && body < run->bodies; body++)
            if (!run->fixed[body] && place(panel, run, body, &box)) paint(panel, &box, -outline, 0.5, panel->count);
    }
}

static Change change_of(const Panel *panel, const Drawn *body, ChangeKind kind) {
    const Trajectory *run = panel->runs[0];
    Layer at = layer_of(run, body->index);
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

/* Those that moved farthest get names, and the others their number. */
static bool name_moved(Panel *panel, Error *error) {
    const Drawn **moved = malloc(((size_t)panel->count + 1) * sizeof *moved);
    int count = 0, change = -1;
    if (moved == NULL) return error_memory(error, "regions");
    for (int i = 0; i < panel->count; i++)
        if (panel->bodies[i].moved >= SEEN) moved[count++] = &panel->bodies[i];
    qsort(moved, (size_t)count, sizeof *moved, by_movement);
    for (int i = 0; i < count; i++) {
        const Drawn *body = moved[i];
        const DrawnBox *a = &body->box[0], *b = &body->box[1];
        const bool both = body->exists[0] && body->exists[1];
        Change found = change_of(panel, body,
                                 both || i >= SINGLE ? CHANGE_MOVED
                                 : body->exists[0]   ? CHANGE_DISAPPEARED
                                                     : CHANGE_APPEARED);
        if (i >= SINGLE) {
            found.subject = SUBJECT_BODIES, found.body = count - SINGLE;
        } else if (both) {
            found.right = b->x - a->x, found.up = a->y - b->y;
            found.turn = atan2(a->cosine * b->sine - a->sine * b->cosine, a->cosine * b->cosine + a->sine * b->sine);
        }
        if (i <= SINGLE) change = add_change(panel->naming, &found);
        for (int side = 0; change >= 0 && side < 2; side++)
            if (body->exists[side]) take(panel->naming, panel->view->rect, &body->box[side], AROUND, change);
        if (i < SINGLE || i == count - 1) drop_empty(panel->naming, change);
    }
    free(moved);
    return true;
}

/* Bodies whose pixels differ although their states do not: those with the most unknown pixels one by one, as what is
   around them is their edge, also where it lies on others; then the others: their number, or the only one. */
static void name_changed(Panel *panel) {
    paint_tops(panel);
    for (int named = 0; named <= CHANGED; named++) {
        const ViewRect rect = clip(panel->naming, panel->view->rect);
        int most = -1, count = 0;
        for (int i = 0; i < panel->count; i++) panel->bodies[i].pixels = 0;
        for (int y = rect.top; y < rect.bottom; y++) {
            const uint8_t *const owners = panel->naming->owners + (size_t)y * panel->naming->width;
            const int32_t *const tops = panel->naming->tops + (size_t)y * panel->naming->width;
            for (int x = rect.left; x < rect.right; x++)
                if (owners[x] == OWNER_UNKNOWN && tops[x] >= 0 && tops[x] < panel->count)
                    panel->bodies[tops[x]].pixels++;
        }
        for (int i = 0; i < panel->count; i++) {
            count += panel->bodies[i].pixels > 0;
            if (panel->bodies[i].pixels > (most < 0 ? 0 : panel->bodies[most].pixels)) most = i;
        }
        if (most < 0) return;
        const bool others = named == CHANGED;
        Change found = change_of(panel, &panel->bodies[most], CHANGE_OTHER);
        if (others && count > 1) found.subject = SUBJECT_BODIES, found.body = count;
        const int change = add_change(panel->naming, &found);
        if (change < 0) return;
        for (int i = 0; i < panel->count; i++)
            if (others ? panel->bodies[i].pixels > 0 : i == most)
                take(panel->naming, panel->view->rect, &panel->bodies[i].box[0], AROUND, change);
        drop_empty(panel->naming, change);
    }
}

/* Names the bodies of a panel: those whose states differ, then those whose pixels do. They must be known. */
static bool name_bodies(Naming *naming, int number, Error *error) {
    const Trajectory *expected = naming->scene->runs[number][0], *actual = naming->scene->runs[number][1];
    Panel panel = {naming, number, &naming->scene->view->panels[number], .runs = {expected, actual}};
    panel.bodies = calloc((size_t)expected->bodies + 1, sizeof *panel.bodies);
    if (panel.bodies == NULL) return error_memory(error, "regions");
    double area = 0;
    for (Layer layer = LAYER_STATIC; layer < LAYERS; layer++)
        for (int body = 0; body < expected->bodies; body++) {
            if (layer_of(expected, body) != layer) continue;
            Drawn drawn = {.index = body};
            for (int side = 0; side < 2; side++)
                drawn.exists[side] = place(&panel, panel.runs[side], body, &drawn.box[side]);
            if (drawn.exists[0] != drawn.exists[1]) drawn.moved = INFINITY;
            if (drawn.exists[0] && drawn.exists[1]) {
                const DrawnBox *a = &drawn.box[0], *b = &drawn.box[1];
                drawn.moved = hypot(b->x - a->x, b->y - a->y) +
                              hypot(a->half_width, a->half_height) * hypot(b->cosine - a->cosine, b->sine - a->sine);
            }
            if (drawn.exists[0] || drawn.exists[1]) panel.bodies[panel.count++] = drawn;
            const ViewRect rect = bounds(&drawn.box[0], 1, panel.view->rect);
            if (drawn.exists[0]) area += (double)(rect.right - rect.left) * (rect.bottom - rect.top);
        }
    const ViewRect whole = panel.view->rect;
    const bool usable = area <= PAINTED_MAX * (double)(whole.right - whole.left) * (whole.bottom - whole.top);
    const bool ok = !usable || name_moved(&panel, error);
    if (usable && ok) name_changed(&panel);
    free(panel.bodies);
    return ok;
}

static void name_all(Naming *naming, Error *error) {
    static const ChangeSubject subjects[] = {SUBJECT_HEADER, SUBJECT_CAPTION, SUBJECT_AXIS, SUBJECT_LEGEND,
                                             SUBJECT_TIMELINE};
    const NamingScene *scene = naming->scene;
    const FrameView *view = scene->view;
    bool known[VIEW_PANELS_MAX];
    for (int i = 0; i < view->part_count; i++)
        name_rectangle(naming, view->parts[i].rect, subjects[view->parts[i].kind], view->parts[i].panel);
    for (int i = 0; i < view->panel_count; i++) {
        known[i] = !view->follows && scene->runs[i][0] != NULL && scene->runs[i][1] != NULL;
        if (known[i] && !name_bodies(naming, i, error)) return;
    }
    for (int i = 0; i < view->panel_count; i++) {
        const ViewRect rect = view->panels[i].rect,
                       around = {rect.left - BORDER, rect.top - BORDER, rect.right + BORDER, rect.bottom + BORDER};
        if (!known[i]) take(naming, rect, NULL, 0, -1); /* a body may be what changed */
        name_rectangle(naming, around, view->marks ? SUBJECT_MARKS : SUBJECT_BACKGROUND, i + 1);
    }
    name_rectangle(naming, (ViewRect){0, 0, view->width, view->height}, SUBJECT_PAGE, 0);
    /* A region gets the change of one thing, not of several bodies, that has most of its pixels. */
    FrameChanges *changes = naming->changes;
    for (int region = 0; region < changes->regions.kept; region++) {
        const ImageRegion *r = &changes->regions.list[region];
        int64_t pixels[CHANGES_MAX] = {0};
        int best = -1, others = -1;
        for (int y = r->top; y < r->bottom; y++) {
            const uint8_t *const row = naming->owners + (size_t)y * naming->width;
            for (int x = r->left; x < r->right; x++)
                if (row[x] >= OWNER_FIRST) pixels[row[x] - OWNER_FIRST]++;
        }
        for (int i = 0; i < changes->count; i++) {
            const bool several = changes->list[i].subject == SUBJECT_BODIES,
                       best_several = best >= 0 && changes->list[best].subject == SUBJECT_BODIES;
            if (pixels[i] == 0) continue;
            others++;
            if (best < 0 || (several != best_several ? best_several : pixels[i] > pixels[best])) best = i;
        }
        changes->region_change[region] = (int16_t)best;
        changes->region_others[region] = (int16_t)(others > 0 ? others : 0);
    }
}

bool naming_find(const NamingScene *scene, uint8_t *levels, const ImageDifference *difference, FrameChanges *changes,
                 Error *error) {
    const size_t width = (size_t)scene->view->width, pixels = width * (size_t)scene->view->height;
    const ViewRect inside = {difference->left, difference->top, difference->right, difference->bottom};
    Naming naming = {scene, width, inside, .owners = levels, .changes = changes};
    changes->count = 0;
    memset(changes->region_change, -1, sizeof changes->region_change);
    memset(changes->region_others, 0, sizeof changes->region_others);
    naming.tops = malloc(pixels * sizeof *naming.tops);
    if (naming.tops == NULL) return error_memory(error, "regions");
    for (int y = inside.top; y < inside.bottom; y++) {
        uint8_t *const row = levels + (size_t)y * width;
        for (int x = inside.left; x < inside.right; x++) row[x] = row[x] > 0 ? OWNER_UNKNOWN : OWNER_NONE;
    }
    name_all(&naming, error);
    free(naming.tops);
    return error->kind == ERROR_NONE;
}
