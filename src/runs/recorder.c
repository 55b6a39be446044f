/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Records a run while it is stepped, and writes it in parts by a second thread. */
#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/machine.h"
#include "base/npz.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/programs.h"
#include "runs/runs.h"
#include "runs/runs_internal.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* Of a part, poses and contacts each. Smaller parts make the two threads wait for each other more often: with a quarter
   of it, writing took half as long again. */
enum { PART_BYTES = 1 << 20 };

struct Recorder {
    Trajectory *parts[2]; /* one is recorded while the other is written; only the first where none is written */
    int current;          /* part that is recorded */
    int capacity;         /* frames of a part */
    int used;             /* frames in it */
    int stream_count;
    TrajectoryStream *streams[RECORDER_OUTPUTS_MAX];
    Background *background; /* NULL: nothing is written */
};

static Recorder *create_parts(const Scene *scene, const Method *method, int parts, int frames, Error *error) {
    const int bodies = scene->body_count + scene_has_launch(scene);
    if (((int64_t)scene->frames + 1) * bodies > SIMULATE_MAX_STATES) {
        error_input(error, scene->name, "%d frames of %d bodies are too many to record; at most %d states of a body",
                    scene->frames, bodies, SIMULATE_MAX_STATES);
        return NULL;
    }
    Recorder *recorder = calloc(1, sizeof *recorder);
    if (recorder == NULL) return error_memory(error, scene->name), NULL;
    recorder->capacity = frames;
    for (int i = 0; i < parts; i++)
        if ((recorder->parts[i] = trajectory_of_scene(scene, method, frames, error)) == NULL)
            return recorder_destroy(recorder), NULL;
    return recorder;
}

Recorder *recorder_create(const Scene *scene, const Method *method, Error *error) {
    return create_parts(scene, method, 1, scene->frames + 1, error);
}

static bool write_part(void *context, void *item, Error *error) {
    Recorder *recorder = context;
    for (int i = 0; i < recorder->stream_count; i++)
        if (!trajectory_stream_add(recorder->streams[i], item, error)) return false;
    return true;
}

Recorder *recorder_create_to(const Scene *scene, const Method *method, const RecorderOutput *outputs, int count,
                             bool no_contacts, Error *error) {
    assert(count <= RECORDER_OUTPUTS_MAX);
    const int bodies = scene->body_count + scene_has_launch(scene), all = scene->frames + 1;
    const int fit = PART_BYTES / (int)(6 * sizeof(float)) / (bodies > 0 ? bodies : 1);
    Recorder *recorder = create_parts(scene, method, 2, fit < 1 ? 1 : fit > all ? all : fit, error);
    if (recorder == NULL) return NULL;
    for (int i = 0; i < 2; i++) {
        recorder->parts[i]->no_contacts |= no_contacts || count == 0; /* nobody would read them */
        trajectory_restart_contacts(recorder->parts[i]);
    }
    bool ok = true;
    for (int i = 0; ok && i < count; i++) {
        TrajectoryStream *stream =
            trajectory_stream_create(recorder->parts[0], all, outputs[i].format, outputs[i].path, error);
        ok = stream != NULL;
        if (ok) recorder->streams[recorder->stream_count++] = stream;
    }
    if (ok && (count == 0 || (recorder->background = background_start(write_part, recorder, error)) != NULL))
        return recorder;
    recorder_destroy(recorder);
    return NULL;
}

void recorder_destroy(Recorder *recorder) {
    if (recorder == NULL) return;
    background_stop(recorder->background);
    for (int i = 0; i < recorder->stream_count; i++) trajectory_stream_destroy(recorder->streams[i]);
    for (int i = 0; i < 2; i++) trajectory_destroy(recorder->parts[i]);
    free(recorder);
}

bool recorder_record(Recorder *recorder, int frame, const World *world, Error *error) {
    Trajectory *part = recorder->parts[recorder->current];
    const bool whole = recorder->parts[1] == NULL;
    const bool full = recorder->used == recorder->capacity ||
                      part->contact_start[part->last_step + 1] >= PART_BYTES / (int)sizeof *part->contacts;
    if (!whole && full) {
        /* Gives the part to the second thread, which has then ended the part before: that one is recorded next. */
        part->frames = recorder->used;
        trajectory_end_contacts(part);
        if (recorder->background != NULL && !background_give(recorder->background, part, error)) return false;
        recorder->current = !recorder->current;
        recorder->used = 0;
        part = recorder->parts[recorder->current];
        part->frames = recorder->capacity;
        trajectory_restart_contacts(part);
    }
    const int row = recorder->used++;
    trajectory_set_bodies(part, row, world);
    return frame == 0 || part->no_contacts || trajectory_set_contacts(part, row, world, error);
}

bool recorder_name_maker(Recorder *recorder, const Scene *scene, const Method *method, Error *error) {
    const MethodDescription *description = method->kind->description;
    Trajectory *run = recorder->parts[0];
    ProgramName name;
    if (method_program(method, &name)) snprintf(run->program, TRAJECTORY_NAME_SIZE, "%s %s", name.name, name.version);
    const char *path =
        description->needs_network ? method_network(&method->settings, scene, description->name, &(Error){0}) : NULL;
    if (path == NULL) return true;
    size_t size;
    char *data = file_read(file_elsewhere != NULL ? file_elsewhere(path) : path, NPZ_MAX_BYTES, &size, error);
    if (data != NULL) run->network_hash = hash_xxh3(data, size);
    free(data);
    return data != NULL;
}

void recorder_judge(Recorder *recorder, const char *words, int frame, int body) {
    trajectory_judge(recorder->parts[0], words, frame, body);
}

bool recorder_finish(Recorder *recorder, Error *error) {
    if (recorder->background == NULL) return true;
    Trajectory *part = recorder->parts[recorder->current];
    part->frames = recorder->used;
    trajectory_end_contacts(part);
    if (!background_give(recorder->background, part, error) || !background_wait(recorder->background, error))
        return false;
    for (int i = 0; i < recorder->stream_count; i++)
        if (!trajectory_stream_finish(recorder->streams[i], error)) return false;
    return true;
}

Trajectory *recorder_take(Recorder *recorder) {
    Trajectory *trajectory = recorder->parts[0];
    assert(recorder->parts[1] == NULL && recorder->used == trajectory->frames);
    trajectory_end_contacts(trajectory);
    recorder->parts[0] = NULL;
    return trajectory;
}

int recorder_bodies(const Recorder *recorder) { return recorder->parts[0]->bodies; }

uint64_t recorder_state_hash(const Recorder *recorder) {
    assert(recorder->used > 0);
    return trajectory_frame_hash(recorder->parts[recorder->current], recorder->used - 1);
}
