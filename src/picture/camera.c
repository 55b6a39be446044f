/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/camera.h"

#include "picture/extent.h"

#include <math.h>

static const double MARGIN = 0.07;       /* of the larger side, around what is fitted */
static const double MIN_SIDE = 2.0;      /* m */
static const double MIN_VIEW = 1e-3;     /* m; the smallest view that a scene may set */
static const double GROUND_SHARE = 0.05; /* of the panel's height, at most, that spare room adds below */
static const double WHOLE_SCALE = 12.0;  /* from here on a whole number of pixels a metre costs little room */

/* The dynamic bodies in all frames. */
static Extent dynamic_extent(const Trajectory *trajectory) {
    Extent all = extent_empty;
    for (int frame = 0; frame < trajectory->frames; frame++)
        for (int body = 0; body < trajectory->bodies; body++)
            if (!trajectory->fixed[body]) extent_include(&all, trajectory, frame, body);
    return all;
}

static Extent fixed_extent(const Trajectory *trajectory) {
    Extent all = extent_empty;
    for (int body = 0; body < trajectory->bodies; body++)
        if (trajectory->fixed[body]) extent_include(&all, trajectory, 0, body);
    return all;
}

/* The dynamic bodies and a margin; a narrow one below, where a strip of their ground is enough. */
static Extent fitted_extent(const Trajectory *trajectory) {
    Extent all = dynamic_extent(trajectory);
    if (extent_is_empty(&all)) all = fixed_extent(trajectory);
    if (extent_is_empty(&all)) all = (Extent){0, 0, 0, 0};
    double margin = MARGIN * fmax(fmax(all.right - all.left, all.top - all.bottom), MIN_SIDE);
    return (Extent){all.left - margin, all.right + margin, all.bottom - margin / 3, all.top + margin};
}

static double nice_scale(double scale) {
    if (scale >= WHOLE_SCALE) return floor(scale);
    return scale >= 1 ? floor(scale * 64) / 64 : scale;
}

static Camera look_at(double x, double y, double scale, int width, int height) {
    return (Camera){scale, rint(width / 2.0 - scale * x), rint(height / 2.0 + scale * y)};
}

bool camera_is_set(const Trajectory *trajectory) {
    Vec2 size = trajectory->camera_size, center = trajectory->camera_center;
    return size.x >= MIN_VIEW && size.y >= MIN_VIEW && size.x < EXTENT_FARTHEST && size.y < EXTENT_FARTHEST &&
           fabsf(center.x) < EXTENT_FARTHEST && fabsf(center.y) < EXTENT_FARTHEST;
}

Camera camera_fit(const Trajectory *trajectory, int width, int height) {
    if (camera_is_set(trajectory)) {
        Vec2 set = trajectory->camera_size;
        double scale = nice_scale(fmin(width / (double)set.x, height / (double)set.y));
        return look_at(trajectory->camera_center.x, trajectory->camera_center.y, scale, width, height);
    }
    Extent b = fitted_extent(trajectory);
    double scale = nice_scale(fmin(width / (b.right - b.left), height / (b.top - b.bottom)));
    /* Spare height goes above: sky distracts less than ground. */
    double spare = height / scale - (b.top - b.bottom);
    double below = fmin(spare / 2, GROUND_SHARE * height / scale);
    return look_at((b.left + b.right) / 2, b.bottom - below + height / scale / 2, scale, width, height);
}
