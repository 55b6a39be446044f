/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run as .npz, CSV or hashes, part by part. */
#include "base/base.h"
#include "base/file.h"
#include "base/npz.h"
#include "engine/engine.h"
#include "runs/runs.h"
#include "runs/runs_internal.h"
#include "runs/trajectory.h"

#include <assert.h>
#include <errno.h>
#include <inttypes.h>
#include <locale.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Contacts that are split at a time; their arrays stay in the cache. */
enum { BLOCK = 1024 };

/* Contacts as the file has them: one array per quantity. */
typedef struct Block {
    int32_t bodies[BLOCK][2];
    uint32_t feature[BLOCK];
    Vec2 point[BLOCK], normal[BLOCK];
    float impulse[BLOCK][2];
} Block;

struct TrajectoryStream {
    const Trajectory *head;
    TrajectoryFormat format;
    char *path;
    int frames, added;
    NpzStream *npz;
    int array[RUN_ARRAYS]; /* numbers in it; -1: not in this file */
    bool begun;
    int64_t contacts; /* so far */
    double bytes;     /* of all arrays so far */
    Block block;
    /* Or, for text: */
    int draft; /* -1: none */
    FILE *out; /* to the draft */
};

/* Of arrays without data, rows are counted as they come. */
static bool add_array(TrajectoryStream *stream, int array, const void *data, Error *error) {
    const RunArray *run_array = &run_arrays[array];
    const bool exact = stream->head->exact != NULL && array >= ARRAY_POSITION && array <= ARRAY_ANGULAR_VELOCITY;
    NpzArray added = {run_array->name, exact ? NPZ_FLOAT64 : run_array->type, run_array->rank, {0}, data};
    run_array_shape(run_array, 0, stream->head->bodies, 0, added.shape);
    if (data == NULL) added.shape[0] = 0;
    return (stream->array[array] = npz_stream_add(stream->npz, &added, error)) >= 0;
}

static bool begin_npz(TrajectoryStream *stream, Error *error) {
    static const int32_t version = TRAJECTORY_VERSION;
    const Trajectory *head = stream->head;
    static_assert(offsetof(Trajectory, camera_size) == offsetof(Trajectory, camera_center) + sizeof(Vec2), "one array");
    const void *const known[ARRAY_POSITION] = {[ARRAY_VERSION] = &version,
                                               [ARRAY_SCENE] = head->scene,
                                               [ARRAY_METHOD] = head->method,
                                               [ARRAY_SCENE_HASH] = &head->scene_hash,
                                               [ARRAY_DT] = &head->dt,
                                               [ARRAY_ITERATIONS] = head->iterations > 0 ? &head->iterations : NULL,
                                               [ARRAY_BOMB] = &head->bomb,
                                               [ARRAY_CAMERA] = &head->camera_center,
                                               [ARRAY_SIZE] = head->size,
                                               [ARRAY_FIXED] = head->fixed_guessed ? NULL : head->fixed,
                                               [ARRAY_MASS] = trajectory_has_masses(head) ? head->mass : NULL,
                                               [ARRAY_BODY_NAME] = head->name};
    stream->npz = npz_stream_create(stream->path, RUN_ARRAYS, error);
    if (stream->npz == NULL) return false;
    for (int i = 0; i < RUN_ARRAYS; i++) stream->array[i] = -1;
    for (int i = 0; i < ARRAY_POSITION; i++)
        if (known[i] != NULL && !add_array(stream, i, known[i], error)) return false;
    for (int i = ARRAY_POSITION; i < ARRAY_PROGRAM; i++) {
        const int group = run_arrays[i].group;
        const bool unknown =
            group == GROUP_CONTACTS ? head->no_contacts : group == GROUP_VELOCITIES && head->no_velocities;
        if (!unknown && !add_array(stream, i, NULL, error)) return false;
    }
    return true;
}

static bool append(TrajectoryStream *stream, int array, const void *rows, int64_t count, Error *error) {
    return stream->array[array] < 0 || npz_stream_append(stream->npz, stream->array[array], rows, count, error);
}

static bool add_contacts(TrajectoryStream *stream, const Trajectory *part, Error *error) {
    Block *block = &stream->block;
    const int64_t all = part->contact_start[part->frames];
    for (int frame = stream->begun ? 1 : 0; frame <= part->frames; frame++) {
        const int64_t start = stream->contacts + part->contact_start[frame];
        if (!append(stream, ARRAY_CONTACT_START, &start, 1, error)) return false;
    }
    stream->begun = true;
    for (int64_t first = 0; first < all; first += BLOCK) {
        const TrajectoryContact *contacts = part->contacts + first;
        const int64_t count = all - first < BLOCK ? all - first : BLOCK;
        for (int64_t i = 0; i < count; i++) {
            block->bodies[i][0] = contacts[i].a;
            block->bodies[i][1] = contacts[i].b;
            block->feature[i] = contacts[i].feature;
            block->point[i] = contacts[i].point;
            block->normal[i] = contacts[i].normal;
            block->impulse[i][0] = contacts[i].normal_impulse;
            block->impulse[i][1] = contacts[i].tangent_impulse;
        }
        if (!append(stream, ARRAY_CONTACT_BODIES, block->bodies, count, error) ||
            !append(stream, ARRAY_CONTACT_FEATURE, block->feature, count, error) ||
            !append(stream, ARRAY_CONTACT_POINT, block->point, count, error) ||
            !append(stream, ARRAY_CONTACT_NORMAL, block->normal, count, error) ||
            !append(stream, ARRAY_CONTACT_IMPULSE, block->impulse, count, error))
            return false;
    }
    stream->contacts += all;
    return true;
}

static const char *const text_heads[] = {
    [TRAJECTORY_CSV] = "frame,body,x,y,angle,vx,vy,omega\n", [TRAJECTORY_HASHES] = "frame,hash\n"};

static bool text_failed(const TrajectoryStream *stream, Error *error) {
    return error_system(error, stream->path, "cannot write: %s", strerror(errno));
}

TrajectoryStream *trajectory_stream_create(const Trajectory *head, int frames, TrajectoryFormat format,
                                           const char *path, Error *error) {
    TrajectoryStream *stream = calloc(1, sizeof *stream);
    char *name = strdup(path);
    if (stream == NULL || name == NULL) {
        free(stream);
        free(name);
        error_memory(error, path);
        return NULL;
    }
    *stream = (TrajectoryStream){.head = head, .format = format, .path = name, .frames = frames, .draft = -1};
    if (format == TRAJECTORY_NPZ) {
        if (begin_npz(stream, error)) return stream;
    } else if ((stream->draft = file_draft(path, error)) >= 0) {
        const int copy = dup(stream->draft);
        stream->out = copy >= 0 ? fdopen(copy, "w") : NULL;
        if (stream->out == NULL && copy >= 0) close(copy);
        if (stream->out != NULL && fputs(text_heads[format], stream->out) >= 0) return stream;
        text_failed(stream, error);
    }
    trajectory_stream_destroy(stream);
    return NULL;
}

void trajectory_stream_destroy(TrajectoryStream *stream) {
    if (stream == NULL) return;
    npz_stream_destroy(stream->npz);
    if (stream->out != NULL) fclose(stream->out);
    if (stream->draft >= 0) close(stream->draft);
    free(stream->path);
    free(stream);
}

/* With the C locale's decimal point. */
static bool print_part(TrajectoryStream *stream, const Trajectory *t, Error *error) {
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (c == (locale_t)0) return error_memory(error, stream->path);
    locale_t previous = uselocale(c);
    for (int frame = 0; frame < t->frames; frame++) {
        const int number = stream->added + frame;
        if (stream->format == TRAJECTORY_HASHES)
            fprintf(stream->out, "%d,%016" PRIx64 "\n", number, trajectory_frame_hash(t, frame));
        for (int body = 0; stream->format == TRAJECTORY_CSV && body < t->bodies; body++) {
            if (t->fixed[body] || !trajectory_has(t, frame, body)) continue;
            const size_t i = trajectory_at(t, frame, body);
            fprintf(stream->out, "%d,%d,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", number, body, (double)t->position[i].x,
                    (double)t->position[i].y, (double)t->angle[i], (double)t->velocity[i].x, (double)t->velocity[i].y,
                    (double)t->angular_velocity[i]);
        }
    }
    uselocale(previous);
    freelocale(c);
    return !ferror(stream->out) || text_failed(stream, error);
}

bool trajectory_stream_add(TrajectoryStream *stream, const Trajectory *part, Error *error) {
    const int64_t frames = part->frames;
    assert(stream->added + part->frames <= stream->frames);
    if (stream->npz == NULL) {
        if (!print_part(stream, part, error)) return false;
    } else {
        stream->bytes += trajectory_bytes(part);
        if (stream->bytes > TRAJECTORY_MAX_BYTES)
            return error_input(error, stream->path, "the run takes more than 2 GiB");
        const void *const states[] = {part->position, part->angle, part->velocity, part->angular_velocity};
        static const int columns[] = {0, 2, 3, 5};
        for (int i = 0; i < 4; i++) {
            const double *exact = part->exact == NULL ? NULL : part->exact + trajectory_exact_at(part, 0, columns[i]);
            if (!append(stream, ARRAY_POSITION + i, exact != NULL ? exact : states[i], frames, error)) return false;
        }
        if (!stream->head->no_contacts && !add_contacts(stream, part, error)) return false;
    }
    stream->added += part->frames;
    return true;
}

bool trajectory_stream_finish(TrajectoryStream *stream, Error *error) {
    const Trajectory *head = stream->head;
    assert(stream->added == stream->frames);
    if (stream->npz == NULL) {
        FILE *out = stream->out;
        stream->out = NULL;
        if (fclose(out) != 0) return text_failed(stream, error);
        return file_draft_publish(stream->draft, stream->path, error);
    }
    /* The last arrays of the file: what is known after the run. */
    if (head->program[0] != '\0' && !add_array(stream, ARRAY_PROGRAM, head->program, error)) return false;
    if (head->network_hash != 0 && !add_array(stream, ARRAY_NETWORK_HASH, &head->network_hash, error)) return false;
    if (head->verdict[0] != '\0' && (!add_array(stream, ARRAY_VERDICT, head->verdict, error) ||
                                     !add_array(stream, ARRAY_VERDICT_FRAME, &head->verdict_frame, error) ||
                                     !add_array(stream, ARRAY_VERDICT_BODY, &head->verdict_body, error)))
        return false;
    return npz_stream_finish(stream->npz, error);
}

bool trajectory_write(const Trajectory *t, const char *path, Error *error) {
    TrajectoryStream *stream = trajectory_stream_create(t, t->frames, TRAJECTORY_NPZ, path, error);
    bool done = stream != NULL && trajectory_stream_add(stream, t, error) && trajectory_stream_finish(stream, error);
    trajectory_stream_destroy(stream);
    return done;
}
