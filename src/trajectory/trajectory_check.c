/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What must hold for a run from an untrusted file. */
#include "trajectory/trajectory.h"

#include <math.h>

static bool finite(Vec2 v) { return isfinite(v.x) && isfinite(v.y); }

static bool check_verdict(const Trajectory *t, const char *path, Error *error) {
    for (const char *c = t->verdict; *c != '\0'; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            return error_input(error, path, "the verdict holds control characters");
    if (t->verdict_frame < -1 || t->verdict_frame >= t->frames)
        return error_input(error, path, "the verdict is on frame %d of %d", t->verdict_frame, t->frames);
    return (t->verdict_body >= -1 && t->verdict_body < t->bodies) ||
           error_input(error, path, "the verdict is on body %d of %d", t->verdict_body, t->bodies);
}

static bool check_head(const Trajectory *t, const char *path, Error *error) {
    if (!isfinite(t->dt) || !(t->dt > 0))
        return error_input(error, path, "dt must be finite and greater than 0 (got %g)", (double)t->dt);
    if (t->iterations < 0)
        return error_input(error, path, "the number of iterations must not be negative (got %d)", t->iterations);
    if (t->bomb < -1 || t->bomb >= t->bodies)
        return error_input(error, path, "the bomb is body %d of %d", t->bomb, t->bodies);
    if (!finite(t->camera_center) || !finite(t->camera_size) || t->camera_size.x < 0 || t->camera_size.y < 0)
        return error_input(error, path, "the camera's window must be finite and not negative");
    for (int body = 0; body < t->bodies; body++) {
        Vec2 size = t->size[body];
        if (!finite(size) || !(size.x > 0) || !(size.y > 0))
            return error_input(error, path, "body %d: its size must be finite and greater than 0 (got %g x %g)", body,
                               (double)size.x, (double)size.y);
        if (t->fixed[body] > 1)
            return error_input(error, path, "body %d: 'fixed' must be 0 or 1 (got %d)", body, t->fixed[body]);
    }
    return true;
}

static bool was_there(const Trajectory *t, int frame, int body) {
    while (frame > 0)
        if (trajectory_has(t, --frame, body)) return true;
    return false;
}

/* A body exists in one interval of frames; a static body, which is drawn once, until the end. */
static bool check_presence(const Trajectory *t, int frame, int body, const char *path, Error *error) {
    bool before = frame > 0 && trajectory_has(t, frame - 1, body), now = trajectory_has(t, frame, body);
    if (before && !now && t->fixed[body])
        return error_input(error, path, "frame %d, body %d: a static body must not be removed", frame, body);
    if (!before && now && was_there(t, frame, body))
        return error_input(error, path, "frame %d, body %d: a removed body must not reappear", frame, body);
    return true;
}

/* Finite numbers if the body exists, else NaN. */
static bool check_pose(const Trajectory *t, int frame, int body, const char *path, Error *error) {
    size_t i = (size_t)frame * (size_t)t->bodies + (size_t)body;
    const float state[] = {t->position[i].x, t->position[i].y, t->angle[i],
                           t->velocity[i].x, t->velocity[i].y, t->angular_velocity[i]};
    const int count = t->no_velocities ? 3 : 6;
    int known = 0, missing = 0;
    for (int k = 0; k < count; k++) {
        known += isfinite(state[k]) != 0;
        missing += isnan(state[k]) != 0;
    }
    if (known != count && missing != count)
        return error_input(error, path, "frame %d, body %d: %s are not all finite", frame, body,
                           t->no_velocities ? "position and angle" : "pose and velocity");
    return check_presence(t, frame, body, path, error);
}

/* A step's contacts are of bodies that existed before it. */
static bool check_contact(const Trajectory *t, int step, int64_t index, const char *path, Error *error) {
    const TrajectoryContact *contact = &t->contacts[index];
    if (contact->a < 0 || contact->a >= contact->b || contact->b >= t->bodies ||
        !trajectory_has(t, step - 1, contact->a) || !trajectory_has(t, step - 1, contact->b))
        return error_input(error, path, "step %d, contact %lld: bodies %d and %d are not an existing pair", step,
                           (long long)index, (int)contact->a, (int)contact->b);
    if (!finite(contact->point) || !finite(contact->normal) || !isfinite(contact->normal_impulse) ||
        !isfinite(contact->tangent_impulse))
        return error_input(error, path, "step %d, contact %lld: a number is NaN or infinite", step, (long long)index);
    return true;
}

bool trajectory_check(const Trajectory *t, const char *path, Error *error) {
    if (!check_head(t, path, error) || !check_verdict(t, path, error)) return false;
    for (int frame = 0; frame < t->frames; frame++) {
        for (int body = 0; body < t->bodies; body++)
            if (!check_pose(t, frame, body, path, error)) return false;
        for (int64_t i = t->contact_start[frame]; i < t->contact_start[frame + 1]; i++)
            if (!check_contact(t, frame, i, path, error)) return false;
    }
    return true;
}
