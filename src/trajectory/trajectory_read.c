/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads trajectories from untrusted files. */
#include "common/trace.h"
#include "npz/npz.h"
#include "trajectory/run_arrays.h"
#include "trajectory/trajectory.h"
#include "trajectory/trajectory_name.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool read_version(NpzFile *file, const char *path, Error *error) {
    int32_t version = TRAJECTORY_VERSION;
    if (!run_arrays_check(file, error)) return false;
    if (npz_has(file, "version") && !npz_read_scalar(file, "version", NPZ_INT32, &version, sizeof version, error))
        return false;
    return version == TRAJECTORY_VERSION ||
           error_input(error, path, "trajectory of version %d; expected version %d", (int)version, TRAJECTORY_VERSION);
}

static bool read_names(Trajectory *t, NpzFile *file, const char *path, Error *error) {
    trajectory_name_from_path(path, t->scene);
    trajectory_name_from_path(path, t->method);
    return (!npz_has(file, "scene") || npz_read_name(file, "scene", t->scene, sizeof t->scene, error)) &&
           (!npz_has(file, "method") || npz_read_name(file, "method", t->method, sizeof t->method, error));
}

static bool read_head(Trajectory *t, NpzFile *file, const char *path, Error *error) {
    int32_t bomb = -1, iterations = 0;
    const int64_t two_by_two[] = {2, 2};
    if (!read_version(file, path, error) || !read_names(t, file, path, error) ||
        (npz_has(file, "scene_hash") &&
         !npz_read_scalar(file, "scene_hash", NPZ_UINT64, &t->scene_hash, sizeof t->scene_hash, error)) ||
        (npz_has(file, "iterations") &&
         !npz_read_scalar(file, "iterations", NPZ_INT32, &iterations, sizeof iterations, error)) ||
        !npz_read_scalar(file, "dt", NPZ_FLOAT32, &t->dt, sizeof t->dt, error) ||
        (npz_has(file, "bomb") && !npz_read_scalar(file, "bomb", NPZ_INT32, &bomb, sizeof bomb, error)))
        return false;
    t->bomb = bomb;
    t->iterations = iterations;
    if (!npz_has(file, "camera")) return true;
    Vec2 *camera = npz_read(file, "camera", NPZ_FLOAT32, 2, two_by_two, error);
    if (camera == NULL) return false;
    t->camera_center = camera[0];
    t->camera_size = camera[1];
    free(camera);
    return true;
}

static bool never_moves(const Trajectory *t, int body) {
    for (int frame = 0; frame < t->frames; frame++) {
        size_t i = (size_t)frame * (size_t)t->bodies + (size_t)body, first = (size_t)body;
        if (!trajectory_has(t, frame, body) || memcmp(&t->position[i], &t->position[first], sizeof(Vec2)) != 0 ||
            memcmp(&t->angle[i], &t->angle[first], sizeof(float)) != 0)
            return false;
    }
    return t->frames > 1;
}

void trajectory_guess_fixed(Trajectory *t) {
    for (int body = 0; body < t->bodies; body++) t->fixed[body] = never_moves(t, body);
}

static bool read_fixed(Trajectory *t, NpzFile *file, const char *path, Error *error) {
    const int64_t per_body[] = {t->bodies};
    if (npz_has(file, "fixed")) return (t->fixed = npz_read(file, "fixed", NPZ_UINT8, 1, per_body, error)) != NULL;
    t->fixed = calloc((size_t)t->bodies + 1, sizeof *t->fixed);
    if (t->fixed == NULL) return error_memory(error, path);
    trajectory_guess_fixed(t);
    return true;
}

/* Both, or NaN. */
static bool read_velocities(Trajectory *t, NpzFile *file, const char *path, Error *error) {
    const int64_t vectors[] = {t->frames, t->bodies, 2};
    t->no_velocities = !npz_has(file, "velocity");
    if (!t->no_velocities)
        return (t->velocity = npz_read(file, "velocity", NPZ_FLOAT32, 3, vectors, error)) != NULL &&
               (t->angular_velocity = npz_read(file, "angular_velocity", NPZ_FLOAT32, 2, vectors, error)) != NULL;
    size_t poses = (size_t)t->frames * (size_t)t->bodies;
    t->velocity = malloc((poses + 1) * sizeof *t->velocity);
    t->angular_velocity = malloc((poses + 1) * sizeof *t->angular_velocity);
    if (t->velocity == NULL || t->angular_velocity == NULL) return error_memory(error, path);
    for (size_t i = 0; i < poses; i++) {
        t->velocity[i] = vec2(NAN, NAN);
        t->angular_velocity[i] = NAN;
    }
    return true;
}

static bool read_poses(Trajectory *t, NpzFile *file, const char *path, Error *error) {
    int64_t shape[3], bodies, frames;
    if (!npz_shape(file, "position", NPZ_FLOAT32, 3, shape, error)) return false;
    frames = shape[0];
    bodies = shape[1];
    if (frames < 1 || frames >= INT_MAX || bodies >= INT_MAX)
        return error_input(error, path, "%lld frames of %lld bodies; expected at least 1 and less than %d",
                           (long long)frames, (long long)bodies, INT_MAX);
    t->frames = (int)frames;
    t->bodies = (int)bodies;
    const int64_t vectors[] = {frames, bodies, 2}, per_body[] = {bodies, 2};
    return (t->size = npz_read(file, "size", NPZ_FLOAT32, 2, per_body, error)) != NULL &&
           (t->position = npz_read(file, "position", NPZ_FLOAT32, 3, vectors, error)) != NULL &&
           (t->angle = npz_read(file, "angle", NPZ_FLOAT32, 2, vectors, error)) != NULL &&
           read_fixed(t, file, path, error) && read_velocities(t, file, path, error);
}

/* Contacts as stored in files: one array per quantity. */
typedef struct ContactArrays {
    int32_t (*bodies)[2]; /* a, b */
    uint32_t *feature;
    Vec2 *point, *normal;
    float (*impulse)[2]; /* normal, tangent */
} ContactArrays;

static void contact_arrays_free(ContactArrays *arrays) {
    free(arrays->bodies);
    free(arrays->feature);
    free(arrays->point);
    free(arrays->normal);
    free(arrays->impulse);
}

static bool read_contact_arrays(ContactArrays *arrays, NpzFile *file, int64_t count, Error *error) {
    const int64_t pairs[] = {count, 2};
    return (arrays->bodies = npz_read(file, "contact_bodies", NPZ_INT32, 2, pairs, error)) != NULL &&
           (arrays->feature = npz_read(file, "contact_feature", NPZ_UINT32, 1, pairs, error)) != NULL &&
           (arrays->point = npz_read(file, "contact_point", NPZ_FLOAT32, 2, pairs, error)) != NULL &&
           (arrays->normal = npz_read(file, "contact_normal", NPZ_FLOAT32, 2, pairs, error)) != NULL &&
           (arrays->impulse = npz_read(file, "contact_impulse", NPZ_FLOAT32, 2, pairs, error)) != NULL;
}

static bool join_contacts(Trajectory *t, const ContactArrays *arrays, size_t count) {
    t->contacts = calloc(count > 0 ? count : 1, sizeof *t->contacts);
    if (t->contacts == NULL) return false;
    t->contact_capacity = count;
    for (size_t i = 0; i < count; i++)
        t->contacts[i] = (TrajectoryContact){.a = arrays->bodies[i][0],
                                             .b = arrays->bodies[i][1],
                                             .feature = arrays->feature[i],
                                             .point = arrays->point[i],
                                             .normal = arrays->normal[i],
                                             .normal_impulse = arrays->impulse[i][0],
                                             .tangent_impulse = arrays->impulse[i][1]};
    return true;
}

static bool read_contacts(Trajectory *t, NpzFile *file, const char *path, Error *error) {
    int64_t shape[2], steps = (int64_t)t->frames + 1;
    t->no_contacts = !npz_has(file, "contact_start");
    if (t->no_contacts) {
        t->contact_start = calloc((size_t)steps, sizeof *t->contact_start);
        return t->contact_start != NULL || error_memory(error, path);
    }
    if (!npz_shape(file, "contact_bodies", NPZ_INT32, 2, shape, error)) return false;
    t->contact_start = npz_read(file, "contact_start", NPZ_INT64, 1, &steps, error);
    if (t->contact_start == NULL) return false;
    bool rising = t->contact_start[0] == 0 && t->contact_start[1] == 0;
    for (int step = 1; rising && step < t->frames; step++)
        rising = t->contact_start[step] <= t->contact_start[step + 1];
    if (!rising || t->contact_start[t->frames] != shape[0])
        return error_input(error, path, "contact_start must rise from 0, 0 to the number of contacts");
    ContactArrays arrays = {0};
    bool done = read_contact_arrays(&arrays, file, shape[0], error) &&
                (join_contacts(t, &arrays, (size_t)shape[0]) || error_memory(error, path));
    contact_arrays_free(&arrays);
    return done;
}

static bool finite(Vec2 v) { return isfinite(v.x) && isfinite(v.y); }

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
    if (!check_head(t, path, error)) return false;
    for (int frame = 0; frame < t->frames; frame++) {
        for (int body = 0; body < t->bodies; body++)
            if (!check_pose(t, frame, body, path, error)) return false;
        for (int64_t i = t->contact_start[frame]; i < t->contact_start[frame + 1]; i++)
            if (!check_contact(t, frame, i, path, error)) return false;
    }
    return true;
}

Trajectory *trajectory_read(const char *path, Error *error) {
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return NULL;
    npz_convert(file);
    Trajectory *t = calloc(1, sizeof *t);
    bool done = t != NULL || error_memory(error, path);
    done = done && read_head(t, file, path, error) && read_poses(t, file, path, error) &&
           read_contacts(t, file, path, error) && trajectory_check(t, path, error);
    npz_close(file);
    if (done)
        trace_line("run %s: %s by %s, %d frames of %d bodies, step %g s, scene hash %016" PRIx64, path, t->scene,
                   t->method, t->frames, t->bodies, (double)t->dt, t->scene_hash);
    if (done) return t;
    trajectory_destroy(t);
    return NULL;
}
