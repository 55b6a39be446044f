/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pose of a body at a moment. */
#pragma once
#include "picture/moment.h"
#include "trajectory/trajectory.h"

#include <math.h>

typedef struct Pose {
    double x, y, angle; /* m, rad; NaN or infinite if the body does not exist */
} Pose;

/* The moment that a run shows: its last frame after it has ended. */
static inline Moment pose_moment(const Trajectory *run, Moment moment) {
    if (moment.frame >= run->frames - 1) moment.frame = run->frames - 1, moment.part = 0;
    return moment;
}

static inline Pose pose_stored(const Trajectory *run, int frame, int body) {
    size_t i = (size_t)frame * (size_t)run->bodies + (size_t)body;
    return (Pose){(double)run->position[i].x, (double)run->position[i].y, (double)run->angle[i]};
}

/* Linear interpolation between two frames, as the engine moves bodies: x += v dt. Angles do not wrap in a run, so no
   shortest arc is needed. A body appears with its first frame; one that disappears keeps its last pose. */
static inline Pose pose_at(const Trajectory *run, Moment moment, int body) {
    moment = pose_moment(run, moment);
    Pose pose = pose_stored(run, moment.frame, body);
    if (moment.part == 0 || !trajectory_has(run, moment.frame + 1, body)) return pose;
    const Pose next = pose_stored(run, moment.frame + 1, body);
    const double fraction = moment_fraction(moment);
    return (Pose){pose.x + fraction * (next.x - pose.x), pose.y + fraction * (next.y - pose.y),
                  pose.angle + fraction * (next.angle - pose.angle)};
}

/* m. sqrt is correctly rounded on every machine; hypot is not. */
static inline double pose_distance(Pose a, Pose b) {
    double x = a.x - b.x, y = a.y - b.y;
    return sqrt(x * x + y * y);
}
