/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which pixels tell what happened to a body. */
#include "naming/naming_panel.h"

#include <math.h>
#include <string.h>

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

ViewRect panel_unknown(const Panel *panel) {
    const ViewRect rect = panel->view->rect;
    ViewRect found = {rect.right, rect.bottom, rect.left, rect.top};
    for (int y = rect.top; y < rect.bottom; y++)
        for (int x = rect.left; x < rect.right; x++) {
            if (panel->naming->owners[panel_pixel(panel, x, y)] != OWNER_UNKNOWN) continue;
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
BodyFit panel_fit(Panel *panel, int self, ViewRect changed) {
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
    collect(panel, self, join(changed, panel_bounds(panel, box, REACH)));
    return body_fit(box, panel->pixels, (const double(*)[2])starts, count);
}
