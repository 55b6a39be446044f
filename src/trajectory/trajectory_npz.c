/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "trajectory/trajectory_npz.h"

#include "common/utf8.h"
#include "npz/npz_stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The arrays that grow, in the order of the file. */
enum { POSITION, ANGLE, VELOCITY, ANGULAR_VELOCITY, CONTACT_START, BODIES, FEATURE, POINT, NORMAL, IMPULSE, GROWING };

/* Those that do not. */
enum { KNOWN = 10, VERDICT = 3 };

/* Contacts that are split at a time; their arrays stay in the cache. */
enum { BLOCK = 1024 };

/* Contacts as the file has them: one array per quantity. */
typedef struct Block {
    int32_t bodies[BLOCK][2];
    uint32_t feature[BLOCK];
    Vec2 point[BLOCK], normal[BLOCK];
    float impulse[BLOCK][2];
} Block;

struct TrajectoryNpz {
    NpzStream *stream;
    int array[GROWING];
    int bodies;
    bool no_velocities, no_contacts, begun;
    int64_t contacts; /* so far */
    double bytes;     /* of all arrays so far */
    char path[512];   /* for messages */
    /* What the stream reads when it is finished: */
    char scene[TRAJECTORY_NAME_SIZE], method[TRAJECTORY_NAME_SIZE];
    uint64_t scene_hash;
    float dt;
    int32_t version, iterations, bomb;
    char verdict[TRAJECTORY_VERDICT_SIZE];
    int32_t verdict_frame, verdict_body;
    Vec2 camera[2];
    Vec2 *size;
    uint8_t *fixed;
    Block block;
};

void trajectory_npz_destroy(TrajectoryNpz *npz) {
    if (npz == NULL) return;
    npz_stream_destroy(npz->stream);
    free(npz->size);
    free(npz->fixed);
    free(npz);
}

void trajectory_npz_judge(TrajectoryNpz *npz, const char *words, int frame, int body) {
    snprintf(npz->verdict, sizeof npz->verdict, "%.*s", (int)utf8_cut(words, sizeof npz->verdict - 1), words);
    npz->verdict_frame = frame;
    npz->verdict_body = body;
}

static bool copy_head(TrajectoryNpz *npz, const Trajectory *head) {
    const size_t bodies = (size_t)head->bodies, room = bodies > 0 ? bodies : 1;
    npz->size = calloc(room, sizeof *npz->size);
    npz->fixed = calloc(room, sizeof *npz->fixed);
    if (npz->size == NULL || npz->fixed == NULL) return false;
    memcpy(npz->size, head->size, bodies * sizeof *npz->size);
    memcpy(npz->fixed, head->fixed, bodies * sizeof *npz->fixed);
    memcpy(npz->scene, head->scene, sizeof npz->scene);
    memcpy(npz->method, head->method, sizeof npz->method);
    npz->scene_hash = head->scene_hash;
    npz->iterations = head->iterations;
    npz->dt = head->dt;
    npz->version = TRAJECTORY_VERSION;
    npz->bomb = head->bomb;
    trajectory_npz_judge(npz, head->verdict, head->verdict_frame, head->verdict_body);
    npz->camera[0] = head->camera_center;
    npz->camera[1] = head->camera_size;
    npz->bodies = head->bodies;
    npz->no_velocities = head->no_velocities;
    npz->no_contacts = head->no_contacts;
    return true;
}

static bool is_known(const TrajectoryNpz *npz, int array) {
    return array >= CONTACT_START                           ? !npz->no_contacts
           : array == VELOCITY || array == ANGULAR_VELOCITY ? !npz->no_velocities
                                                            : true;
}

static bool add_arrays(TrajectoryNpz *npz, Error *error) {
    const int64_t bodies = npz->bodies;
    const NpzArray known[KNOWN] = {
        {"version", NPZ_INT32, 0, {0}, &npz->version},
        {"scene", NPZ_TEXT, 0, {0}, npz->scene},
        {"method", NPZ_TEXT, 0, {0}, npz->method},
        {"scene_hash", NPZ_UINT64, 0, {0}, &npz->scene_hash},
        {"iterations", NPZ_INT32, 0, {0}, &npz->iterations},
        {"dt", NPZ_FLOAT32, 0, {0}, &npz->dt},
        {"bomb", NPZ_INT32, 0, {0}, &npz->bomb},
        {"camera", NPZ_FLOAT32, 2, {2, 2}, npz->camera},
        {"size", NPZ_FLOAT32, 2, {bodies, 2}, npz->size},
        {"fixed", NPZ_UINT8, 1, {bodies}, npz->fixed},
    };
    const NpzArray growing[GROWING] = {
        [POSITION] = {"position", NPZ_FLOAT32, 3, {0, bodies, 2}, NULL},
        [ANGLE] = {"angle", NPZ_FLOAT32, 2, {0, bodies}, NULL},
        [VELOCITY] = {"velocity", NPZ_FLOAT32, 3, {0, bodies, 2}, NULL},
        [ANGULAR_VELOCITY] = {"angular_velocity", NPZ_FLOAT32, 2, {0, bodies}, NULL},
        [CONTACT_START] = {"contact_start", NPZ_INT64, 1, {0}, NULL},
        [BODIES] = {"contact_bodies", NPZ_INT32, 2, {0, 2}, NULL},
        [FEATURE] = {"contact_feature", NPZ_UINT32, 1, {0}, NULL},
        [POINT] = {"contact_point", NPZ_FLOAT32, 2, {0, 2}, NULL},
        [NORMAL] = {"contact_normal", NPZ_FLOAT32, 2, {0, 2}, NULL},
        [IMPULSE] = {"contact_impulse", NPZ_FLOAT32, 2, {0, 2}, NULL},
    };
    for (int i = 0; i < KNOWN; i++)
        if ((known[i].data != &npz->iterations || npz->iterations > 0) &&
            npz_stream_add(npz->stream, &known[i], error) < 0)
            return false;
    for (int i = 0; i < GROWING; i++)
        if (is_known(npz, i) && (npz->array[i] = npz_stream_add(npz->stream, &growing[i], error)) < 0) return false;
    return true;
}

TrajectoryNpz *trajectory_npz_create(const Trajectory *head, const char *path, Error *error) {
    TrajectoryNpz *npz = calloc(1, sizeof *npz);
    bool done = (npz != NULL && copy_head(npz, head)) || error_memory(error, path);
    if (done) snprintf(npz->path, sizeof npz->path, "%s", path);
    done = done && (npz->stream = npz_stream_create(path, KNOWN + GROWING + VERDICT, error)) != NULL &&
           add_arrays(npz, error);
    if (done) return npz;
    trajectory_npz_destroy(npz);
    return NULL;
}

static bool append(TrajectoryNpz *npz, int array, const void *rows, int64_t count, Error *error) {
    return !is_known(npz, array) || npz_stream_append(npz->stream, npz->array[array], rows, count, error);
}

static bool add_block(TrajectoryNpz *npz, const TrajectoryContact *contacts, int64_t count, Error *error) {
    Block *block = &npz->block;
    for (int64_t i = 0; i < count; i++) {
        block->bodies[i][0] = contacts[i].a;
        block->bodies[i][1] = contacts[i].b;
        block->feature[i] = contacts[i].feature;
        block->point[i] = contacts[i].point;
        block->normal[i] = contacts[i].normal;
        block->impulse[i][0] = contacts[i].normal_impulse;
        block->impulse[i][1] = contacts[i].tangent_impulse;
    }
    return append(npz, BODIES, block->bodies, count, error) && append(npz, FEATURE, block->feature, count, error) &&
           append(npz, POINT, block->point, count, error) && append(npz, NORMAL, block->normal, count, error) &&
           append(npz, IMPULSE, block->impulse, count, error);
}

static bool add_contacts(TrajectoryNpz *npz, const Trajectory *part, Error *error) {
    const int64_t count = part->contact_start[part->frames];
    for (int frame = npz->begun ? 1 : 0; frame <= part->frames; frame++) {
        const int64_t start = npz->contacts + part->contact_start[frame];
        if (!append(npz, CONTACT_START, &start, 1, error)) return false;
    }
    npz->begun = true;
    for (int64_t i = 0; i < count; i += BLOCK)
        if (!add_block(npz, part->contacts + i, count - i < BLOCK ? count - i : BLOCK, error)) return false;
    npz->contacts += count;
    return true;
}

bool trajectory_npz_add(TrajectoryNpz *npz, const Trajectory *part, Error *error) {
    const int64_t frames = part->frames;
    npz->bytes += trajectory_bytes(part);
    if (npz->bytes > TRAJECTORY_MAX_BYTES) return error_input(error, npz->path, "the run takes more than 2 GiB");
    return append(npz, POSITION, part->position, frames, error) && append(npz, ANGLE, part->angle, frames, error) &&
           append(npz, VELOCITY, part->velocity, frames, error) &&
           append(npz, ANGULAR_VELOCITY, part->angular_velocity, frames, error) &&
           (npz->no_contacts || add_contacts(npz, part, error));
}

/* The last arrays of the file: a verdict is known after the run. */
static bool add_verdict(TrajectoryNpz *npz, Error *error) {
    const NpzArray arrays[VERDICT] = {
        {"verdict", NPZ_TEXT, 0, {0}, npz->verdict},
        {"verdict_frame", NPZ_INT32, 0, {0}, &npz->verdict_frame},
        {"verdict_body", NPZ_INT32, 0, {0}, &npz->verdict_body},
    };
    for (int i = 0; i < VERDICT && npz->verdict[0] != '\0'; i++)
        if (npz_stream_add(npz->stream, &arrays[i], error) < 0) return false;
    return true;
}

bool trajectory_npz_finish(TrajectoryNpz *npz, Error *error) {
    return add_verdict(npz, error) && npz_stream_finish(npz->stream, error);
}
