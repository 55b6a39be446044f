/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part of the world that pictures of a run show. */
#include "runs/framing.h"

#include "base/base.h"
#include "base/json_write.h"
#include "engine/engine.h"
#include "runs/trajectory.h"

#include <math.h>

const Extent extent_empty = {HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};

bool extent_is_empty(const Extent *extent) { return !(extent->left <= extent->right && extent->bottom <= extent->top); }

double extent_side(const Extent *extent) { return fmax(extent->right - extent->left, extent->top - extent->bottom); }

/* Wider by this on each side. */
static Extent extent_widened(const Extent *extent, double by) {
    return (Extent){extent->left - by, extent->right + by, extent->bottom - by, extent->top + by};
}

void extent_include(Extent *extent, const Trajectory *run, int frame, int body) {
    size_t i = trajectory_at(run, frame, body);
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

/* Widens it down to the first static body straight below the body's centre, if there is one from number `first` on
   before `end`. */
static void include_ground(Extent *extent, const Trajectory *run, int frame, int body, int first, int end) {
    const Vec2 at = run->position[trajectory_at(run, frame, body)];
    double down = HUGE_VAL;
    for (int other = first; other < end; other++) {
        if (!run->fixed[other]) continue;
        const size_t i = trajectory_at(run, frame, other);
        const double dx = (double)at.x - (double)run->position[i].x, dy = (double)at.y - (double)run->position[i].y;
        const double c = cos((double)run->angle[i]), s = sin((double)run->angle[i]);
        double near = 0, far = HUGE_VAL;
        clip_to_slab(c * dx + s * dy, -s, run->size[other].x / 2.0, &near, &far);
        clip_to_slab(c * dy - s * dx, -c, run->size[other].y / 2.0, &near, &far);
        if (near <= far) down = fmin(down, near);
    }
    if (fabs((double)at.y - down) < EXTENT_FARTHEST) extent->bottom = fmin(extent->bottom, (double)at.y - down);
}

/* Whether the body's centre is inside; false for a body without a pose. */
static bool extent_holds(const Extent *extent, const Trajectory *run, int frame, int body) {
    const Vec2 at = run->position[trajectory_at(run, frame, body)];
    return (double)at.x >= extent->left && (double)at.x <= extent->right && (double)at.y >= extent->bottom &&
           (double)at.y <= extent->top;
}

static const double FRAMING_MIN_SIDE = 2.0; /* m, of what stands, for the next two */
/* Sides of what stands, around it. */
static const double WAY_REACH = 8; /* where its way is shown */
static const double NEAR = 1;      /* a stack that falls over stays within this */
static const double SETTLED_STEPS = 32;
static const double SAG = 0.9;          /* of its height: what stands higher has not fallen together */
static const double BOMB_MARGIN = 0.1;  /* of its size */
static const double ACTION_STEP = 0.25; /* sides of what stands: in such steps the view follows what happens to it */

/* Whether a body stands in this frame, in a region (NULL: anywhere): it moves, and is not the bomb. */
static bool stands(const Trajectory *run, int frame, int body, const Extent *region) {
    return !run->fixed[body] && body != run->bomb && (region == NULL || extent_holds(region, run, frame, body));
}

static Extent surroundings(const Extent *extent, double sides) {
    return extent_widened(extent, sides * fmax(extent_side(extent), FRAMING_MIN_SIDE));
}

/* The bodies that stand, the ground below them, and static bodies near them that are no larger than all of them
   together, such as the feet of an arch. */
static Extent standing_extent(const Trajectory *run, int frame, const Extent *region) {
    Extent all = extent_empty;
    for (int body = 0; body < run->bodies; body++)
        if (stands(run, frame, body, region)) extent_include(&all, run, frame, body);
    if (extent_is_empty(&all)) return all;
    const double largest = extent_side(&all);
    const Extent near = surroundings(&all, NEAR);
    int first = 0, end = run->bodies; /* of the static ones: of many bodies, most have one ground */
    while (first < end && !run->fixed[first]) first++;
    while (first < end && !run->fixed[end - 1]) end--;
    for (int body = 0; body < run->bodies; body++) {
        if (stands(run, frame, body, region)) include_ground(&all, run, frame, body, first, end);
        if (run->fixed[body] && extent_holds(&near, run, frame, body) &&
            (double)fmaxf(run->size[body].x, run->size[body].y) <= largest)
            extent_include(&all, run, frame, body);
    }
    return all;
}

static Extent fixed_extent(const Trajectory *run) {
    Extent all = extent_empty;
    for (int body = 0; body < run->bodies; body++)
        if (run->fixed[body]) extent_include(&all, run, 0, body);
    return all;
}

int bomb_first_frame(const Trajectory *run) {
    int first = 0;
    while (first + 1 < run->frames && !trajectory_has(run, first, run->bomb)) first++;
    return first;
}

/* Where what stands falls if it is struck: to the far side if the bomb comes from the side, else to both; about as far
   as it is high. */
static Extent room_to_fall(const Trajectory *run, const Extent *standing, int impact) {
    const int first = bomb_first_frame(run), last = impact - 1;
    const double height = standing->top - standing->bottom;
    Extent room = *standing;
    if (first >= last) return room;
    const Vec2 from = run->position[trajectory_at(run, first, run->bomb)],
               to = run->position[trajectory_at(run, last, run->bomb)];
    const double along = (double)to.x - (double)from.x;
    const bool sideways = fabs(along) > fabs((double)to.y - (double)from.y);
    if (!sideways || along > 0) room.right += sideways ? height : height / 2;
    if (!sideways || along < 0) room.left -= sideways ? height : height / 2;
    return room;
}

static Extent bomb_extent(const Trajectory *run, int frame) {
    Extent bomb = extent_empty;
    extent_include(&bomb, run, frame, run->bomb);
    return bomb;
}

static Extent joined(Extent a, const Extent *b) {
    return (Extent){fmin(a.left, b->left), fmax(a.right, b->right), fmin(a.bottom, b->bottom), fmax(a.top, b->top)};
}

static int shown_frame(const Trajectory *run, int frame) { return frame < run->frames ? frame : run->frames - 1; }

static void include_frames(Extent *all, const Trajectory *run, const int *frames, int count, const Extent *near) {
    for (int i = 0; i < count; i++)
        for (int body = 0; body < run->bodies; body++) {
            const int frame = shown_frame(run, frames[i]);
            if (!run->fixed[body] && (near == NULL || extent_holds(near, run, frame, body)))
                extent_include(all, run, frame, body);
        }
}

static bool stays(const Trajectory *run, const int *frames, int count, int body, const Extent *region) {
    bool inside = !run->fixed[body];
    for (int i = 0; i < count && inside; i++) {
        const int frame = shown_frame(run, frames[i]);
        inside = extent_holds(region, run, frame, body) || !trajectory_has(run, frame, body);
    }
    return inside;
}

Extent framing_in_frames(const Trajectory *const *runs, int run_count, const int *frames, int count) {
    const Extent standing = standing_extent(runs[0], 0, NULL);
    const Extent near = surroundings(&standing, NEAR);
    const Extent above = {near.left, near.right, standing.bottom, near.top};
    Extent all = extent_empty;
    if (!extent_is_empty(&standing)) {
        include_frames(&all, runs[0], frames, count, &near);
        /* What flies off or sinks into the ground counts in no frame, or it would make all small; nor does the rest of
           a run most of whose bodies do that. */
        for (int r = 1; r < run_count; r++) {
            const Trajectory *run = runs[r];
            int moving = 0, staying = 0;
            for (int body = 0; body < run->bodies; body++)
                moving += !run->fixed[body], staying += stays(run, frames, count, body, &above);
            for (int body = 0; 2 * staying > moving && body < run->bodies; body++)
                for (int i = 0; i < count && stays(run, frames, count, body, &above); i++)
                    extent_include(&all, run, shown_frame(run, frames[i]), body);
        }
    }
    if (extent_is_empty(&all)) include_frames(&all, runs[0], frames, count, NULL);
    return extent_is_empty(&all) ? fixed_extent(runs[0]) : all;
}

/* How far beyond what stands its bodies, and the bomb, get in a run after the impact, to either side. What flies off
   counts in no run, or it would make all small. */
static double reach_of(const Trajectory *run, const Extent *standing, int impact) {
    const Extent near = surroundings(standing, NEAR);
    const Extent above = {near.left, near.right, standing->bottom, near.top};
    Extent all = *standing;
    for (int body = 0; body < run->bodies; body++) {
        Extent own = all;
        bool leaves = run->fixed[body];
        for (int frame = impact; !leaves && frame < run->frames; frame++) {
            if (!trajectory_has(run, frame, body)) continue;
            leaves = !extent_holds(&above, run, frame, body);
            if (!leaves) extent_include(&own, run, frame, body);
        }
        if (!leaves) all = own;
    }
    return fmax(standing->left - all.left, all.right - standing->right);
}

/* What stands, widened by what happens after the impact in half of the runs: one that bursts shows nothing of the
   others. To both sides, so that what stands is in the middle; in steps, so that runs that differ little have the same
   view. */
static Extent action_extent(const Extent *standing, const Trajectory *const *runs, int count, int impact) {
    const double step = ACTION_STEP * extent_side(standing);
    double reach = HUGE_VAL;
    Extent action = *standing;
    for (int i = 0; i < count; i++) {
        const double own = reach_of(runs[i], standing, impact);
        int held = 0;
        for (int k = 0; k < count; k++) held += reach_of(runs[k], standing, impact) <= own;
        if (2 * held >= count) reach = fmin(reach, own);
    }
    action.left -= step * rint(reach / step);
    action.right += step * rint(reach / step);
    return action;
}

static const double FILL = 0.82;     /* of a panel's width or height: what stands; 0.7 with the scale rounded down */
static const double MIN_VIEW = 1e-3; /* m; the smallest view that can be set */
bool camera_view_is_usable(const CameraView *view) {
    return view->width >= MIN_VIEW && view->height >= MIN_VIEW && view->width < EXTENT_FARTHEST &&
           view->height < EXTENT_FARTHEST && fabs(view->x) < EXTENT_FARTHEST && fabs(view->y) < EXTENT_FARTHEST;
}

bool camera_view_of(const Trajectory *run, CameraView *view) {
    const Vec2 size = run->camera_size, center = run->camera_center;
    *view = (CameraView){(double)center.x, (double)center.y, (double)size.x, (double)size.y};
    return camera_view_is_usable(view);
}

/* With the margins that make it FILL; a narrow one below, where a strip of the ground is enough. */
static Extent add_margins(const Extent *e) {
    const double more = 1 / FILL - 1, side = more / 2 * (e->right - e->left), height = e->top - e->bottom;
    const double below = FRAMING_GROUND / FILL * height;
    return (Extent){e->left - side, e->right + side, e->bottom - below, e->top + more * height - below};
}

CameraFrame camera_frame_of(const CameraView *view) {
    const Extent held = {view->x - view->width / 2, view->x + view->width / 2, view->y - view->height / 2,
                         view->y + view->height / 2};
    return (CameraFrame){true, held, held, held, view->x};
}

/* What stands in the runs at the start; *leaves: whether the first run shows all that it reaches instead, as more than
   half of its poses until the frame `last` are far away. */
static Extent find_standing(const Trajectory *const *runs, int count, int last, bool *leaves) {
    const Trajectory *run = runs[0];
    Extent all = standing_extent(run, 0, NULL);
    const Extent near = surroundings(&all, NEAR);
    int64_t inside = 0, poses = 0;
    for (int frame = 0; frame <= last; frame++)
        for (int body = 0; body < run->bodies; body++) {
            if (run->fixed[body] || !trajectory_has(run, frame, body)) continue;
            inside += extent_holds(&near, run, frame, body);
            poses++;
        }
    *leaves = extent_is_empty(&all) || 2 * inside < poses;
    if (*leaves) {
        all = extent_empty;
        for (int frame = 0; frame < run->frames; frame++)
            for (int body = 0; body < run->bodies; body++)
                if (!run->fixed[body]) extent_include(&all, run, frame, body);
        if (extent_is_empty(&all)) all = fixed_extent(run);
        if (extent_is_empty(&all)) all = (Extent){-1, 1, -1, 1};
    }
    for (int i = 1; i < count; i++) {
        const Extent other = standing_extent(runs[i], 0, *leaves ? &all : &near);
        all = joined(all, &other);
    }
    return all;
}

CameraFrame camera_frame(const Trajectory *const *runs, int count) {
    const Trajectory *run = runs[0];
    CameraView set;
    bool leaves;
    if (camera_view_of(run, &set)) return camera_frame_of(&set);
    const int impact = trajectory_impact(run);
    const Extent start = standing_extent(run, 0, NULL), near = surroundings(&start, NEAR);
    Extent all = find_standing(runs, count, impact >= 0 ? impact : run->frames - 1, &leaves), settled = all;
    const bool struck = !leaves && impact >= 1;
    if (struck) {
        /* What falls together before the bomb strikes, as high as it is then. In steps, and not for a sag, so that runs
           that differ little have the same view; if three quarters of what stands at the start are in it. */
        const Extent then = standing_extent(run, impact - 1, &all);
        const double share = ceil(SETTLED_STEPS * (then.top - all.bottom) / (all.top - all.bottom)) / SETTLED_STEPS;
        int inside = 0, standing = 0;
        if (share < SAG) settled.top = all.bottom + share * (all.top - all.bottom);
        for (int body = 0; body < run->bodies; body++)
            standing += stands(run, 0, body, NULL), inside += stands(run, 0, body, &settled);
        if (4 * inside >= 3 * standing) all = settled;
    }
    const Extent framed = add_margins(&all);
    CameraFrame frame = {false, framed, framed, framed, (all.left + all.right) / 2};
    if (!struck) return frame;

    /* The frame in which the bomb gets where something stood: until then it flies, so that the view does not depend on
       how what stands sags. */
    int strikes = bomb_first_frame(run);
    for (; strikes < impact; strikes++) {
        const Extent bomb = bomb_extent(run, strikes);
        if (bomb.left < settled.right && bomb.right > settled.left && bomb.bottom < settled.top) break;
    }
    if (strikes > impact) strikes = impact;
    if (extent_holds(&near, run, strikes, run->bomb)) { /* with a margin; below, there is the ground */
        Extent bomb = bomb_extent(run, strikes);
        bomb = extent_widened(&bomb, BOMB_MARGIN * extent_side(&bomb));
        frame.held.left = fmin(frame.held.left, bomb.left), frame.held.right = fmax(frame.held.right, bomb.right);
        frame.held.top = fmax(frame.held.top, bomb.top);
    }
    const Extent fallen = room_to_fall(run, &all, impact), action = action_extent(&all, runs, count, impact);
    frame.action = add_margins(&action);
    frame.action = joined(frame.action, &frame.held);
    frame.room = add_margins(&fallen);
    frame.room = joined(frame.room, &frame.held);
    return frame;
}

CameraFrame camera_frame_approach(const Trajectory *run) {
    const int impact = trajectory_impact(run), last = impact >= 0 ? impact : run->frames - 1;
    const CameraFrame frame = camera_frame(&run, 1);
    Extent all = standing_extent(run, 0, NULL);
    const Extent reach = surroundings(&all, WAY_REACH);
    if (frame.set || extent_is_empty(&all) || run->bomb < 0) return frame;
    for (int i = bomb_first_frame(run); i <= last; i++)
        if (extent_holds(&reach, run, i, run->bomb)) extent_include(&all, run, i, run->bomb);
    all = add_margins(&all);
    return (CameraFrame){false, all, all, all, (all.left + all.right) / 2};
}

void camera_frame_put(JsonWriter *json, const char *key, const CameraFrame *frame) {
    json_begin_object(json, key, JSON_ONE_LINE);
    json_put_bool(json, "set", frame->set);
    json_put_number(json, "left", frame->held.left);
    json_put_number(json, "right", frame->held.right);
    json_put_number(json, "bottom", frame->held.bottom);
    json_put_number(json, "top", frame->held.top);
    json_put_number(json, "action_left", frame->action.left);
    json_put_number(json, "action_right", frame->action.right);
    json_put_number(json, "room_left", frame->room.left);
    json_put_number(json, "room_right", frame->room.right);
    json_put_number(json, "middle", frame->middle);
    json_end(json);
}
