/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cameras: the path of a moving one, what the default one frames, and the fixed one.

   The target view of a path jumps: first the whole scene, then the bomb. Three passes of a moving average, centred on each
   frame, make speed and acceleration continuous and let the camera anticipate. */
#include "base/base.h"
#include "engine/engine.h"
#include "pictures/internal.h"
#include "pictures/picture.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double SMOOTHING = 0.4;      /* s, window of one pass */
static const double BOMB_SMOOTHING = 0.2; /* s, the same for LOOK_BOMB: its target is fast */
static const double LEAD_TIME = 0.7;      /* s before the divergence that the camera starts to move */
static const double HOLD_TIME = 1.2;      /* s that the camera stays there after it */
static const double BOMB_VIEW = 0.5;      /* size of the view that follows the bomb / size of the whole view */
static const double BODY_SIDES = 6;       /* a close view is at least this many sides of its body wide and high */
static const double MAX_REACH = 500;      /* frames; bounds the cost with tiny time steps */
enum { PASSES = 3 };

/* Unlike pixel positions, views can be averaged. */
typedef struct View {
    double x, y; /* m, the centre */
    double size; /* m per pixel */
} View;

static View view_of(const Camera *camera, int width, int height) {
    return (View){(width / 2.0 - camera->left) / camera->scale, (camera->top - height / 2.0) / camera->scale,
                  1 / camera->scale};
}

static Camera camera_of(const View *view, int width, int height) {
    double scale = 1 / view->size;
    return (Camera){scale, width / 2.0 - scale * view->x, height / 2.0 + scale * view->y};
}

/* A closer view of a point. Its bottom is not below that of the whole view: more ground shows nothing. */
static View close_view(const View *whole, double x, double y, double size, int height) {
    size = fmin(size, whole->size);
    double bottom = whole->y - whole->size * height / 2;
    return (View){x, fmax(y, bottom + size * height / 2), size};
}

static double min_size(const Trajectory *run, int body, int width, int height) {
    double side = fmax((double)run->size[body].x, (double)run->size[body].y);
    return BODY_SIDES * side / (width < height ? width : height);
}

static void target_bomb(View *views, const Trajectory *run, int frames, const View *whole, int width, int height) {
    double size = fmax(BOMB_VIEW * whole->size, min_size(run, run->bomb, width, height));
    View target = *whole;
    for (int frame = 0; frame < frames; frame++) {
        if (frame < run->frames && trajectory_has(run, frame, run->bomb)) {
            Vec2 at = run->position[(size_t)frame * (size_t)run->bodies + (size_t)run->bomb];
            if (fabs((double)at.x) < EXTENT_FARTHEST && fabs((double)at.y) < EXTENT_FARTHEST)
                target = close_view(whole, (double)at.x, (double)at.y, size, height);
        }
        views[frame] = target;
    }
}

static void target_divergence(View *views, const Trajectory *run, int frames, const Events *events, const View *whole,
                              int width, int height) {
    int first = events->divergence - (int)rint(LEAD_TIME / (double)run->dt);
    int last = events->divergence + (int)rint(HOLD_TIME / (double)run->dt);
    Vec2 at = run->position[(size_t)events->divergence * (size_t)run->bodies + (size_t)events->body];
    double size = min_size(run, events->body, width, height);
    for (int frame = 0; frame < frames; frame++)
        views[frame] =
            frame < first || frame > last ? *whole : close_view(whole, (double)at.x, (double)at.y, size, height);
}

/* Frames before the first and after the last repeat these two. */
static void average(View *to, const View *from, int frames, int reach) {
    for (int frame = 0; frame < frames; frame++) {
        View sum = {0, 0, 0};
        for (int i = frame - reach; i <= frame + reach; i++) {
            const View *view = &from[i < 0 ? 0 : i < frames ? i : frames - 1];
            sum.x += view->x, sum.y += view->y, sum.size += view->size;
        }
        int count = 2 * reach + 1;
        to[frame] = (View){sum.x / count, sum.y / count, sum.size / count};
    }
}

static void smooth(View *views, View *spare, int frames, double steps) {
    double reach = fmin(fmin(steps / 2, frames), MAX_REACH);
    for (int i = 0; i < PASSES; i++) {
        average(spare, views, frames, (int)rint(reach));
        memcpy(views, spare, (size_t)frames * sizeof *views);
    }
}

Camera *camera_path(const Trajectory *const *runs, int frames, LookCamera kind, const Events *events, const Camera *fit,
                    int width, int height, Error *error) {
    View *views = calloc((size_t)frames, 2 * sizeof *views), whole = view_of(fit, width, height);
    Camera *path = calloc((size_t)frames, sizeof *path);
    if (views == NULL || path == NULL) {
        free(views);
        free(path);
        error_memory(error, "render");
        return NULL;
    }
    for (int frame = 0; frame < frames; frame++) views[frame] = whole;
    if (kind == LOOK_BOMB && runs[0]->bomb >= 0) target_bomb(views, runs[0], frames, &whole, width, height);
    if (kind == LOOK_DIVERGENCE && events->divergence >= 0)
        target_divergence(views, runs[0], frames, events, &whole, width, height);
    double smoothing = kind == LOOK_BOMB ? BOMB_SMOOTHING : SMOOTHING;
    smooth(views, views + frames, frames, smoothing / (double)runs[0]->dt);
    for (int frame = 0; frame < frames; frame++) path[frame] = camera_of(&views[frame], width, height);
    free(views);
    return path;
}

Camera camera_at(const Camera *path, int frames, Moment moment, int width, int height) {
    if (moment.part == 0 || moment.frame + 1 >= frames) return path[moment.frame];
    View a = view_of(&path[moment.frame], width, height), b = view_of(&path[moment.frame + 1], width, height);
    const double fraction = moment_fraction(moment);
    View between = {a.x + fraction * (b.x - a.x), a.y + fraction * (b.y - a.y), a.size + fraction * (b.size - a.size)};
    return camera_of(&between, width, height);
}

const Extent extent_empty = {HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};

static size_t index_of(const Trajectory *run, int frame, int body) {
    return (size_t)frame * (size_t)run->bodies + (size_t)body;
}

bool extent_is_empty(const Extent *extent) { return !(extent->left <= extent->right && extent->bottom <= extent->top); }

double extent_side(const Extent *extent) { return fmax(extent->right - extent->left, extent->top - extent->bottom); }

/* Wider by this on each side. */
static Extent extent_widened(const Extent *extent, double by) {
    return (Extent){extent->left - by, extent->right + by, extent->bottom - by, extent->top + by};
}

void extent_include(Extent *extent, const Trajectory *run, int frame, int body) {
    size_t i = index_of(run, frame, body);
    double x = run->position[i].x, y = run->position[i].y, angle = run->angle[i];
    double c = fabs(cos(angle)), s = fabs(sin(angle));
    double half_x = run->size[body].x / 2.0, half_y = run->size[body].y / 2.0;
    double reach_x = c * half_x + s * half_y, reach_y = s * half_x + c * half_y;
    if (!(fabs(x) + reach_x < EXTENT_FARTHEST && fabs(y) + reach_y < EXTENT_FARTHEST)) return; /* nor for NaN */
    extent->left = fmin(extent->left, x - reach_x), extent->right = fmax(extent->right, x + reach_x);
    extent->bottom = fmin(extent->bottom, y - reach_y), extent->top = fmax(extent->top, y + reach_y);
}

/* Cuts [*first, *last] to the part of the ray at + t * direction inside a slab. */
static void clip_to_slab(double at, double direction, double half, double *first, double *last) {
    double a = (-half - at) / direction, b = (half - at) / direction;
    if (direction == 0) a = -HUGE_VAL, b = fabs(at) <= half ? HUGE_VAL : -HUGE_VAL;
    *first = fmax(*first, fmin(a, b));
    *last = fmin(*last, fmax(a, b));
}

/* The distance straight down from a point to a body; infinite if it is not below. */
static double distance_down(const Trajectory *run, int frame, int body, double x, double y) {
    size_t i = index_of(run, frame, body);
    double dx = x - (double)run->position[i].x, dy = y - (double)run->position[i].y, angle = (double)run->angle[i];
    double c = cos(angle), s = sin(angle), first = 0, last = HUGE_VAL;
    clip_to_slab(c * dx + s * dy, -s, run->size[body].x / 2.0, &first, &last);
    clip_to_slab(c * dy - s * dx, -c, run->size[body].y / 2.0, &first, &last);
    return first <= last ? first : HUGE_VAL;
}

/* Widens it down to the first static body straight below the body's centre, if there is one. */
static void extent_include_ground(Extent *extent, const Trajectory *run, int frame, int body) {
    const Vec2 at = run->position[index_of(run, frame, body)];
    double down = HUGE_VAL;
    for (int other = 0; other < run->bodies; other++)
        if (run->fixed[other]) down = fmin(down, distance_down(run, frame, other, (double)at.x, (double)at.y));
    if (fabs((double)at.y - down) < EXTENT_FARTHEST) extent->bottom = fmin(extent->bottom, (double)at.y - down);
}

/* Whether the body's centre is inside; false for a body without a pose. */
static bool extent_holds(const Extent *extent, const Trajectory *run, int frame, int body) {
    const Vec2 at = run->position[index_of(run, frame, body)];
    return (double)at.x >= extent->left && (double)at.x <= extent->right && (double)at.y >= extent->bottom &&
           (double)at.y <= extent->top;
}

static const double FRAMING_MIN_SIDE = 2.0; /* m, of what stands, for the next two */
/* Sides of what stands, around it. */
static const double BOMB_REACH = 3; /* a bomb farther away is not framed, or it would be all that can be seen */
static const double NEAR = 1;       /* a stack that falls over stays within this */

/* The moving bodies in frame 0 without the bomb, and the ground below them. */
static Extent standing_extent(const Trajectory *run) {
    Extent all = extent_empty;
    for (int body = 0; body < run->bodies; body++)
        if (!run->fixed[body] && body != run->bomb) extent_include(&all, run, 0, body);
    if (extent_is_empty(&all)) return all;
    for (int body = 0; body < run->bodies; body++)
        if (!run->fixed[body] && body != run->bomb) extent_include_ground(&all, run, 0, body);
    return all;
}

static Extent surroundings(const Extent *extent, double sides) {
    return extent_widened(extent, sides * fmax(extent_side(extent), FRAMING_MIN_SIDE));
}

static Extent moving_extent(const Trajectory *run) {
    Extent all = extent_empty;
    for (int frame = 0; frame < run->frames; frame++)
        for (int body = 0; body < run->bodies; body++)
            if (!run->fixed[body]) extent_include(&all, run, frame, body);
    return all;
}

static Extent fixed_extent(const Trajectory *run) {
    Extent all = extent_empty;
    for (int body = 0; body < run->bodies; body++)
        if (run->fixed[body]) extent_include(&all, run, 0, body);
    return all;
}

/* Whether more than half of the poses until the last frame are farther away. */
static bool most_leave(const Extent *region, const Trajectory *run, int last) {
    int64_t inside = 0, all = 0;
    for (int frame = 0; frame <= last; frame++)
        for (int body = 0; body < run->bodies; body++) {
            if (run->fixed[body] || !trajectory_has(run, frame, body)) continue;
            inside += extent_holds(region, run, frame, body);
            all++;
        }
    return 2 * inside < all;
}

static int first_frame_of_bomb(const Trajectory *run) {
    int first = 0;
    while (first + 1 < run->frames && !trajectory_has(run, first, run->bomb)) first++;
    return first;
}

/* The bomb where it appears, and its way to the impact, as far as within reach. */
static void include_bomb(Extent *extent, const Trajectory *run, const Extent *reach, int impact) {
    if (run->bomb < 0) return;
    const int first = first_frame_of_bomb(run);
    for (int frame = first; frame == first || frame <= impact; frame++)
        if (extent_holds(reach, run, frame, run->bomb)) extent_include(extent, run, frame, run->bomb);
}

/* What is struck from the side falls to the far side, about as far as it is high. */
static void include_far_side(Extent *extent, const Extent *standing, const Trajectory *run, const Extent *reach,
                             int impact) {
    if (run->bomb < 0 || impact < 1) return;
    const int last = impact - 1;
    int first = first_frame_of_bomb(run);
    while (first < last && !extent_holds(reach, run, first, run->bomb)) first++;
    if (first >= last) return;
    const Vec2 *from = &run->position[(size_t)first * (size_t)run->bodies + (size_t)run->bomb];
    const Vec2 *to = &run->position[(size_t)last * (size_t)run->bodies + (size_t)run->bomb];
    const double along = (double)to->x - (double)from->x, height = standing->top - standing->bottom;
    if (!(fabs(along) > fabs((double)to->y - (double)from->y))) return;
    if (along > 0)
        extent->right = fmax(extent->right, standing->right + height);
    else
        extent->left = fmin(extent->left, standing->left - height);
}

/* All that the moving bodies reach; without them, the static ones. */
static Framing frame_whole_run(const Trajectory *run) {
    Extent all = moving_extent(run);
    if (extent_is_empty(&all)) all = fixed_extent(run);
    if (extent_is_empty(&all)) all = (Extent){0, 0, 0, 0};
    return (Framing){all, (all.left + all.right) / 2};
}

static Framing framing_of(const Trajectory *run) {
    const int impact = trajectory_impact(run);
    const Extent standing = standing_extent(run);
    if (extent_is_empty(&standing)) return frame_whole_run(run);
    const Extent near = surroundings(&standing, NEAR), reach = surroundings(&standing, BOMB_REACH);
    if (most_leave(&near, run, impact >= 0 ? impact : run->frames - 1)) return frame_whole_run(run);
    Framing framing = {standing, (standing.left + standing.right) / 2};
    include_bomb(&framing.extent, run, &reach, impact);
    include_far_side(&framing.extent, &standing, run, &reach, impact);
    return framing;
}

static Extent extent_in_frames(const Trajectory *run, const int *frames, int count, const Extent *near,
                               const Extent *reach) {
    Extent all = extent_empty;
    for (int i = 0; i < count; i++) {
        const int frame = frames[i] < run->frames ? frames[i] : run->frames - 1;
        for (int body = 0; body < run->bodies; body++) {
            const Extent *region = body == run->bomb ? reach : near;
            if (!run->fixed[body] && (region == NULL || extent_holds(region, run, frame, body)))
                extent_include(&all, run, frame, body);
        }
    }
    return all;
}

Extent framing_in_frames(const Trajectory *run, const int *frames, int count) {
    const Extent standing = standing_extent(run);
    const Extent near = surroundings(&standing, NEAR), reach = surroundings(&standing, BOMB_REACH);
    Extent all = extent_empty;
    if (!extent_is_empty(&standing)) all = extent_in_frames(run, frames, count, &near, &reach);
    if (extent_is_empty(&all)) all = extent_in_frames(run, frames, count, NULL, NULL);
    return extent_is_empty(&all) ? fixed_extent(run) : all;
}

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
