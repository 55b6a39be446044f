/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/camera.h"

#include <math.h>
#include <stdbool.h>

/* Metres; a body farther away is ignored, or the others would be too small. */
static const double MAX_COORDINATE = 1e5;
static const double MARGIN = 0.07;       /* around the bodies / the larger side */
static const double MIN_SIDE = 2.0;      /* m */
static const double MIN_VIEW = 1e-3;     /* m; the smallest view that a scene may set */
static const double GROUND_SHARE = 0.05; /* relative to the panel's height: the most that spare height adds below */
static const double WHOLE_SCALE = 12.0;  /* from here on, rounding to whole pixels per metre costs little */

typedef struct Bounds {
    double left, right, bottom, top;
} Bounds;

static const Bounds NOTHING = {HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};

static bool is_empty(const Bounds *b) { return !(b->left <= b->right && b->bottom <= b->top); }

static void include(Bounds *all, const Bounds *b) {
    all->left = fmin(all->left, b->left), all->right = fmax(all->right, b->right);
    all->bottom = fmin(all->bottom, b->bottom), all->top = fmax(all->top, b->top);
}

static Bounds body_bounds(const Trajectory *trajectory, int frame, int body) {
    size_t i = (size_t)frame * (size_t)trajectory->bodies + (size_t)body;
    double x = trajectory->position[i].x, y = trajectory->position[i].y, angle = trajectory->angle[i];
    double c = fabs(cos(angle)), s = fabs(sin(angle));
    double half_x = trajectory->size[body].x / 2.0, half_y = trajectory->size[body].y / 2.0;
    double reach_x = c * half_x + s * half_y, reach_y = s * half_x + c * half_y;
    if (!(fabs(x) + reach_x < MAX_COORDINATE && fabs(y) + reach_y < MAX_COORDINATE))
        return NOTHING; /* also true for NaN */
    return (Bounds){x - reach_x, x + reach_x, y - reach_y, y + reach_y};
}

/* The bounds of the dynamic bodies over the whole run. */
static Bounds dynamic_bounds(const Trajectory *trajectory) {
    Bounds all = NOTHING;
    for (int frame = 0; frame < trajectory->frames; frame++)
        for (int body = 0; body < trajectory->bodies; body++) {
            if (trajectory->fixed[body]) continue;
            Bounds b = body_bounds(trajectory, frame, body);
            if (!is_empty(&b)) include(&all, &b);
        }
    return all;
}

static Bounds fixed_bounds(const Trajectory *trajectory) {
    Bounds all = NOTHING;
    for (int body = 0; body < trajectory->bodies; body++) {
        Bounds b = body_bounds(trajectory, 0, body);
        if (trajectory->fixed[body] && !is_empty(&b)) include(&all, &b);
    }
    return all;
}

/* The dynamic bodies and a margin; below, a third of it is enough. */
static Bounds fitted_bounds(const Trajectory *trajectory) {
    Bounds all = dynamic_bounds(trajectory);
    if (is_empty(&all)) all = fixed_bounds(trajectory);
    if (is_empty(&all)) all = (Bounds){0, 0, 0, 0};
    double margin = MARGIN * fmax(fmax(all.right - all.left, all.top - all.bottom), MIN_SIDE);
    return (Bounds){all.left - margin, all.right + margin, all.bottom - margin / 3, all.top + margin};
}

static double nice_scale(double scale) {
    if (scale >= WHOLE_SCALE) return floor(scale);
    return scale >= 1 ? floor(scale * 64) / 64 : scale;
}

static Camera look_at(double x, double y, double scale, int width, int height) {
    return (Camera){scale, rint(width / 2.0 - scale * x), rint(height / 2.0 + scale * y)};
}

static bool has_view(const Trajectory *trajectory) {
    Vec2 size = trajectory->camera_size, center = trajectory->camera_center;
    return size.x >= MIN_VIEW && size.y >= MIN_VIEW && size.x < MAX_COORDINATE && size.y < MAX_COORDINATE &&
           fabs(center.x) < MAX_COORDINATE && fabs(center.y) < MAX_COORDINATE;
}

Camera camera_fit(const Trajectory *trajectory, int width, int height) {
    if (has_view(trajectory)) {
        Vec2 view = trajectory->camera_size;
        double scale = nice_scale(fmin(width / (double)view.x, height / (double)view.y));
        return look_at(trajectory->camera_center.x, trajectory->camera_center.y, scale, width, height);
    }
    Bounds b = fitted_bounds(trajectory);
    double scale = nice_scale(fmin(width / (b.right - b.left), height / (b.top - b.bottom)));
    /* Spare height goes above: sky distracts less than ground. */
    double spare = height / scale - (b.top - b.bottom);
    double below = fmin(spare / 2, GROUND_SHARE * height / scale);
    return look_at((b.left + b.right) / 2, b.bottom - below + height / scale / 2, scale, width, height);
}
