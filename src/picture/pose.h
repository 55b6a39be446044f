/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a body is at a moment. */
#pragma once
#include "picture/moment.h"
#include "trajectory/trajectory.h"

#include <math.h>

typedef struct Pose {
    double x, y, angle; /* m, rad; not finite where the body is not there */
} Pose;

/* The moment as a run shows it: its last frame once it has ended. */
static inline Moment pose_moment(const Trajectory *run, Moment moment) {
    if (moment.frame >= run->frames - 1) moment.frame = run->frames - 1, moment.part = 0;
    return moment;
}

static inline Pose pose_stored(const Trajectory *run, int frame, int body) {
    size_t i = (size_t)frame * (size_t)run->bodies + (size_t)body;
    return (Pose){(double)run->position[i].x, (double)run->position[i].y, (double)run->angle[i]};
}

/* Between two frames a straight way, as the engine moves bodies: x += v dt. Angles do not wrap in a run, so neither do they
   here. A body that comes is not there before the frame that has it, and one that goes stays where it was. */
static inline Pose pose_at(const Trajectory *run, Moment moment, int body) {
    moment = pose_moment(run, moment);
    Pose pose = pose_stored(run, moment.frame, body);
    if (!(moment.part > 0) || !trajectory_has(run, moment.frame + 1, body)) return pose;
    Pose next = pose_stored(run, moment.frame + 1, body);
    return (Pose){pose.x + moment.part * (next.x - pose.x), pose.y + moment.part * (next.y - pose.y),
                  pose.angle + moment.part * (next.angle - pose.angle)};
}

/* m. Not hypot: square roots are the same on every machine. */
static inline double pose_distance(Pose a, Pose b) {
    double x = a.x - b.x, y = a.y - b.y;
    return sqrt(x * x + y * y);
}
