/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "trajectory/trajectory_states.h"

#include <math.h>
#include <string.h>

static size_t pose(const Trajectory *t, int frame, int body) {
    return (size_t)frame * (size_t)t->bodies + (size_t)body;
}

bool trajectory_both_move(const Trajectory *a, const Trajectory *b) { return !a->no_velocities && !b->no_velocities; }

static bool same_velocity(const Trajectory *a, size_t i, const Trajectory *b, size_t k) {
    return memcmp(&a->velocity[i], &b->velocity[k], sizeof(Vec2)) == 0 &&
           memcmp(&a->angular_velocity[i], &b->angular_velocity[k], sizeof(float)) == 0;
}

bool trajectory_same_state(const Trajectory *a, const Trajectory *b, int frame, int body) {
    bool in_a = trajectory_has(a, frame, body), in_b = trajectory_has(b, frame, body);
    if (!in_a || !in_b) return in_a == in_b;
    size_t i = pose(a, frame, body), k = pose(b, frame, body);
    return memcmp(&a->position[i], &b->position[k], sizeof(Vec2)) == 0 &&
           memcmp(&a->angle[i], &b->angle[k], sizeof(float)) == 0 &&
           (!trajectory_both_move(a, b) || same_velocity(a, i, b, k));
}

StateDifference trajectory_state_difference(const Trajectory *a, const Trajectory *b, int frame, int body) {
    StateDifference d = {.in_a = trajectory_has(a, frame, body), .in_b = trajectory_has(b, frame, body)};
    if (!d.in_a || !d.in_b) return d;
    size_t i = pose(a, frame, body), k = pose(b, frame, body);
    d.distance = vec2_distance(a->position[i], b->position[k]);
    d.angle = fabs((double)a->angle[i] - b->angle[k]);
    if (!trajectory_both_move(a, b)) return d;
    d.speed = vec2_distance(a->velocity[i], b->velocity[k]);
    d.spin = fabs((double)a->angular_velocity[i] - b->angular_velocity[k]);
    return d;
}

bool trajectory_different_worlds(const Trajectory *a, const Trajectory *b, char *what, size_t size) {
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
