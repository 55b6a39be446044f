/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A panel of a picture as naming sees it: its bodies as drawn, what is on top, and the pixels that tell of one body. */
#include "base/base.h"
#include "regression/compare.h"
#include "regression/internal.h"
#include "regression/naming.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PAINTED_MAX = 64 /* times the panel, by all bodies */ };

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

BodyLayer panel_layer(const Trajectory *run, int body) {
    return body == run->bomb ? LAYER_BOMB : run->fixed[body] ? LAYER_STATIC : LAYER_DYNAMIC;
}

static void add_layer(Panel *panel, BodyLayer wanted) {
    const Trajectory *expected = panel->runs[0], *actual = panel->runs[1];
    for (int body = 0; body < expected->bodies; body++) {
        if (panel_layer(expected, body) != wanted) continue;
        Drawn drawn = {.index = body};
        drawn.exists[0] = place(panel, expected, body, &drawn.box[0]);
        drawn.exists[1] = place(panel, actual, body, &drawn.box[1]);
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

/* The width of an outline, at most (pictures/parts.c). */
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
    panel->pixels = malloc(sizeof *panel->pixels);
    if (panel->bodies == NULL || panel->pixels == NULL) return error_memory(error, "regions");
    for (BodyLayer layer = LAYER_STATIC; layer < LAYERS; layer++) add_layer(panel, layer);
    *usable = paint_tops(panel);
    return true;
}

void panel_close(Panel *panel) {
    free(panel->bodies);
    free(panel->pixels);
}

/* Which pixels tell what happened to a body. */

static const double NEAR = 1.5; /* pixels beyond its edge where other bodies hide what is behind it */
static const double REACH = 3;  /* pixels beyond its edge that a fit takes in any case */

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
            size_t pixel = panel_pixel(panel, x, y);
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
            int top = panel->naming->tops[panel_pixel(panel, u, v)];
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
        colour_at(panel->naming->pictures[0], panel_pixel(panel, u, v), colour);
    }
}

/* Adds the pixel to those of a fit unless it says nothing about the body. */
static void add_pixel(Panel *panel, int self, int x, int y, const double background[3]) {
    const Naming *naming = panel->naming;
    const BoxModel *box = &panel->bodies[self].box[0];
    size_t at = panel_pixel(panel, x, y);
    double distance = box_distance(box, x + 0.5, y + 0.5), after[3];
    if (naming->tops[at] > self) return; /* a body drawn later hides it */
    if (distance > REACH && naming->owners[at] == OWNER_NONE) return;
    if (distance > -0.5 && distance < NEAR && is_crowded(panel, x, y, self)) return;
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

static ViewRect join(ViewRect a, ViewRect b) {
    return (ViewRect){a.left < b.left ? a.left : b.left, a.top < b.top ? a.top : b.top,
                      a.right > b.right ? a.right : b.right, a.bottom > b.bottom ? a.bottom : b.bottom};
}

/* Takes every n-th row if there are too many pixels. */
void panel_collect(Panel *panel, int self, ViewRect changed) {
    const BoxModel *box = &panel->bodies[self].box[0];
    const ViewRect rect = join(changed, panel_bounds(panel, box, REACH));
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
