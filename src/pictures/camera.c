/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cameras: the path of a moving one, and the fixed one (runs/framing.h).

   The target view of a path jumps: first the whole scene, then the bomb. Three passes of a moving average, centred on
   each frame, make speed and acceleration continuous and let the camera anticipate. */
#include "base/base.h"
#include "engine/engine.h"
#include "pictures/pictures_internal.h"
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

Camera *camera_path(const Trajectory *const *runs, int frames, LookCamera kind, const Events *events, const Camera *fit,
                    int width, int height, Error *error) {
    const Trajectory *run = runs[0];
    const double dt = (double)run->dt;
    View *views = calloc((size_t)frames, 2 * sizeof *views);
    const View whole = view_of(fit, width, height);
    Camera *path = calloc((size_t)frames, sizeof *path);
    if (views == NULL || path == NULL) {
        free(views);
        free(path);
        error_memory(error, "render");
        return NULL;
    }

    /* The view that is wanted in each frame: near the bomb, or near the divergence for some time around it. */
    for (int frame = 0; frame < frames; frame++) views[frame] = whole;
    if (kind == LOOK_BOMB && run->bomb >= 0) {
        const double size = fmax(BOMB_VIEW * whole.size, min_size(run, run->bomb, width, height));
        View target = whole;
        for (int frame = 0; frame < frames; frame++) {
            const bool there = frame < run->frames && trajectory_has(run, frame, run->bomb);
            const Vec2 at = there ? run->position[trajectory_at(run, frame, run->bomb)] : vec2(0, 0);
            if (there && fabs((double)at.x) < EXTENT_FARTHEST && fabs((double)at.y) < EXTENT_FARTHEST)
                target = close_view(&whole, (double)at.x, (double)at.y, size, height);
            views[frame] = target;
        }
    }
    if (kind == LOOK_DIVERGENCE && events->divergence >= 0) {
        const int first = events->divergence - (int)rint(LEAD_TIME / dt),
                  last = events->divergence + (int)rint(HOLD_TIME / dt);
        const Vec2 at = run->position[trajectory_at(run, events->divergence, events->body)];
        const double size = min_size(run, events->body, width, height);
        for (int frame = first > 0 ? first : 0; frame < frames && frame <= last; frame++)
            views[frame] = close_view(&whole, (double)at.x, (double)at.y, size, height);
    }

    View *spare = views + frames;
    const double steps = (kind == LOOK_BOMB ? BOMB_SMOOTHING : SMOOTHING) / dt;
    const int reach = (int)rint(fmin(fmin(steps / 2, frames), MAX_REACH));
    for (int i = 0; i < PASSES; i++) {
        average(spare, views, frames, reach);
        memcpy(views, spare, (size_t)frames * sizeof *views);
    }
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

static Camera look_at(double x, double y, double scale, int width, int height) {
    return (Camera){scale, rint(width / 2.0 - scale * x), rint(height / 2.0 + scale * y)};
}

Vec2 camera_needs(const CameraFrame *frame) {
    return vec2((float)(frame->room.right - frame->room.left), (float)(frame->held.top - frame->held.bottom));
}

Camera camera_fit(const CameraFrame *frame, int width, int height) {
    const Extent *held = &frame->held, *room = &frame->room;
    const double high = held->top - held->bottom, largest = fmin(width / (held->right - held->left), height / high);
    const double all = width / (frame->action.right - frame->action.left);
    double scale = fmin(largest, fmax(all, LEAST_SCALE * largest));
    if (scale >= WHOLE_SCALE)
        scale = floor(scale);
    else if (scale >= 1)
        scale = floor(scale * SCALE_PARTS) / SCALE_PARTS;
    if (frame->set) return look_at(frame->middle, (held->bottom + held->top) / 2, scale, width, height);
    /* Spare width goes to both sides of what stands, then to where it falls; spare height above: sky distracts less
       than ground. */
    const double half = width / scale / 2, reach = fmax(half, (room->right - room->left) / 2);
    const double falls = fmin(fmax(frame->middle, room->right - reach), room->left + reach);
    const double x = fmin(fmax(falls, held->right - half), held->left + half);
    const double below = fmin((height / scale - high) / 2, FRAMING_GROUND * height / scale);
    return look_at(x, held->bottom - below + height / scale / 2, scale, width, height);
}
