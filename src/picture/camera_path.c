/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is wanted jumps: all of it, then the bomb. Averaged three times over the frames around each it becomes smooth, in
   speed and in acceleration, and looks ahead. */
#include "picture/camera_path.h"

#include "picture/extent.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double AVERAGED = 0.4;      /* s, that one averaging reaches over */
static const double BOMB_AVERAGED = 0.2; /* the same where what is followed is fast */
static const double BEFORE = 0.7;        /* s before the divergence that the way there is to begin */
static const double STAYS = 1.2;         /* s that the camera stays there */
static const double CLOSER = 0.5;        /* of the whole view's size: the one that follows the bomb */
static const double BODIES_SEEN = 6;     /* a close view is at least so many of its body's sides wide and high */
static const double MOST_REACH = 500;    /* frames; or tiny steps would take long */
enum { PASSES = 3 };

/* What a camera sees; unlike pixels, this can be averaged. */
typedef struct View {
    double x, y; /* m, the middle */
    double size; /* m, of a pixel */
} View;

static View view_of(const Camera *camera, int width, int height) {
    return (View){(width / 2.0 - camera->left) / camera->scale, (camera->top - height / 2.0) / camera->scale,
                  1 / camera->scale};
}

static Camera camera_of(const View *view, int width, int height) {
    double scale = 1 / view->size;
    return (Camera){scale, width / 2.0 - scale * view->x, height / 2.0 + scale * view->y};
}

/* A closer view of a point, that shows no more below than the whole one does: more ground tells nothing. */
static View close_view(const View *whole, double x, double y, double size, int height) {
    size = fmin(size, whole->size);
    double bottom = whole->y - whole->size * height / 2;
    return (View){x, fmax(y, bottom + size * height / 2), size};
}

static double least_size(const Trajectory *run, int body, int width, int height) {
    double side = fmax((double)run->size[body].x, (double)run->size[body].y);
    return BODIES_SEEN * side / (width < height ? width : height);
}

static void want_bomb(View *views, const Trajectory *run, int frames, const View *whole, int width, int height) {
    double size = fmax(CLOSER * whole->size, least_size(run, run->bomb, width, height));
    View wanted = *whole;
    for (int frame = 0; frame < frames; frame++) {
        if (frame < run->frames && trajectory_has(run, frame, run->bomb)) {
            Vec2 at = run->position[(size_t)frame * (size_t)run->bodies + (size_t)run->bomb];
            if (fabs((double)at.x) < EXTENT_FARTHEST && fabs((double)at.y) < EXTENT_FARTHEST)
                wanted = close_view(whole, (double)at.x, (double)at.y, size, height);
        }
        views[frame] = wanted;
    }
}

static void want_divergence(View *views, const Trajectory *run, int frames, const Events *events, const View *whole,
                            int width, int height) {
    int first = events->apart - (int)rint(BEFORE / (double)run->dt);
    int last = events->apart + (int)rint(STAYS / (double)run->dt);
    Vec2 at = run->position[(size_t)events->apart * (size_t)run->bodies + (size_t)events->body];
    double size = least_size(run, events->body, width, height);
    for (int frame = 0; frame < frames; frame++)
        views[frame] =
            frame < first || frame > last ? *whole : close_view(whole, (double)at.x, (double)at.y, size, height);
}

/* Before the first frame and after the last all is as there. */
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
    double reach = fmin(fmin(steps / 2, frames), MOST_REACH);
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
    if (kind == LOOK_BOMB && runs[0]->bomb >= 0) want_bomb(views, runs[0], frames, &whole, width, height);
    if (kind == LOOK_DIVERGENCE && events->apart >= 0)
        want_divergence(views, runs[0], frames, events, &whole, width, height);
    double averaged = kind == LOOK_BOMB ? BOMB_AVERAGED : AVERAGED;
    smooth(views, views + frames, frames, averaged / (double)runs[0]->dt);
    for (int frame = 0; frame < frames; frame++) path[frame] = camera_of(&views[frame], width, height);
    free(views);
    return path;
}

Camera camera_at(const Camera *path, int frames, Moment moment, int width, int height) {
    if (!(moment.part > 0) || moment.frame + 1 >= frames) return path[moment.frame];
    View a = view_of(&path[moment.frame], width, height), b = view_of(&path[moment.frame + 1], width, height);
    View between = {a.x + moment.part * (b.x - a.x), a.y + moment.part * (b.y - a.y),
                    a.size + moment.part * (b.size - a.size)};
    return camera_of(&between, width, height);
}
