/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A trajectory as .npz, part by part. */
#include "base/base.h"
#include "base/file.h"
#include "base/npz.h"
#include "engine/engine.h"
#include "runs/internal.h"
#include "runs/trajectory.h"

#include <assert.h>
#include <errno.h>
#include <inttypes.h>
#include <locale.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct TrajectoryNpz TrajectoryNpz;

/* The arrays that grow, in the order of the file. */
enum { POSITION, ANGLE, VELOCITY, ANGULAR_VELOCITY, CONTACT_START, BODIES, FEATURE, POINT, NORMAL, IMPULSE, GROWING };

/* Those that do not. */
enum { KNOWN = 10, LAST = 4 };

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
    char scene[TRAJECTORY_NAME_SIZE], method[TRAJECTORY_NAME_SIZE], program[TRAJECTORY_NAME_SIZE];
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

static void trajectory_npz_destroy(TrajectoryNpz *npz) {
    if (npz == NULL) return;
    npz_stream_destroy(npz->stream);
    free(npz->size);
    free(npz->fixed);
    free(npz);
}

/* Instead of the head's verdict. */
static void trajectory_npz_judge(TrajectoryNpz *npz, const char *words, int frame, int body) {
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
    memcpy(npz->program, head->program, sizeof npz->program);
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

static bool trajectory_npz_is_known(const TrajectoryNpz *npz, int array) {
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
        if (trajectory_npz_is_known(npz, i) && (npz->array[i] = npz_stream_add(npz->stream, &growing[i], error)) < 0)
            return false;
    return true;
}

static TrajectoryNpz *trajectory_npz_create(const Trajectory *head, const char *path, Error *error) {
    TrajectoryNpz *npz = calloc(1, sizeof *npz);
    bool done = (npz != NULL && copy_head(npz, head)) || error_memory(error, path);
    if (done) snprintf(npz->path, sizeof npz->path, "%s", path);
    done = done && (npz->stream = npz_stream_create(path, KNOWN + GROWING + LAST, error)) != NULL &&
           add_arrays(npz, error);
    if (done) return npz;
    trajectory_npz_destroy(npz);
    return NULL;
}

static bool append(TrajectoryNpz *npz, int array, const void *rows, int64_t count, Error *error) {
    return !trajectory_npz_is_known(npz, array) ||
           npz_stream_append(npz->stream, npz->array[array], rows, count, error);
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

static bool trajectory_npz_add(TrajectoryNpz *npz, const Trajectory *part, Error *error) {
    const int64_t frames = part->frames;
    npz->bytes += trajectory_bytes(part);
    if (npz->bytes > TRAJECTORY_MAX_BYTES) return error_input(error, npz->path, "the run takes more than 2 GiB");
    return append(npz, POSITION, part->position, frames, error) && append(npz, ANGLE, part->angle, frames, error) &&
           append(npz, VELOCITY, part->velocity, frames, error) &&
           append(npz, ANGULAR_VELOCITY, part->angular_velocity, frames, error) &&
           (npz->no_contacts || add_contacts(npz, part, error));
}

/* The last arrays of the file: what is known after the run. */
static bool add_last(TrajectoryNpz *npz, Error *error) {
    const NpzArray arrays[LAST] = {
        {"program", NPZ_TEXT, 0, {0}, npz->program},
        {"verdict", NPZ_TEXT, 0, {0}, npz->verdict},
        {"verdict_frame", NPZ_INT32, 0, {0}, &npz->verdict_frame},
        {"verdict_body", NPZ_INT32, 0, {0}, &npz->verdict_body},
    };
    for (int i = 0; i < LAST; i++)
        if ((i == 0 ? npz->program : npz->verdict)[0] != '\0' && npz_stream_add(npz->stream, &arrays[i], error) < 0)
            return false;
    return true;
}

struct TrajectoryStream {
    TrajectoryFormat format;
    char *path;
    int frames, added;
    TrajectoryNpz *npz; /* or, for text: */
    int draft;          /* -1: none */
    FILE *out;          /* to the draft */
};

static const char *const text_heads[] = {
    [TRAJECTORY_CSV] = "frame,body,x,y,angle,vx,vy,omega\n", [TRAJECTORY_HASHES] = "frame,hash\n"};

static bool text_failed(const TrajectoryStream *stream, Error *error) {
    return error_system(error, stream->path, "cannot write: %s", strerror(errno));
}

static bool open_text(TrajectoryStream *stream, Error *error) {
    stream->draft = file_draft(stream->path, error);
    if (stream->draft < 0) return false;
    const int copy = dup(stream->draft);
    stream->out = copy >= 0 ? fdopen(copy, "w") : NULL;
    if (stream->out == NULL && copy >= 0) close(copy);
    return (stream->out != NULL && fputs(text_heads[stream->format], stream->out) >= 0) || text_failed(stream, error);
}

TrajectoryStream *trajectory_stream_create(const Trajectory *head, int frames, TrajectoryFormat format,
                                           const char *path, Error *error) {
    TrajectoryStream *stream = calloc(1, sizeof *stream);
    char *name = strdup(path);
    bool done = stream != NULL && name != NULL;
    if (!done) {
        free(stream);
        free(name);
        error_memory(error, path);
        return NULL;
    }
    *stream = (TrajectoryStream){.format = format, .path = name, .frames = frames, .draft = -1};
    if (format == TRAJECTORY_NPZ)
        done = (stream->npz = trajectory_npz_create(head, path, error)) != NULL;
    else
        done = open_text(stream, error);
    if (done) return stream;
    trajectory_stream_destroy(stream);
    return NULL;
}

void trajectory_stream_destroy(TrajectoryStream *stream) {
    if (stream == NULL) return;
    trajectory_npz_destroy(stream->npz);
    if (stream->out != NULL) fclose(stream->out);
    if (stream->draft >= 0) close(stream->draft);
    free(stream->path);
    free(stream);
}

static void print_states(FILE *out, const Trajectory *t, int first) {
    for (int frame = 0; frame < t->frames; frame++) {
        for (int body = 0; body < t->bodies; body++) {
            if (t->fixed[body] || !trajectory_has(t, frame, body)) continue;
            size_t i = (size_t)frame * (size_t)t->bodies + (size_t)body;
            fprintf(out, "%d,%d,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", first + frame, body, (double)t->position[i].x,
                    (double)t->position[i].y, (double)t->angle[i], (double)t->velocity[i].x, (double)t->velocity[i].y,
                    (double)t->angular_velocity[i]);
        }
    }
}

static void print_hashes(FILE *out, const Trajectory *t, int first) {
    for (int frame = 0; frame < t->frames; frame++)
        fprintf(out, "%d,%016" PRIx64 "\n", first + frame, trajectory_frame_hash(t, frame));
}

/* With the C locale's decimal point. */
static bool print_part(TrajectoryStream *stream, const Trajectory *part, Error *error) {
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (c == (locale_t)0) return error_memory(error, stream->path);
    locale_t previous = uselocale(c);
    (stream->format == TRAJECTORY_CSV ? print_states : print_hashes)(stream->out, part, stream->added);
    uselocale(previous);
    freelocale(c);
    return !ferror(stream->out) || text_failed(stream, error);
}

bool trajectory_stream_add(TrajectoryStream *stream, const Trajectory *part, Error *error) {
    assert(stream->added + part->frames <= stream->frames);
    bool done = stream->npz != NULL ? trajectory_npz_add(stream->npz, part, error) : print_part(stream, part, error);
    stream->added += part->frames;
    return done;
}

void trajectory_stream_judge(TrajectoryStream *stream, const char *words, int frame, int body) {
    if (stream->npz != NULL) trajectory_npz_judge(stream->npz, words, frame, body);
}

void trajectory_stream_program(TrajectoryStream *stream, const char *program) {
    if (stream->npz != NULL) snprintf(stream->npz->program, sizeof stream->npz->program, "%s", program);
}

bool trajectory_stream_finish(TrajectoryStream *stream, Error *error) {
    assert(stream->added == stream->frames);
    if (stream->npz != NULL) return add_last(stream->npz, error) && npz_stream_finish(stream->npz->stream, error);
    FILE *out = stream->out;
    stream->out = NULL;
    if (fclose(out) != 0) return text_failed(stream, error);
    return file_draft_publish(stream->draft, stream->path, error);
}

static bool write_as(const Trajectory *t, TrajectoryFormat format, const char *path, Error *error) {
    TrajectoryStream *stream = trajectory_stream_create(t, t->frames, format, path, error);
    bool done = stream != NULL && trajectory_stream_add(stream, t, error) && trajectory_stream_finish(stream, error);
    trajectory_stream_destroy(stream);
    return done;
}

bool trajectory_write(const Trajectory *t, const char *path, Error *error) {
    return write_as(t, TRAJECTORY_NPZ, path, error);
}

bool trajectory_write_csv(const Trajectory *t, const char *path, Error *error) {
    return write_as(t, TRAJECTORY_CSV, path, error);
}

bool trajectory_write_hashes(const Trajectory *t, const char *path, Error *error) {
    return write_as(t, TRAJECTORY_HASHES, path, error);
}

/* Arrays that come together or not at all. */
enum { ALONE, VELOCITIES, CONTACTS, RUN_ARRAYS_VERDICT, GROUPS };

static const char *const group_words[GROUPS] = {
    [VELOCITIES] = "the two", [CONTACTS] = "the six contact arrays", [RUN_ARRAYS_VERDICT] = "the three of the verdict"};

static const struct {
    const char *name;
    int group;
    const char *others[8]; /* what other programs call it, where that is not near its name */
} arrays[] = {
    {"version", ALONE, {NULL}},
    {"scene", ALONE, {NULL}},
    {"method", ALONE, {"engine", "solver", "simulator"}},
    {"scene_hash", ALONE, {NULL}},
    {"iterations", ALONE, {NULL}},
    {"dt", ALONE, {"DT", "Dt", "delta_t", "h", "step", "time_step", "timestep"}},
    {"bomb", ALONE, {NULL}},
    {"camera", ALONE, {NULL}},
    {"size", ALONE, {"box_size", "dimensions", "extent", "extents"}},
    {"fixed", ALONE, {"is_static", "static"}},
    {"position", ALONE, {"center", "centers", "centre", "centres", "pos", "xy"}},
    {"angle", ALONE, {"orientation", "orientations", "rot", "rotation", "rotations", "theta"}},
    {"velocity", VELOCITIES, {"linear_velocity", "vel"}},
    {"angular_velocity", VELOCITIES, {"omega", "spin"}},
    {"contact_start", CONTACTS, {NULL}},
    {"contact_bodies", CONTACTS, {NULL}},
    {"contact_feature", CONTACTS, {NULL}},
    {"contact_point", CONTACTS, {NULL}},
    {"contact_normal", CONTACTS, {NULL}},
    {"contact_impulse", CONTACTS, {NULL}},
    {"program", ALONE, {NULL}},
    {"verdict", RUN_ARRAYS_VERDICT, {NULL}},
    {"verdict_frame", RUN_ARRAYS_VERDICT, {NULL}},
    {"verdict_body", RUN_ARRAYS_VERDICT, {NULL}},
};
enum { COUNT = sizeof arrays / sizeof *arrays, OTHERS = sizeof arrays[0].others / sizeof *arrays[0].others };

static bool run_arrays_is_known(const char *name) {
    for (int i = 0; i < COUNT; i++)
        if (strcmp(arrays[i].name, name) == 0) return true;
    return false;
}

static bool is_other_name(const char *name, int array) {
    for (int k = 0; k < OTHERS && arrays[array].others[k] != NULL; k++)
        if (strcmp(arrays[array].others[k], name) == 0) return true;
    return false;
}

/* The array that an unknown name probably means, among those that the file lacks; NULL: none. */
static const char *meant(const NpzFile *file, const char *name) {
    const char *missing[COUNT];
    int count = 0;
    for (int i = 0; i < COUNT; i++) {
        if (npz_has(file, arrays[i].name)) continue;
        if (is_other_name(name, i)) return arrays[i].name;
        missing[count++] = arrays[i].name;
    }
    return strlen(name) > 3 ? nearest_word(name, missing, count) : NULL;
}

static bool check_names(const NpzFile *file, Error *error) {
    const char *name, *right;
    for (size_t i = 0; (name = npz_name(file, i)) != NULL; i++)
        if (!run_arrays_is_known(name) && (right = meant(file, name)) != NULL)
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
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < COUNT && arrays[i].group != ALONE; k++)
            if (arrays[i].group == arrays[k].group && npz_has(file, arrays[i].name) && !npz_has(file, arrays[k].name))
                return error_input(error, npz_path(file), "has '%s' but not '%s'; give both, or none of %s",
                                   arrays[i].name, arrays[k].name, group_words[arrays[i].group]);
    return true;
}

/* Other files of twinbox have a text that states their kind. */
static bool has_kind(const NpzFile *file) {
    Error ignored = {0};
    return npz_shape(file, "kind", NPZ_TEXT, 0, NULL, &ignored);
}

bool run_arrays_check(NpzFile *file, Error *error) {
    char kind[64];
    if (has_kind(file))
        return npz_read_name(file, "kind", kind, sizeof kind, error) &&
               error_input(error, npz_path(file), "not a trajectory but a file of kind '%s'", kind);
    /* A wrong name is the likely cause of a missing array, so it is told first. */
    return check_names(file, error) && check_needed(file, error) && check_groups(file, error);
}
