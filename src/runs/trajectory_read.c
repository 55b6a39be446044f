/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads runs from .npz, of whatever program, and checks what must hold for them. */
#include "base/base.h"
#include "base/npz.h"
#include "engine/engine.h"
#include "runs/runs_internal.h"
#include "runs/trajectory.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool finite(Vec2 v) { return isfinite(v.x) && isfinite(v.y); }

static bool check_verdict(const Trajectory *t, const char *path, Error *error) {
    const unsigned control = control_in_text(t->verdict);
    if (control != 0) return error_input(error, path, "the verdict has the control character U+%04X", control);
    if (t->verdict_frame < -1 || t->verdict_frame >= t->frames)
        return error_input(error, path, "the verdict is on frame %d of %d", t->verdict_frame, t->frames);
    return (t->verdict_body >= -1 && t->verdict_body < t->bodies) ||
           error_input(error, path, "the verdict is on body %d of %d", t->verdict_body, t->bodies);
}

/* Their bytes come from a file: they need not end, nor be UTF-8. */
static bool check_names_of_bodies(const Trajectory *t, const char *path, Error *error) {
    for (int body = 0; t->name != NULL && body < t->bodies; body++) {
        const char *text = t->name[body].text;
        if (memchr(text, '\0', sizeof t->name[body].text) == NULL)
            return error_input(error, path, "body %d: its name must have at most %d bytes, and a 0 behind them", body,
                               SCENE_BODY_NAME_SIZE - 1);
        if (!text_is_utf8(text) || control_in_text(text) != 0)
            return error_input(error, path, "body %d: its name must be UTF-8 without control characters", body);
    }
    return true;
}

static bool check_head(const Trajectory *t, const char *path, Error *error) {
    if (!isfinite(t->dt) || !(t->dt > 0))
        return error_input(error, path, "dt must be finite and greater than 0 (got %g)", (double)t->dt);
    if (t->iterations < 0)
        return error_input(error, path, "the number of iterations must not be negative (got %d)", t->iterations);
    if (t->bomb < -1 || t->bomb >= t->bodies)
        return error_input(error, path, "the bomb is body %d of %d", t->bomb, t->bodies);
    if (!check_names_of_bodies(t, path, error)) return false;
    if (!finite(t->camera_center) || !finite(t->camera_size) || t->camera_size.x < 0 || t->camera_size.y < 0)
        return error_input(error, path, "the camera's window must be finite and not negative");
    for (int body = 0; body < t->bodies; body++) {
        Vec2 size = t->size[body];
        if (!finite(size) || !(size.x > 0) || !(size.y > 0))
            return error_input(error, path, "body %d: its size must be finite and greater than 0 (got %g x %g)", body,
                               (double)size.x, (double)size.y);
        if (t->fixed[body] > 1)
            return error_input(error, path, "body %d: 'fixed' must be 0 or 1 (got %d)", body, t->fixed[body]);
        if (!t->fixed[body] && (isinf(t->mass[body]) || t->mass[body] <= 0))
            return error_input(error, path, "body %d: its mass must be finite and greater than 0 (got %g)", body,
                               (double)t->mass[body]);
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
    size_t i = trajectory_at(t, frame, body);
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

static const char *const group_words[RUN_ARRAY_GROUPS] = {[GROUP_VELOCITIES] = "the two",
                                                          [GROUP_CONTACTS] = "the six contact arrays",
                                                          [GROUP_VERDICT] = "the three of the verdict"};

const RunArray run_arrays[RUN_ARRAYS] = {
    {"version", NPZ_INT32, 0, {0}, GROUP_NONE},
    {"scene", NPZ_TEXT, 0, {0}, GROUP_NONE},
    {"method", NPZ_TEXT, 0, {0}, GROUP_NONE},
    {"scene_hash", NPZ_UINT64, 0, {0}, GROUP_NONE},
    {"iterations", NPZ_INT32, 0, {0}, GROUP_NONE},
    {"dt", NPZ_FLOAT32, 0, {0}, GROUP_NONE},
    {"bomb", NPZ_INT32, 0, {0}, GROUP_NONE},
    {"camera", NPZ_FLOAT32, 2, {2, 2}, GROUP_NONE},
    {"size", NPZ_FLOAT32, 2, {OF_BODIES, 2}, GROUP_NONE},
    {"fixed", NPZ_UINT8, 1, {OF_BODIES}, GROUP_NONE},
    {"mass", NPZ_FLOAT32, 1, {OF_BODIES}, GROUP_NONE},
    {"body_name", NPZ_UINT8, 2, {OF_BODIES, SCENE_BODY_NAME_SIZE}, GROUP_NONE},
    {"position", NPZ_FLOAT32, 3, {OF_FRAMES, OF_BODIES, 2}, GROUP_NONE},
    {"angle", NPZ_FLOAT32, 2, {OF_FRAMES, OF_BODIES}, GROUP_NONE},
    {"velocity", NPZ_FLOAT32, 3, {OF_FRAMES, OF_BODIES, 2}, GROUP_VELOCITIES},
    {"angular_velocity", NPZ_FLOAT32, 2, {OF_FRAMES, OF_BODIES}, GROUP_VELOCITIES},
    {"contact_start", NPZ_INT64, 1, {OF_STEPS}, GROUP_CONTACTS},
    {"contact_bodies", NPZ_INT32, 2, {OF_CONTACTS, 2}, GROUP_CONTACTS},
    {"contact_feature", NPZ_UINT32, 1, {OF_CONTACTS}, GROUP_CONTACTS},
    {"contact_point", NPZ_FLOAT32, 2, {OF_CONTACTS, 2}, GROUP_CONTACTS},
    {"contact_normal", NPZ_FLOAT32, 2, {OF_CONTACTS, 2}, GROUP_CONTACTS},
    {"contact_impulse", NPZ_FLOAT32, 2, {OF_CONTACTS, 2}, GROUP_CONTACTS},
    {"program", NPZ_TEXT, 0, {0}, GROUP_NONE},
    {"verdict", NPZ_TEXT, 0, {0}, GROUP_VERDICT},
    {"verdict_frame", NPZ_INT32, 0, {0}, GROUP_VERDICT},
    {"verdict_body", NPZ_INT32, 0, {0}, GROUP_VERDICT},
};

void run_array_shape(const RunArray *array, int64_t frames, int64_t bodies, int64_t contacts,
                     int64_t shape[NPZ_MAX_RANK]) {
    for (int k = 0; k < array->rank; k++) {
        const int of = array->shape[k];
        shape[k] = of == OF_FRAMES     ? frames
                   : of == OF_STEPS    ? frames + 1
                   : of == OF_BODIES   ? bodies
                   : of == OF_CONTACTS ? contacts
                                       : of;
    }
}

static bool is_known(const char *name) {
    for (int i = 0; i < RUN_ARRAYS; i++)
        if (strcmp(run_arrays[i].name, name) == 0) return true;
    return false;
}

/* The array that an unknown name probably means, among those that the file lacks; NULL: none. */
static const char *trajectory_read_meant(const NpzFile *file, const char *name) {
    const char *missing[RUN_ARRAYS];
    int count = 0;
    for (int i = 0; i < RUN_ARRAYS; i++)
        if (!npz_has(file, run_arrays[i].name)) missing[count++] = run_arrays[i].name;
    return strlen(name) > 3 ? nearest_word(name, missing, count) : NULL;
}

static bool check_names(const NpzFile *file, Error *error) {
    const char *name, *right;
    for (size_t i = 0; (name = npz_name(file, i)) != NULL; i++)
        if (!is_known(name) && (right = trajectory_read_meant(file, name)) != NULL)
            return error_input(error, npz_path(file), "unknown array '%s': did you mean '%s'? Rename or remove it",
                               name, right);
    return true;
}

static bool check_needed(const NpzFile *file, Error *error) {
    static const char *const needed[] = {"position", "angle", "size", "dt"};
    const char *missing = NULL;
    int found = 0;
    for (int i = 3; i >= 0; i--) {
        if (npz_has(file, needed[i]))
            found++;
        else
            missing = needed[i];
    }
    return missing == NULL ||
           error_input(error, npz_path(file), "%shas no array '%s'; a trajectory needs position, angle, size and dt",
                       found == 0 ? "not a trajectory: " : "", missing);
}

static bool check_groups(const NpzFile *file, Error *error) {
    for (int i = 0; i < RUN_ARRAYS; i++)
        for (int k = 0; k < RUN_ARRAYS && run_arrays[i].group != GROUP_NONE; k++)
            if (run_arrays[i].group == run_arrays[k].group && npz_has(file, run_arrays[i].name) &&
                !npz_has(file, run_arrays[k].name))
                return error_input(error, npz_path(file), "has '%s' but not '%s'; give both, or none of %s",
                                   run_arrays[i].name, run_arrays[k].name, group_words[run_arrays[i].group]);
    return true;
}

/* Other files of twinbox have a text that states their kind. */
static bool has_kind(const NpzFile *file) {
    Error ignored = {0};
    return npz_shape(file, "kind", NPZ_TEXT, 0, NULL, &ignored);
}

/* False with error set if the file is one of another kind, lacks a needed array, has a part of those that only come
   together, or has an unknown array that looks like one that it lacks: then the error suggests that name. Other unknown
   arrays are ignored. */
static bool check_arrays(NpzFile *file, Error *error) {
    char kind[64];
    if (has_kind(file))
        return npz_read_name(file, "kind", kind, sizeof kind, error) &&
               error_input(error, npz_path(file), "not a trajectory but a file of kind '%s'", kind);
    /* A wrong name is the likely cause of a missing array, so it is told first. */
    return check_names(file, error) && check_needed(file, error) && check_groups(file, error);
}

static bool read_version(NpzFile *file, const char *path, Error *error) {
    int32_t version = TRAJECTORY_VERSION;
    if (!check_arrays(file, error)) return false;
    if (npz_has(file, "version") && !npz_read_scalar(file, "version", NPZ_INT32, &version, sizeof version, error))
        return false;
    return version == TRAJECTORY_VERSION ||
           error_input(error, path, "trajectory of version %d; expected version %d", (int)version, TRAJECTORY_VERSION);
}

/* Frames, bodies and contacts, by which the shapes of all arrays must agree. */
static bool read_counts(Trajectory *t, NpzFile *file, const char *path, int64_t *contacts, Error *error) {
    int64_t shape[3], pairs[2] = {0, 2};
    if (!npz_shape(file, "position", NPZ_FLOAT32, 3, shape, error)) return false;
    const int64_t frames = shape[0], bodies = shape[1];
    if (frames < 1 || frames >= INT_MAX || bodies >= INT_MAX)
        return error_input(error, path, "%lld frames of %lld bodies; expected at least 1 and less than %d",
                           (long long)frames, (long long)bodies, INT_MAX);
    t->frames = (int)frames;
    t->bodies = (int)bodies;
    t->no_velocities = !npz_has(file, "velocity");
    t->no_contacts = !npz_has(file, "contact_start");
    if (!t->no_contacts && !npz_shape(file, "contact_bodies", NPZ_INT32, 2, pairs, error)) return false;
    *contacts = pairs[0];
    return true;
}

static bool check_shapes(const Trajectory *t, const NpzFile *file, int64_t contacts, Error *error) {
    for (int i = 0; i < RUN_ARRAYS; i++) {
        NpzArray array = {run_arrays[i].name, run_arrays[i].type, run_arrays[i].rank, {0}, NULL};
        run_array_shape(&run_arrays[i], t->frames, t->bodies, contacts, array.shape);
        if (npz_has(file, array.name) && !npz_expect(file, &array, 1, error)) return false;
    }
    return true;
}

static bool read_names(Trajectory *t, NpzFile *file, const char *path, Error *error) {
    trajectory_name_from_path(path, t->scene);
    trajectory_name_from_path(path, t->method);
    return (!npz_has(file, "scene") || npz_read_name(file, "scene", t->scene, sizeof t->scene, error)) &&
           (!npz_has(file, "method") || npz_read_name(file, "method", t->method, sizeof t->method, error)) &&
           (!npz_has(file, "program") || npz_read_name(file, "program", t->program, sizeof t->program, error));
}

static bool read_verdict(Trajectory *t, NpzFile *file, Error *error) {
    int32_t frame = -1, body = -1;
    if (npz_has(file, "verdict") && (!npz_read_text(file, "verdict", t->verdict, sizeof t->verdict, error) ||
                                     !npz_read_scalar(file, "verdict_frame", NPZ_INT32, &frame, sizeof frame, error) ||
                                     !npz_read_scalar(file, "verdict_body", NPZ_INT32, &body, sizeof body, error)))
        return false;
    t->verdict_frame = frame;
    t->verdict_body = body;
    return true;
}

static bool read_head(Trajectory *t, NpzFile *file, const char *path, Error *error) {
    int32_t bomb = -1, iterations = 0;
    const int64_t two_by_two[] = {2, 2};
    if (!read_names(t, file, path, error) || !read_verdict(t, file, error) ||
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
        size_t i = trajectory_at(t, frame, body), first = (size_t)body;
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

/* Or NaN. */
static bool read_masses(Trajectory *t, NpzFile *file, const char *path, Error *error) {
    const int64_t per_body[] = {t->bodies};
    if (npz_has(file, "mass")) return (t->mass = npz_read(file, "mass", NPZ_FLOAT32, 1, per_body, error)) != NULL;
    t->mass = malloc(((size_t)t->bodies + 1) * sizeof *t->mass);
    for (int body = 0; t->mass != NULL && body < t->bodies; body++) t->mass[body] = NAN;
    return t->mass != NULL || error_memory(error, path);
}

static bool read_names_of_bodies(Trajectory *t, NpzFile *file, Error *error) {
    const int64_t shape[] = {t->bodies, SCENE_BODY_NAME_SIZE};
    return !npz_has(file, "body_name") || (t->name = npz_read(file, "body_name", NPZ_UINT8, 2, shape, error)) != NULL;
}

/* Both, or NaN. */
static bool read_velocities(Trajectory *t, NpzFile *file, const char *path, Error *error) {
    const int64_t vectors[] = {t->frames, t->bodies, 2};
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
    const int64_t vectors[] = {t->frames, t->bodies, 2}, per_body[] = {t->bodies, 2};
    return (t->size = npz_read(file, "size", NPZ_FLOAT32, 2, per_body, error)) != NULL &&
           (t->position = npz_read(file, "position", NPZ_FLOAT32, 3, vectors, error)) != NULL &&
           (t->angle = npz_read(file, "angle", NPZ_FLOAT32, 2, vectors, error)) != NULL &&
           read_fixed(t, file, path, error) && read_masses(t, file, path, error) &&
           read_names_of_bodies(t, file, error) && read_velocities(t, file, path, error);
}

/* Files have one array per quantity. Each is freed before the next is read. */
static bool read_contact_array(Trajectory *t, NpzFile *file, const char *name, NpzType type, int rank, size_t member,
                               size_t size, Error *error) {
    const int64_t count = (int64_t)t->contact_capacity, shape[] = {count, 2};
    char *data = npz_read(file, name, type, rank, shape, error);
    for (int64_t i = 0; data != NULL && i < count; i++)
        memcpy((char *)&t->contacts[i] + member, data + (size_t)i * size, size);
    free(data);
    return data != NULL;
}

static bool read_contact_arrays(Trajectory *t, NpzFile *file, Error *error) {
    typedef TrajectoryContact C;
    _Static_assert(offsetof(C, b) == offsetof(C, a) + sizeof(int32_t), "a and b are copied as a pair");
    _Static_assert(offsetof(C, tangent_impulse) == offsetof(C, normal_impulse) + sizeof(float), "and the impulses");
    const size_t pair = 2 * sizeof(float);
    return read_contact_array(t, file, "contact_bodies", NPZ_INT32, 2, offsetof(C, a), pair, error) &&
           read_contact_array(t, file, "contact_feature", NPZ_UINT32, 1, offsetof(C, feature), pair / 2, error) &&
           read_contact_array(t, file, "contact_point", NPZ_FLOAT32, 2, offsetof(C, point), pair, error) &&
           read_contact_array(t, file, "contact_normal", NPZ_FLOAT32, 2, offsetof(C, normal), pair, error) &&
           read_contact_array(t, file, "contact_impulse", NPZ_FLOAT32, 2, offsetof(C, normal_impulse), pair, error);
}

static bool read_contacts(Trajectory *t, NpzFile *file, const char *path, int64_t count, Error *error) {
    const int64_t steps = (int64_t)t->frames + 1;
    if (t->no_contacts) {
        t->contact_start = calloc((size_t)steps, sizeof *t->contact_start);
        return t->contact_start != NULL || error_memory(error, path);
    }
    t->contact_start = npz_read(file, "contact_start", NPZ_INT64, 1, &steps, error);
    if (t->contact_start == NULL) return false;
    bool rising = t->contact_start[0] == 0 && t->contact_start[1] == 0;
    for (int step = 1; rising && step < t->frames; step++)
        rising = t->contact_start[step] <= t->contact_start[step + 1];
    if (!rising || t->contact_start[t->frames] != count)
        return error_input(error, path, "contact_start must rise from 0, 0 to the number of contacts");
    t->contacts = calloc(count > 0 ? (size_t)count : 1, sizeof *t->contacts);
    if (t->contacts == NULL) return error_memory(error, path);
    t->contact_capacity = (size_t)count;
    return read_contact_arrays(t, file, error);
}

static bool read_run(Trajectory *t, NpzFile *file, const char *path, Error *error) {
    int64_t contacts = 0;
    return read_version(file, path, error) && read_counts(t, file, path, &contacts, error) &&
           check_shapes(t, file, contacts, error) && read_head(t, file, path, error) &&
           read_poses(t, file, path, error) && read_contacts(t, file, path, contacts, error) &&
           trajectory_check(t, path, error);
}

Trajectory *trajectory_read(const char *path, Error *error) {
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return NULL;
    npz_convert(file);
    Trajectory *t = calloc(1, sizeof *t);
    bool done = t != NULL || error_memory(error, path);
    done = done && read_run(t, file, path, error);
    npz_close(file);
    if (done)
        trace_line("run %s: %s by %s, %d frames of %d bodies, step %g s, scene hash %016" PRIx64, path, t->scene,
                   t->method, t->frames, t->bodies, (double)t->dt, t->scene_hash);
    if (done) return t;
    trajectory_destroy(t);
    return NULL;
}
