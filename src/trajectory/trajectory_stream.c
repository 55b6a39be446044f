/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "trajectory/trajectory_stream.h"

#include "common/file.h"
#include "trajectory/trajectory_npz.h"

#include <assert.h>
#include <errno.h>
#include <inttypes.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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

bool trajectory_stream_finish(TrajectoryStream *stream, Error *error) {
    assert(stream->added == stream->frames);
    if (stream->npz != NULL) return trajectory_npz_finish(stream->npz, error);
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
