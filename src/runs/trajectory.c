/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The trajectory in memory. */
#include "runs/trajectory.h"

#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/names.h"
#include "runs/runs_internal.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Bytes of all arrays in a file. */
static double measure(double frames, double bodies, double contacts) {
    double pose = 2 * sizeof(Vec2) + 2 * sizeof(float), body = sizeof(Vec2) + sizeof(float) + 1, small = 4096;
    return frames * (bodies * pose + sizeof(int64_t)) + bodies * body + contacts * sizeof(TrajectoryContact) + small;
}

/* calloc, but not NULL for 0 items. */
static void *zeros(size_t count, size_t size) { return calloc(count > 0 ? count : 1, size); }

Trajectory *trajectory_create(int frames, int bodies, Error *error) {
    assert(frames >= 1 && bodies >= 0);
    if (measure(frames, bodies, 0) > TRAJECTORY_MAX_BYTES)
        return error_input(error, "trajectory", "%d frames of %d bodies take more than 2 GiB", frames, bodies), NULL;
    Trajectory *t = calloc(1, sizeof *t);
    if (t == NULL) return error_memory(error, "trajectory"), NULL;
    *t = (Trajectory){.frames = frames, .bodies = bodies, .bomb = -1, .verdict_frame = -1, .verdict_body = -1};
    const size_t count = (size_t)bodies, poses = (size_t)frames * count;
    t->size = zeros(count, sizeof *t->size);
    t->mass = zeros(count, sizeof *t->mass);
    t->fixed = zeros(count, sizeof *t->fixed);
    t->position = zeros(poses, sizeof *t->position);
    t->angle = zeros(poses, sizeof *t->angle);
    t->velocity = zeros(poses, sizeof *t->velocity);
    t->angular_velocity = zeros(poses, sizeof *t->angular_velocity);
    t->contact_start = zeros((size_t)frames + 1, sizeof *t->contact_start);
    if (t->size == NULL || t->mass == NULL || t->fixed == NULL || t->position == NULL || t->angle == NULL ||
        t->velocity == NULL || t->angular_velocity == NULL || t->contact_start == NULL) {
        trajectory_destroy(t);
        return error_memory(error, "trajectory"), NULL;
    }
    for (int i = 0; i < bodies; i++) t->mass[i] = NAN;
    for (size_t i = 0; i < poses; i++) {
        t->position[i] = t->velocity[i] = vec2(NAN, NAN);
        t->angle[i] = t->angular_velocity[i] = NAN;
    }
    return t;
}

void trajectory_destroy(Trajectory *t) {
    if (t == NULL) return;
    free(t->size);
    free(t->mass);
    free(t->name);
    free(t->fixed);
    free(t->position);
    free(t->angle);
    free(t->velocity);
    free(t->angular_velocity);
    free(t->exact);
    free(t->there);
    free(t->hash);
    free(t->contact_start);
    free(t->contacts);
    free(t);
}

bool trajectory_make_names(Trajectory *t, Error *error) {
    t->name = zeros((size_t)t->bodies, sizeof *t->name);
    return t->name != NULL || error_memory(error, "trajectory");
}

void trajectory_judge(Trajectory *t, const char *words, int frame, int body) {
    snprintf(t->verdict, sizeof t->verdict, "%.*s", (int)utf8_cut(words, sizeof t->verdict - 1), words);
    t->verdict_frame = frame;
    t->verdict_body = body;
}

/* Sets contact_start of steps without contacts, from the last step with contacts up to `step`. */
static void end_steps(Trajectory *t, int step, int64_t count) {
    for (int k = t->last_step + 1; k <= step; k++) t->contact_start[k + 1] = count;
    if (step > t->last_step) t->last_step = step;
}

double trajectory_bytes(const Trajectory *t) {
    const double pose = t->exact != NULL ? 2 * sizeof(Vec2) + 2 * sizeof(float) : 0; /* float64: twice */
    return measure(t->frames, t->bodies, (double)t->contact_start[t->frames]) + t->frames * (t->bodies * pose);
}

TrajectoryContact *trajectory_add_contacts(Trajectory *t, int frame, int added, Error *error) {
    assert(frame >= t->last_step && frame < t->frames && added >= 0);
    int64_t count = t->contact_start[t->last_step + 1];
    if (measure(t->frames, t->bodies, (double)count + added) > TRAJECTORY_MAX_BYTES)
        return error_input(error, "trajectory", "its contacts take more than 2 GiB"), NULL;
    void *contacts = t->contacts;
    /* At least one, so that NULL is a failure. */
    if (!array_reserve(&contacts, &t->contact_capacity, (size_t)(count + added) + 1, sizeof *t->contacts))
        return error_memory(error, "trajectory"), NULL;
    t->contacts = contacts;
    end_steps(t, frame, count);
    t->contact_start[frame + 1] = count + added;
    return t->contacts + count;
}

void trajectory_restart_contacts(Trajectory *t) {
    t->last_step = -1;
    t->contact_start[0] = 0;
}

void trajectory_end_contacts(Trajectory *t) { end_steps(t, t->frames - 1, t->contact_start[t->last_step + 1]); }

uint64_t trajectory_frame_hash(const Trajectory *t, int frame) {
    uint64_t hash = FNV1A64_START;
    for (int body = 0; body < t->bodies; body++) {
        if (t->fixed[body] || !trajectory_has(t, frame, body)) continue;
        size_t i = trajectory_at(t, frame, body);
        float state[] = {t->position[i].x, t->position[i].y, t->angle[i],
                         t->velocity[i].x, t->velocity[i].y, t->angular_velocity[i]};
        hash = hash_fnv1a64(hash, state, sizeof state);
    }
    return hash;
}

bool trajectory_has_masses(const Trajectory *trajectory) {
    for (int body = 0; body < trajectory->bodies; body++)
        if (!trajectory->fixed[body] && isnan(trajectory->mass[body])) return false;
    return true;
}

int trajectory_impact(const Trajectory *trajectory) {
    const int bomb = trajectory->bomb;
    if (bomb < 0) return -1;
    for (int step = 1; step < trajectory->frames; step++)
        for (int64_t i = trajectory->contact_start[step]; i < trajectory->contact_start[step + 1]; i++) {
            const TrajectoryContact *contact = &trajectory->contacts[i];
            if ((contact->a == bomb || contact->b == bomb) && !trajectory->fixed[contact->a] &&
                !trajectory->fixed[contact->b])
                return step;
        }
    return -1;
}

/* The velocity after a step of the body's point that was at `point` before it. */
static Vec2 velocity_at(const Trajectory *trajectory, int step, int body, Vec2 point) {
    const size_t before = trajectory_at(trajectory, step - 1, body), after = trajectory_at(trajectory, step, body);
    const Vec2 arm = vec2_sub(point, trajectory->position[before]);
    return vec2_add(trajectory->velocity[after], scalar_cross_vec2(trajectory->angular_velocity[after], arm));
}

ContactMode trajectory_mode(const Trajectory *trajectory, int step, int64_t contact) {
    const TrajectoryContact *touched = &trajectory->contacts[contact];
    if (!(touched->normal_impulse > 0)) return CONTACT_OPEN;
    const Vec2 sliding = vec2_sub(velocity_at(trajectory, step, touched->b, touched->point),
                                  velocity_at(trajectory, step, touched->a, touched->point));
    return fabs((double)vec2_cross(sliding, touched->normal)) > CONTACT_SLIDING ? CONTACT_SLIPS : CONTACT_STICKS;
}

enum { STEM_SIZE = 2 * TRAJECTORY_NAME_SIZE + 2 };

/* Without the folders of networks and programs, so that runs of two machines have the same names. */
static void make_stem(const Trajectory *run, char stem[STEM_SIZE]) {
    char name[TRAJECTORY_NAME_SIZE];
    method_name(name, sizeof name, run->method);
    snprintf(stem, STEM_SIZE, "%s-%s", run->scene, name);
    file_name_clean(stem);
}

void trajectory_file_name(const Trajectory *const *runs, int index, char name[TRAJECTORY_FILE_NAME_SIZE]) {
    char stem[STEM_SIZE], other[STEM_SIZE], number[16] = "";
    int same = 1;
    make_stem(runs[index], stem);
    for (int i = 0; i < index; i++) {
        make_stem(runs[i], other);
        same += strcmp(stem, other) == 0;
    }
    if (same > 1) snprintf(number, sizeof number, "-%d", same);
    snprintf(name, TRAJECTORY_FILE_NAME_SIZE, "%s%s.npz", stem, number);
}

void trajectory_name_from_path(const char *path, char name[TRAJECTORY_NAME_SIZE]) {
    const char *file = path_is_standard(path) ? "stdin" : path + file_folder_length(path), *ending = strrchr(file, '.');
    size_t length = ending != NULL && ending > file ? (size_t)(ending - file) : strlen(file), used = 0;
    for (size_t at = 0, width; at < length && used + 4 < TRAJECTORY_NAME_SIZE; at += width > 0 ? width : 1) {
        char letter[5] = "";
        uint32_t character;
        width = utf8_decode(file + at, length - at, &character);
        memcpy(letter, file + at, width);
        if (width == 0 || control_in_text(letter) != 0) strcpy(letter, "_");
        used += (size_t)snprintf(name + used, TRAJECTORY_NAME_SIZE - used, "%s", letter);
    }
    name[used] = '\0';
}

static uint64_t add(uint64_t hash, const void *data, size_t size) {
    uint64_t parts[] = {hash, hash_xxh3(data, size)};
    return hash_xxh3(parts, sizeof parts);
}

uint64_t trajectory_hash(const Trajectory *run) {
    size_t bodies = (size_t)run->bodies, poses = bodies * (size_t)run->frames;
    uint64_t hash = add(0, run->size, bodies * sizeof *run->size);
    hash = add(hash, run->fixed, bodies * sizeof *run->fixed);
    if (run->name != NULL) hash = add(hash, run->name, bodies * sizeof *run->name);
    hash = add(hash, &run->camera_center, sizeof run->camera_center);
    hash = add(hash, &run->camera_size, sizeof run->camera_size);
    hash = add(hash, run->position, poses * sizeof *run->position);
    hash = add(hash, run->angle, poses * sizeof *run->angle);
    hash = add(hash, run->velocity, poses * sizeof *run->velocity);
    hash = add(hash, run->angular_velocity, poses * sizeof *run->angular_velocity);
    hash = add(hash, run->contact_start, ((size_t)run->frames + 1) * sizeof *run->contact_start);
    return add(hash, run->contacts, (size_t)run->contact_start[run->frames] * sizeof *run->contacts);
}

double trajectory_number(const Trajectory *t, size_t i, int column) {
    if (t->exact != NULL && (column < 3 || !t->no_velocities)) return t->exact[trajectory_exact_at(t, i, column)];
    const Vec2 of = column < 2 ? t->position[i] : t->velocity[i];
    return (double)(column == 2 ? t->angle[i] : column == 5 ? t->angular_velocity[i] : column % 3 == 0 ? of.x : of.y);
}
