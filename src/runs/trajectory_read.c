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

/* Head and bodies. Bytes of names come from a file: they need not end, nor be UTF-8. */
static bool check_head(const Trajectory *t, const char *path, Error *error) {
    if (!isfinite(t->dt) || !(t->dt > 0))
        return error_input(error, path, "dt must be finite and greater than 0 (got %g)", (double)t->dt);
    if (t->iterations < 0)
        return error_input(error, path, "the number of iterations must not be negative (got %d)", t->iterations);
    if (t->bomb < -1 || t->bomb >= t->bodies)
        return error_input(error, path, "the bomb is body %d of %d", t->bomb, t->bodies);
    for (int body = 0; t->name != NULL && body < t->bodies; body++) {
        const char *text = t->name[body].text;
        if (memchr(text, '\0', sizeof t->name[body].text) == NULL)
            return error_input(error, path, "body %d: its name must have at most %d bytes, and a 0 behind them", body,
                               SCENE_BODY_NAME_SIZE - 1);
        if (!text_is_utf8(text) || control_in_text(text) != 0)
            return error_input(error, path, "body %d: its name must be UTF-8 without control characters", body);
    }
    if (!finite(t->camera_center) || !finite(t->camera_size) || t->camera_size.x < 0 || t->camera_size.y < 0)
        return error_input(error, path, "the camera's window must be finite and not negative");
    for (int body = 0; body < t->bodies; body++) {
        const Vec2 size = t->size[body];
        if (!finite(size) || !(size.x > 0) || !(size.y > 0))
            return error_input(error, path, "body %d: its size must be finite and greater than 0 (got %g x %g)", body,
                               (double)size.x, (double)size.y);
        if (t->fixed[body] > 1)
            return error_input(error, path, "body %d: 'fixed' must be 0 or 1 (got %d)", body, t->fixed[body]);
        if (!t->fixed[body] && (isinf(t->mass[body]) || t->mass[body] <= 0))
            return error_input(error, path, "body %d: its mass must be finite and greater than 0 (got %g)", body,
                               (double)t->mass[body]);
    }
    const unsigned control = control_in_text(t->verdict);
    if (control != 0) return error_input(error, path, "the verdict has the control character U+%04X", control);
    if (t->verdict_frame < -1 || t->verdict_frame >= t->frames)
        return error_input(error, path, "the verdict is on frame %d of %d", t->verdict_frame, t->frames);
    return (t->verdict_body >= -1 && t->verdict_body < t->bodies) ||
           error_input(error, path, "the verdict is on body %d of %d", t->verdict_body, t->bodies);
}

/* The state of a body in a frame: finite numbers if it exists, else NaN. A body exists in one interval of frames; a
   static body, which is drawn once, until the end. */
static bool check_state(const Trajectory *t, int frame, int body, const char *path, Error *error) {
    const size_t i = trajectory_at(t, frame, body);
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
    const bool before = frame > 0 && trajectory_has(t, frame - 1, body), now = trajectory_has(t, frame, body);
    if (before && !now && t->fixed[body])
        return error_input(error, path, "frame %d, body %d: a static body must not be removed", frame, body);
    for (int earlier = frame - 2; !before && now && earlier >= 0; earlier--)
        if (trajectory_has(t, earlier, body))
            return error_input(error, path, "frame %d, body %d: a removed body must not reappear", frame, body);
    return true;
}

bool trajectory_check(const Trajectory *t, const char *path, Error *error) {
    if (!check_head(t, path, error)) return false;
    for (int frame = 0; frame < t->frames; frame++) {
        for (int body = 0; body < t->bodies; body++)
            if (!check_state(t, frame, body, path, error)) return false;
        /* A step's contacts are of bodies that existed before it. */
        for (int64_t i = t->contact_start[frame]; i < t->contact_start[frame + 1]; i++) {
            const TrajectoryContact *contact = &t->contacts[i];
            if (contact->a < 0 || contact->a >= contact->b || contact->b >= t->bodies ||
                !trajectory_has(t, frame - 1, contact->a) || !trajectory_has(t, frame - 1, contact->b))
                return error_input(error, path, "step %d, contact %lld: bodies %d and %d are not an existing pair",
                                   frame, (long long)i, (int)contact->a, (int)contact->b);
            if (!finite(contact->point) || !finite(contact->normal) || !isfinite(contact->normal_impulse) ||
                !isfinite(contact->tangent_impulse))
                return error_input(error, path, "step %d, contact %lld: a number is NaN or infinite", frame,
                                   (long long)i);
        }
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
    {"network_hash", NPZ_UINT64, 0, {0}, GROUP_NONE},
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

/* False with error set if the file is one of another kind or version, lacks a needed array, has a part of those that
   only come together, or has an unknown array that looks like one that it lacks: then the error suggests that name.
   Other unknown arrays are ignored. */
static bool check_arrays(NpzFile *file, Error *error) {
    static const char *const needed[] = {"position", "angle", "size", "dt"};
    const char *path = npz_path(file), *name, *missing[RUN_ARRAYS], *right, *lacking = NULL;
    char kind[64];
    int32_t version = TRAJECTORY_VERSION;
    int lacks = 0, found = 0;
    Error ignored = {0};
    if (npz_shape(file, "kind", NPZ_TEXT, 0, NULL, &ignored)) /* other files of twinbox state their kind */
        return npz_read_name(file, "kind", kind, sizeof kind, error) &&
               error_input(error, path, "not a trajectory but a file of kind '%s'", kind);

    /* A wrong name is the likely cause of a missing array, so it is told first. */
    for (int i = 0; i < RUN_ARRAYS; i++)
        if (!npz_has(file, run_arrays[i].name)) missing[lacks++] = run_arrays[i].name;
    for (size_t i = 0; (name = npz_name(file, i)) != NULL; i++) {
        bool known = false;
        for (int k = 0; k < RUN_ARRAYS; k++) known = known || strcmp(run_arrays[k].name, name) == 0;
        if (!known && strlen(name) > 3 && (right = nearest_word(name, missing, lacks)) != NULL)
            return error_input(error, path, "unknown array '%s': did you mean '%s'? Rename or remove it", name, right);
    }
    for (int i = 3; i >= 0; i--) {
        found += npz_has(file, needed[i]);
        if (!npz_has(file, needed[i])) lacking = needed[i];
    }
    if (lacking != NULL)
        return error_input(error, path, "%shas no array '%s'; a trajectory needs position, angle, size and dt",
                           found == 0 ? "not a trajectory: " : "", lacking);
    for (int i = 0; i < RUN_ARRAYS; i++)
        for (int k = 0; k < RUN_ARRAYS && run_arrays[i].group != GROUP_NONE; k++)
            if (run_arrays[i].group == run_arrays[k].group && npz_has(file, run_arrays[i].name) &&
                !npz_has(file, run_arrays[k].name))
                return error_input(error, path, "has '%s' but not '%s'; give both, or none of %s", run_arrays[i].name,
                                   run_arrays[k].name, group_words[run_arrays[i].group]);
    if (npz_has(file, "version") && !npz_read_scalar(file, "version", NPZ_INT32, &version, sizeof version, error))
        return false;
    return version == TRAJECTORY_VERSION ||
           error_input(error, path, "trajectory of version %d; expected version %d", (int)version, TRAJECTORY_VERSION);
}

/* Frames, bodies and contacts, by which the shapes of all arrays must agree. */
static bool read_counts(Trajectory *t, const NpzFile *file, const char *path, int64_t *contacts, Error *error) {
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
    for (int i = 0; i < RUN_ARRAYS; i++) {
        NpzArray array = {run_arrays[i].name, run_arrays[i].type, run_arrays[i].rank, {0}, NULL};
        run_array_shape(&run_arrays[i], t->frames, t->bodies, *contacts, array.shape);
        if (npz_has(file, array.name) && !npz_expect(file, &array, 1, error)) return false;
    }
    return true;
}

/* What a file need not have keeps its value. */
static bool read_if_there(NpzFile *file, const char *name, NpzType type, void *value, size_t size, Error *error) {
    return !npz_has(file, name) || npz_read_scalar(file, name, type, value, size, error);
}

static bool read_name_if_there(NpzFile *file, const char *name, char text[TRAJECTORY_NAME_SIZE], Error *error) {
    return !npz_has(file, name) || npz_read_name(file, name, text, TRAJECTORY_NAME_SIZE, error);
}

static bool read_head(Trajectory *t, NpzFile *file, const char *path, Error *error) {
    int32_t bomb = -1, iterations = 0, frame = -1, body = -1;
    const int64_t two_by_two[] = {2, 2};
    trajectory_name_from_path(path, t->scene);
    trajectory_name_from_path(path, t->method);
    if (!read_name_if_there(file, "scene", t->scene, error) || !read_name_if_there(file, "method", t->method, error) ||
        !read_name_if_there(file, "program", t->program, error) ||
        (npz_has(file, "verdict") && !npz_read_text(file, "verdict", t->verdict, sizeof t->verdict, error)) ||
        !read_if_there(file, "verdict_frame", NPZ_INT32, &frame, sizeof frame, error) ||
        !read_if_there(file, "verdict_body", NPZ_INT32, &body, sizeof body, error) ||
        !read_if_there(file, "scene_hash", NPZ_UINT64, &t->scene_hash, sizeof t->scene_hash, error) ||
        !read_if_there(file, "network_hash", NPZ_UINT64, &t->network_hash, sizeof t->network_hash, error) ||
        !read_if_there(file, "iterations", NPZ_INT32, &iterations, sizeof iterations, error) ||
        !npz_read_scalar(file, "dt", NPZ_FLOAT32, &t->dt, sizeof t->dt, error) ||
        !read_if_there(file, "bomb", NPZ_INT32, &bomb, sizeof bomb, error))
        return false;
    t->verdict_frame = frame;
    t->verdict_body = body;
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

void trajectory_guess_fixed(Trajectory *t) {
    for (int body = 0; body < t->bodies; body++) {
        bool moves = t->frames < 2;
        for (int frame = 0; !moves && frame < t->frames; frame++) {
            const size_t i = trajectory_at(t, frame, body), first = (size_t)body;
            moves = !trajectory_has(t, frame, body) ||
                    memcmp(&t->position[i], &t->position[first], sizeof(Vec2)) != 0 ||
                    memcmp(&t->angle[i], &t->angle[first], sizeof(float)) != 0;
        }
        t->fixed[body] = !moves;
    }
}

/* Of numbers that float32 does not hold, at least in one array, all are kept as float64. */
static bool read_exact(Trajectory *t, NpzFile *file, const char *path, Error *error) {
    const size_t states = (size_t)t->frames * (size_t)t->bodies;
    const int last = t->no_velocities ? ARRAY_ANGLE : ARRAY_ANGULAR_VELOCITY;
    bool wide = false;
    for (int i = ARRAY_POSITION; i <= last; i++) wide = wide || npz_is_wide(file, run_arrays[i].name);
    if (!wide) return true;
    if ((t->exact = malloc((STATE_COLUMNS * states + 1) * sizeof *t->exact)) == NULL) return error_memory(error, path);
    for (size_t i = 0; i < STATE_COLUMNS * states; i++) t->exact[i] = NAN;
    for (int i = ARRAY_POSITION, column = 0; i <= last; column += run_arrays[i++].rank - 1) {
        int64_t shape[NPZ_MAX_RANK];
        run_array_shape(&run_arrays[i], t->frames, t->bodies, 0, shape);
        double *numbers = npz_read(file, run_arrays[i].name, NPZ_FLOAT64, run_arrays[i].rank, shape, error);
        if (numbers == NULL) return false;
        memcpy(t->exact + trajectory_exact_at(t, 0, column), numbers,
               (size_t)(run_arrays[i].rank - 1) * states * sizeof *numbers);
        free(numbers);
    }
    return true;
}

/* Bodies and their states. What is unknown is NaN; which bodies are static is guessed. */
static bool read_bodies(Trajectory *t, NpzFile *file, const char *path, Error *error) {
    const int64_t vectors[] = {t->frames, t->bodies, 2}, per_body[] = {t->bodies, 2},
                  names[] = {t->bodies, SCENE_BODY_NAME_SIZE};
    const size_t bodies = (size_t)t->bodies, poses = (size_t)t->frames * bodies;
    if ((t->size = npz_read(file, "size", NPZ_FLOAT32, 2, per_body, error)) == NULL ||
        (t->position = npz_read(file, "position", NPZ_FLOAT32, 3, vectors, error)) == NULL ||
        (t->angle = npz_read(file, "angle", NPZ_FLOAT32, 2, vectors, error)) == NULL)
        return false;
    if (npz_has(file, "fixed")) {
        if ((t->fixed = npz_read(file, "fixed", NPZ_UINT8, 1, per_body, error)) == NULL) return false;
    } else {
        if ((t->fixed = calloc(bodies + 1, sizeof *t->fixed)) == NULL) return error_memory(error, path);
        trajectory_guess_fixed(t);
        t->fixed_guessed = true;
    }
    if (npz_has(file, "mass")) {
        if ((t->mass = npz_read(file, "mass", NPZ_FLOAT32, 1, per_body, error)) == NULL) return false;
    } else {
        if ((t->mass = malloc((bodies + 1) * sizeof *t->mass)) == NULL) return error_memory(error, path);
        for (size_t body = 0; body < bodies; body++) t->mass[body] = NAN;
    }
    if (npz_has(file, "body_name") && (t->name = npz_read(file, "body_name", NPZ_UINT8, 2, names, error)) == NULL)
        return false;
    if (!read_exact(t, file, path, error)) return false;
    if (!t->no_velocities)
        return (t->velocity = npz_read(file, "velocity", NPZ_FLOAT32, 3, vectors, error)) != NULL &&
               (t->angular_velocity = npz_read(file, "angular_velocity", NPZ_FLOAT32, 2, vectors, error)) != NULL;
    t->velocity = malloc((poses + 1) * sizeof *t->velocity);
    t->angular_velocity = malloc((poses + 1) * sizeof *t->angular_velocity);
    if (t->velocity == NULL || t->angular_velocity == NULL) return error_memory(error, path);
    for (size_t i = 0; i < poses; i++) {
        t->velocity[i] = vec2(NAN, NAN);
        t->angular_velocity[i] = NAN;
    }
    return true;
}

static bool read_contacts(Trajectory *t, NpzFile *file, const char *path, int64_t count, Error *error) {
    typedef TrajectoryContact C;
    _Static_assert(offsetof(C, b) == offsetof(C, a) + sizeof(int32_t), "a and b are copied as a pair");
    _Static_assert(offsetof(C, tangent_impulse) == offsetof(C, normal_impulse) + sizeof(float), "and the impulses");
    static const struct {
        int array;
        size_t member, size;
    } parts[] = {{ARRAY_CONTACT_BODIES, offsetof(C, a), 8},
                 {ARRAY_CONTACT_FEATURE, offsetof(C, feature), 4},
                 {ARRAY_CONTACT_POINT, offsetof(C, point), 8},
                 {ARRAY_CONTACT_NORMAL, offsetof(C, normal), 8},
                 {ARRAY_CONTACT_IMPULSE, offsetof(C, normal_impulse), 8}};
    const int64_t steps = (int64_t)t->frames + 1, shape[] = {count, 2};
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
    /* Files have one array per quantity. Each is freed before the next is read. */
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        const RunArray *array = &run_arrays[parts[k].array];
        char *data = npz_read(file, array->name, array->type, array->rank, shape, error);
        if (data == NULL) return false;
        for (int64_t i = 0; i < count; i++)
            memcpy((char *)&t->contacts[i] + parts[k].member, data + (size_t)i * parts[k].size, parts[k].size);
        free(data);
    }
    return true;
}

Trajectory *trajectory_read(const char *path, Error *error) {
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return NULL;
    npz_convert(file);
    Trajectory *t = calloc(1, sizeof *t);
    int64_t contacts = 0;
    bool done = t != NULL || error_memory(error, path);
    done = done && check_arrays(file, error) && read_counts(t, file, path, &contacts, error) &&
           read_head(t, file, path, error) && read_bodies(t, file, path, error) &&
           read_contacts(t, file, path, contacts, error) && trajectory_check(t, path, error);
    npz_close(file);
    if (done)
        trace_line("run %s: %s by %s, %d frames of %d bodies, step %g s, scene hash %016" PRIx64, path, t->scene,
                   t->method, t->frames, t->bodies, (double)t->dt, t->scene_hash);
    if (done) return t;
    trajectory_destroy(t);
    return NULL;
}
