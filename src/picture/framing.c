/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/framing.h"

#include <math.h>

static const double MIN_SIDE = 2.0; /* m, of what stands, for the next two */
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
    return extent_widened(extent, sides * fmax(extent_side(extent), MIN_SIDE));
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

Framing framing_of(const Trajectory *run) {
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
