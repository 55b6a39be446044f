/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/camera.h"

#include "picture/framing.h"

#include <math.h>

static const double MARGIN = 0.07;       /* of the larger side, around what is fitted */
static const double LONGEST = 6;         /* shorter sides: a longer side has no wider margin, or it would be all */
static const double MIN_SIDE = 2.0;      /* m */
static const double MIN_VIEW = 1e-3;     /* m; the smallest view that can be set */
static const double GROUND_SHARE = 0.05; /* of the panel's height, at most, that spare room adds below */
static const double WHOLE_SCALE = 12.0;  /* from here on a whole number of pixels a metre costs little room */

static double nice_scale(double scale) {
    if (scale >= WHOLE_SCALE) return floor(scale);
    return scale >= 1 ? floor(scale * 64) / 64 : scale;
}

static Camera look_at(double x, double y, double scale, int width, int height) {
    return (Camera){scale, rint(width / 2.0 - scale * x), rint(height / 2.0 + scale * y)};
}

bool camera_view_is_usable(const CameraView *view) {
    return view->width >= MIN_VIEW && view->height >= MIN_VIEW && view->width < EXTENT_FARTHEST &&
           view->height < EXTENT_FARTHEST && fabs(view->x) < EXTENT_FARTHEST && fabs(view->y) < EXTENT_FARTHEST;
}

bool camera_view_of(const Trajectory *run, CameraView *view) {
    const Vec2 size = run->camera_size, center = run->camera_center;
    *view = (CameraView){(double)center.x, (double)center.y, (double)size.x, (double)size.y};
    return camera_view_is_usable(view);
}

Camera camera_show(const CameraView *view, int width, int height) {
    return look_at(view->x, view->y, nice_scale(fmin(width / view->width, height / view->height)), width, height);
}

/* With a margin; a narrow one below, where a strip of the ground is enough. */
static Extent add_margin(const Extent *b) {
    const double shorter = fmin(b->right - b->left, b->top - b->bottom);
    double margin = MARGIN * fmax(fmin(extent_side(b), LONGEST * shorter), MIN_SIDE);
    return (Extent){b->left - margin, b->right + margin, b->bottom - margin / 3, b->top + margin};
}

CameraFrame camera_frame(const Trajectory *run) {
    CameraView set;
    if (camera_view_of(run, &set))
        return (CameraFrame){.set = true,
                             .left = set.x - set.width / 2,
                             .right = set.x + set.width / 2,
                             .bottom = set.y - set.height / 2,
                             .top = set.y + set.height / 2,
                             .middle = set.x};
    const Framing framing = framing_of(run);
    const Extent b = add_margin(&framing.extent);
    return (CameraFrame){.left = b.left, .right = b.right, .bottom = b.bottom, .top = b.top, .middle = framing.middle};
}

Vec2 camera_needs(const Trajectory *run) {
    CameraView set;
    if (camera_view_of(run, &set)) return vec2((float)set.width, (float)set.height);
    const CameraFrame b = camera_frame(run);
    return vec2((float)(b.right - b.left), (float)(b.top - b.bottom));
}

Camera camera_fit(const Trajectory *run, int width, int height) {
    CameraView set;
    if (camera_view_of(run, &set)) return camera_show(&set, width, height);
    const CameraFrame b = camera_frame(run);
    double scale = nice_scale(fmin(width / (b.right - b.left), height / (b.top - b.bottom)));
    /* Spare width goes to both sides of what stands, spare height above: sky distracts less than ground. */
    double half = width / scale / 2, x = fmin(fmax(b.middle, b.right - half), b.left + half);
    double spare = height / scale - (b.top - b.bottom);
    double below = fmin(spare / 2, GROUND_SHARE * height / scale);
    return look_at(x, b.bottom - below + height / scale / 2, scale, width, height);
}
