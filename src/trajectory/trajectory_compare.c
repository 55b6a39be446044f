/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where two trajectories part. Equal means equal bit by bit: 0 and -0 differ, as a run that shows one where
   another shows the other has taken another way. */
#include "trajectory/trajectory.h"

#include <math.h>
#include <string.h>

static size_t pose(const Trajectory *t, int frame, int body) {
    return (size_t)frame * (size_t)t->bodies + (size_t)body;
}

/* Not hypot: square roots are the same on every machine, and squares of floats do not overflow a double. */
static double distance(Vec2 a, Vec2 b) {
    double x = (double)a.x - b.x, y = (double)a.y - b.y;
    return sqrt(x * x + y * y);
}

static bool same_bits(const Trajectory *a, const Trajectory *b, int frame, int body) {
    bool in_a = trajectory_has(a, frame, body), in_b = trajectory_has(b, frame, body);
    if (!in_a || !in_b) return in_a == in_b;
    size_t i = pose(a, frame, body), k = pose(b, frame, body);
    return memcmp(&a->position[i], &b->position[k], sizeof(Vec2)) == 0 &&
           memcmp(&a->angle[i], &b->angle[k], sizeof(float)) == 0 &&
           memcmp(&a->velocity[i], &b->velocity[k], sizeof(Vec2)) == 0 &&
           memcmp(&a->angular_velocity[i], &b->angular_velocity[k], sizeof(float)) == 0;
}

/* What makes the frames incomparable. */
static bool different_worlds(const Trajectory *a, const Trajectory *b, char *what, size_t size) {
    if (a->bodies != b->bodies) return snprintf(what, size, "bodies: %d and %d", a->bodies, b->bodies) > 0;
    for (int body = 0; body < a->bodies; body++) {
        Vec2 p = a->size[body], q = b->size[body];
        if (memcmp(&p, &q, sizeof p) != 0)
            return snprintf(what, size, "size of body %d: %.9g x %.9g and %.9g x %.9g m", body, (double)p.x,
                            (double)p.y, (double)q.x, (double)q.y) > 0;
        if (a->fixed[body] != b->fixed[body])
            return snprintf(what, size, "body %d: %s and %s", body, a->fixed[body] ? "static" : "dynamic",
                            b->fixed[body] ? "static" : "dynamic") > 0;
    }
    if (memcmp(&a->dt, &b->dt, sizeof a->dt) != 0)
        return snprintf(what, size, "dt: %.9g and %.9g s", (double)a->dt, (double)b->dt) > 0;
    return false;
}

static void describe_first(const Trajectory *a, const Trajectory *b, int frame, int body, TrajectoryDifference *d) {
    d->frame = frame;
    d->body = body;
    bool in_a = trajectory_has(a, frame, body), in_b = trajectory_has(b, frame, body);
    if (!in_a || !in_b) {
        snprintf(d->what, sizeof d->what, "body %d is in frame %d of the %s only", body, frame,
                 in_a ? "first" : "second");
        return;
    }
    size_t i = pose(a, frame, body), k = pose(b, frame, body);
    d->distance = distance(a->position[i], b->position[k]);
    d->angle = fabs((double)a->angle[i] - b->angle[k]);
    d->speed = distance(a->velocity[i], b->velocity[k]);
}

void trajectory_compare(const Trajectory *a, const Trajectory *b, TrajectoryDifference *d) {
    *d = (TrajectoryDifference){.frame = -1, .body = -1, .max_frame = -1, .max_body = -1};
    if (different_worlds(a, b, d->what, sizeof d->what)) return;
    int frames = a->frames < b->frames ? a->frames : b->frames;
    for (int frame = 0; frame < frames; frame++) {
        for (int body = 0; body < a->bodies; body++) {
            if (same_bits(a, b, frame, body)) continue;
            if (d->frame < 0) describe_first(a, b, frame, body, d);
            double apart = distance(a->position[pose(a, frame, body)], b->position[pose(b, frame, body)]);
            if (!(apart > d->max_distance)) continue;
            d->max_distance = apart;
            d->max_frame = frame;
            d->max_body = body;
        }
    }
    if (d->frame < 0 && a->frames != b->frames)
        snprintf(d->what, sizeof d->what, "frames: %d and %d", a->frames, b->frames);
    d->equal = d->frame < 0 && d->what[0] == '\0';
}

double trajectory_distance(const Trajectory *a, const Trajectory *b, int frame) {
    int bodies = a->bodies < b->bodies ? a->bodies : b->bodies;
    double largest = 0;
    for (int body = 0; body < bodies; body++) {
        if (!trajectory_has(a, frame, body) || !trajectory_has(b, frame, body)) continue;
        largest = fmax(largest, distance(a->position[pose(a, frame, body)], b->position[pose(b, frame, body)]));
    }
    return largest;
}
