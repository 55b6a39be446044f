/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes trajectories to files. */
#include "common/file.h"
#include "common/npz.h"
#include "trajectory/trajectory_arrays.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

void contact_arrays_free(ContactArrays *arrays) {
    free(arrays->bodies);
    free(arrays->feature);
    free(arrays->point);
    free(arrays->normal);
    free(arrays->impulse);
}

static bool split_contacts(ContactArrays *arrays, const TrajectoryContact *contacts, size_t count) {
    size_t room = count > 0 ? count : 1;
    arrays->bodies = calloc(room, sizeof *arrays->bodies);
    arrays->feature = calloc(room, sizeof *arrays->feature);
    arrays->point = calloc(room, sizeof *arrays->point);
    arrays->normal = calloc(room, sizeof *arrays->normal);
    arrays->impulse = calloc(room, sizeof *arrays->impulse);
    if (arrays->bodies == NULL || arrays->feature == NULL || arrays->point == NULL || arrays->normal == NULL ||
        arrays->impulse == NULL)
        return false;
    for (size_t i = 0; i < count; i++) {
        arrays->bodies[i][0] = contacts[i].a;
        arrays->bodies[i][1] = contacts[i].b;
        arrays->feature[i] = contacts[i].feature;
        arrays->point[i] = contacts[i].point;
        arrays->normal[i] = contacts[i].normal;
        arrays->impulse[i][0] = contacts[i].normal_impulse;
        arrays->impulse[i][1] = contacts[i].tangent_impulse;
    }
    return true;
}

static bool is_known(const Trajectory *t, const char *name) {
    if (strcmp(name, "velocity") == 0 || strcmp(name, "angular_velocity") == 0) return !t->no_velocities;
    return !t->no_contacts || strncmp(name, "contact_", strlen("contact_")) != 0;
}

/* Removes what is unknown; returns how many are left. */
static size_t keep_known(const Trajectory *t, NpzArray *arrays, size_t count) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (is_known(t, arrays[i].name)) arrays[kept++] = arrays[i];
    return kept;
}

static bool write_arrays(const Trajectory *t, const ContactArrays *contact, const char *path, Error *error) {
    int64_t frames = t->frames, bodies = t->bodies, contacts = t->contact_start[t->frames];
    int32_t version = TRAJECTORY_VERSION, bomb = t->bomb;
    Vec2 camera[2] = {t->camera_center, t->camera_size};
    NpzArray arrays[] = {
        {"version", NPZ_INT32, 0, {0}, &version},
        {"scene", NPZ_TEXT, 0, {0}, t->scene},
        {"method", NPZ_TEXT, 0, {0}, t->method},
        {"scene_hash", NPZ_UINT64, 0, {0}, &t->scene_hash},
        {"dt", NPZ_FLOAT32, 0, {0}, &t->dt},
        {"bomb", NPZ_INT32, 0, {0}, &bomb},
        {"camera", NPZ_FLOAT32, 2, {2, 2}, camera},
        {"size", NPZ_FLOAT32, 2, {bodies, 2}, t->size},
        {"fixed", NPZ_UINT8, 1, {bodies}, t->fixed},
        {"position", NPZ_FLOAT32, 3, {frames, bodies, 2}, t->position},
        {"angle", NPZ_FLOAT32, 2, {frames, bodies}, t->angle},
        {"velocity", NPZ_FLOAT32, 3, {frames, bodies, 2}, t->velocity},
        {"angular_velocity", NPZ_FLOAT32, 2, {frames, bodies}, t->angular_velocity},
        {"contact_start", NPZ_INT64, 1, {frames + 1}, t->contact_start},
        {"contact_bodies", NPZ_INT32, 2, {contacts, 2}, contact->bodies},
        {"contact_feature", NPZ_UINT32, 1, {contacts}, contact->feature},
        {"contact_point", NPZ_FLOAT32, 2, {contacts, 2}, contact->point},
        {"contact_normal", NPZ_FLOAT32, 2, {contacts, 2}, contact->normal},
        {"contact_impulse", NPZ_FLOAT32, 2, {contacts, 2}, contact->impulse},
    };
    return npz_write(path, arrays, keep_known(t, arrays, sizeof arrays / sizeof arrays[0]), error);
}

bool trajectory_write(const Trajectory *t, const char *path, Error *error) {
    ContactArrays arrays = {0};
    bool done = split_contacts(&arrays, t->contacts, (size_t)t->contact_start[t->frames])
                    ? write_arrays(t, &arrays, path, error)
                    : error_memory(error, path);
    contact_arrays_free(&arrays);
    return done;
}

static void print_csv(FILE *out, const void *context) {
    const Trajectory *t = context;
    fprintf(out, "frame,body,x,y,angle,vx,vy,omega\n");
    for (int frame = 0; frame < t->frames; frame++) {
        for (int body = 0; body < t->bodies; body++) {
            if (t->fixed[body] || !trajectory_has(t, frame, body)) continue;
            size_t i = (size_t)frame * (size_t)t->bodies + (size_t)body;
            fprintf(out, "%d,%d,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", frame, body, (double)t->position[i].x,
                    (double)t->position[i].y, (double)t->angle[i], (double)t->velocity[i].x, (double)t->velocity[i].y,
                    (double)t->angular_velocity[i]);
        }
    }
}

static void print_hashes(FILE *out, const void *context) {
    const Trajectory *t = context;
    fprintf(out, "frame,hash\n");
    for (int frame = 0; frame < t->frames; frame++)
        fprintf(out, "%d,%016" PRIx64 "\n", frame, trajectory_frame_hash(t, frame));
}

bool trajectory_write_csv(const Trajectory *t, const char *path, Error *error) {
    return file_write_text(path, print_csv, t, error);
}

bool trajectory_write_hashes(const Trajectory *t, const char *path, Error *error) {
    return file_write_text(path, print_hashes, t, error);
}
