/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A panel of a picture as naming sees it: its bodies as drawn, and what is on top. */
#include "base/base.h"
#include "regression/compare.h"
#include "regression/regression_internal.h"
#include "regression/naming.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PAINTED_MAX = 64 /* times the panel, by all bodies */ };

/* Position from the centre along the local axes; `up` along the local top. */
static void to_local(const BoxModel *box, double x, double y, double *along, double *up) {
    *along = box->cosine * (x - box->x) - box->sine * (y - box->y);
    *up = -box->sine * (x - box->x) - box->cosine * (y - box->y);
}

double box_distance(const BoxModel *box, double x, double y) {
    double along, up;
    to_local(box, x, y, &along, &up);
    const double side = fabs(along) - box->half_width, end = fabs(up) - box->half_height;
    return side > 0 && end > 0 ? sqrt(side * side + end * end) : fmax(side, end);
}

void box_bounds(const BoxModel *box, double margin, double bounds[4]) {
    double cosine = fabs(box->cosine), sine = fabs(box->sine);
    double x = cosine * box->half_width + sine * box->half_height + margin;
    double y = sine * box->half_width + cosine * box->half_height + margin;
    bounds[0] = box->x - x, bounds[1] = box->y - y, bounds[2] = box->x + x, bounds[3] = box->y + y;
}

static bool naming_panel_place(const Panel *panel, const Trajectory *run, int body, BoxModel *box) {
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
                      .half_height = scale * (double)run->size[body].y / 2};
    return true;
}

/* The largest movement of a corner. */
static double movement(const BoxModel *a, const BoxModel *b) {
    double reach = sqrt(a->half_width * a->half_width + a->half_height * a->half_height);
    double x = b->x - a->x, y = b->y - a->y, cosine = b->cosine - a->cosine, sine = b->sine - a->sine;
    return sqrt(x * x + y * y) + reach * sqrt(cosine * cosine + sine * sine);
}

BodyLayer panel_layer(const Trajectory *run, int body) {
    return body == run->bomb ? LAYER_BOMB : run->fixed[body] ? LAYER_STATIC : LAYER_DYNAMIC;
}

static void add_layer(Panel *panel, BodyLayer wanted) {
    const Trajectory *expected = panel->runs[0], *actual = panel->runs[1];
    for (int body = 0; body < expected->bodies; body++) {
        if (panel_layer(expected, body) != wanted) continue;
        Drawn drawn = {.index = body};
        drawn.exists[0] = naming_panel_place(panel, expected, body, &drawn.box[0]);
        drawn.exists[1] = naming_panel_place(panel, actual, body, &drawn.box[1]);
        if (drawn.exists[0] != drawn.exists[1]) drawn.moved = INFINITY;
        if (drawn.exists[0] && drawn.exists[1]) drawn.moved = movement(&drawn.box[0], &drawn.box[1]);
        if (drawn.exists[0] || drawn.exists[1]) panel->bodies[panel->count++] = drawn;
    }
}

/* The part of a box's bounds that is in the panel; empty if right <= left. */
static ViewRect panel_bounds(const Panel *panel, const BoxModel *box, double margin) {
    double bounds[4];
    ViewRect rect = panel->view->rect;
    box_bounds(box, margin, bounds);
    if (bounds[0] > rect.left) rect.left = (int)fmin(floor(bounds[0]), rect.right);
    if (bounds[1] > rect.top) rect.top = (int)fmin(floor(bounds[1]), rect.bottom);
    if (bounds[2] < rect.right) rect.right = (int)fmax(ceil(bounds[2]), rect.left);
    if (bounds[3] < rect.bottom) rect.bottom = (int)fmax(ceil(bounds[3]), rect.top);
    return rect;
}

size_t panel_pixel(const Panel *panel, int x, int y) {
    return (size_t)y * (size_t)panel->naming->scene->view->width + (size_t)x;
}

/* The width of an outline, at most (pictures/bodies.c). */
static double outline_reach(const Panel *panel) {
    const ViewRect *rect = &panel->view->rect;
    return 3 + 0.008 * fmin(rect->right - rect->left, rect->bottom - rect->top);
}

/* Outlines of other runs are above all bodies. */
static void paint_outlines(const Panel *panel, const Trajectory *run) {
    const double reach = outline_reach(panel);
    for (int body = 0; body < run->bodies; body++) {
        BoxModel box;
        if (run->fixed[body] || !naming_panel_place(panel, run, body, &box)) continue;
        ViewRect rect = panel_bounds(panel, &box, 1);
        for (int y = rect.top; y < rect.bottom; y++)
            for (int x = rect.left; x < rect.right; x++) {
                double distance = box_distance(&box, x + 0.5, y + 0.5);
                if (distance < 0.5 && distance > -reach) panel->naming->tops[panel_pixel(panel, x, y)] = panel->count;
            }
    }
}

/* Paints the expected bodies into `tops`, half a pixel larger: with their smoothed edges. False if bodies so large and
   many are no picture of a scene. */
static bool paint_tops(const Panel *panel) {
    const ViewRect whole = panel->view->rect;
    int64_t painted = 0, most = PAINTED_MAX * (int64_t)(whole.right - whole.left) * (whole.bottom - whole.top);
    for (int y = whole.top; y < whole.bottom; y++)
        for (int x = whole.left; x < whole.right; x++) panel->naming->tops[panel_pixel(panel, x, y)] = -1;
    for (int i = 0; i < panel->count && painted <= most; i++) {
        const BoxModel *box = &panel->bodies[i].box[0];
        if (!panel->bodies[i].exists[0]) continue;
        ViewRect rect = panel_bounds(panel, box, 1);
        painted += (int64_t)(rect.right - rect.left) * (rect.bottom - rect.top);
        for (int y = rect.top; y < rect.bottom; y++)
            for (int x = rect.left; x < rect.right; x++)
                if (box_distance(box, x + 0.5, y + 0.5) < 0.5) panel->naming->tops[panel_pixel(panel, x, y)] = i;
    }
    for (int i = 0; painted <= most && i < panel->view->outline_count; i++)
        if (panel->naming->scene->outlines[panel->number][i] != NULL)
            paint_outlines(panel, panel->naming->scene->outlines[panel->number][i]);
    return painted <= most;
}

bool panel_open(Panel *panel, Naming *naming, int number, bool *usable, Error *error) {
    *panel = (Panel){naming, number, &naming->scene->view->panels[number],
                     .runs = {naming->scene->runs[number][0], naming->scene->runs[number][1]}};
    panel->bodies = calloc((size_t)panel->runs[0]->bodies + 1, sizeof *panel->bodies);
    if (panel->bodies == NULL) return error_memory(error, "regions");
    for (BodyLayer layer = LAYER_STATIC; layer < LAYERS; layer++) add_layer(panel, layer);
    *usable = paint_tops(panel);
    return true;
}

void panel_close(Panel *panel) { free(panel->bodies); }
