/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Principal components of poses: the rows of recorded launches, the basis of a subspace. */
#include "base/base.h"
#include "engine/engine.h"
#include "learning/dataset.h"
#include "learning/learning.h"
#include "learning/subspace_training.h"
#include "methods/steppers.h"
#include "nets/kinds.h"
#include "scenes/scenes.h"

#include <stdlib.h>

/* Sums over the launches have a fixed number of parts, so that their order does not depend on the number of threads. */
enum { PARTS = 8 };

static bool components_moves(const Scene *scene, int body) {
    return body == scene->body_count || !scene->bodies[body].fixed;
}

/* The state of a body when the bomb appears. */
static BodyDef first_state(const Scene *launched, int body) {
    return body == launched->body_count ? scene_bomb_body(launched) : launched->bodies[body];
}

/* One step before the bomb appears: recorded, or, in the first state of a scene and of the bomb, from the velocity. */
static void fill_earlier(const Scene *launched, const LaunchRuns *runs, int launch, int body,
                         float numbers[SUBSPACE_POSE]) {
    const int frame = launched->bomb.frame;
    const BodyDef def = first_state(launched, body);
    if (frame > 0 && body < launched->body_count) {
        const BodyPose *pose = &launch_runs_frame(runs, launch, frame - 1)[body];
        subspace_pose_numbers(def.size, pose->position, pose->angle, numbers);
        return;
    }
    subspace_pose_numbers(def.size, vec2_sub(def.position, vec2_scale(launched->dt, def.velocity)),
                          def.angle - launched->dt * def.angular_velocity, numbers);
}

static void fill_launch(PoseRows *rows, const Scene *scene, const LaunchRuns *runs, int launch) {
    const Scene launched = launch_scene(scene, &runs->launches[launch]);
    float *at = rows->rows + (size_t)launch * (size_t)rows->states * (size_t)rows->numbers;
    subspace_launch(&launched, rows->launch + (size_t)launch * SUBSPACE_LAUNCH);
    for (int state = 0; state < rows->states; state++)
        for (int body = 0; body < runs->bodies; body++) {
            if (!components_moves(scene, body)) continue;
            if (state == 0) {
                fill_earlier(&launched, runs, launch, body, at);
            } else {
                const BodyPose *pose = &launch_runs_frame(runs, launch, launched.bomb.frame + state - 1)[body];
                subspace_pose_numbers(first_state(&launched, body).size, pose->position, pose->angle, at);
            }
            at += SUBSPACE_POSE;
        }
}

bool pose_rows_make(PoseRows *rows, const Scene *scene, const LaunchRuns *runs, Error *error) {
    int moving = 0;
    for (int body = 0; body < runs->bodies; body++) moving += components_moves(scene, body);
    *rows = (PoseRows){
        .launches = runs->count, .states = runs->frames - scene->bomb.frame + 1, .numbers = SUBSPACE_POSE * moving};
    const size_t count = (size_t)rows->states * (size_t)rows->numbers;
    rows->rows = malloc((size_t)rows->launches * (count + SUBSPACE_LAUNCH) * sizeof *rows->rows);
    if (rows->rows == NULL) return error_memory(error, "subspace");
    rows->launch = rows->rows + (size_t)rows->launches * count;
#pragma omp parallel for schedule(static)
    for (int launch = 0; launch < rows->launches; launch++) fill_launch(rows, scene, runs, launch);
    return true;
}

void pose_rows_free(PoseRows *rows) {
    free(rows->rows);
    *rows = (PoseRows){0};
}

static void fill_rest(const PoseRows *rows, const Scene *scene, const BodyPose *poses, float *rest) {
    for (int body = 0; body < scene->body_count; body++) {
        if (!components_moves(scene, body)) continue;
        subspace_pose_numbers(scene->bodies[body].size, poses[body].position, poses[body].angle, rest);
        rest += SUBSPACE_POSE;
    }
    for (int j = 0; j < SUBSPACE_POSE; j++) {
        double sum = 0;
        for (int launch = 0; launch < rows->launches; launch++)
            for (int state = 0; state < rows->states; state++)
                sum += (double)pose_row(rows, launch, state)[rows->numbers - SUBSPACE_POSE + j];
        rest[j] = (float)(sum / ((double)rows->launches * rows->states));
    }
}

/* Adds u u^T of one launch's rows to the lower triangle of moments[numbers, numbers]. */
static void add_moments(const PoseRows *rows, int launch, const float *rest, double *u, double *moments) {
    for (int state = 0; state < rows->states; state++) {
        const float *row = pose_row(rows, launch, state);
        for (int j = 0; j < rows->numbers; j++) u[j] = (double)row[j] - (double)rest[j];
        for (int i = 0; i < rows->numbers; i++) {
            double *restrict to = moments + (size_t)i * (size_t)rows->numbers;
            for (int j = 0; j <= i; j++) to[j] += u[i] * u[j];
        }
    }
}

/* parts[PARTS, numbers, numbers], scratch[PARTS, numbers]; the sum, both triangles, ends in the first part. */
static void sum_moments(const PoseRows *rows, const float *rest, double *parts, double *scratch) {
    const size_t numbers = (size_t)rows->numbers, size = numbers * numbers;
#pragma omp parallel for schedule(static, 1)
    for (int part = 0; part < PARTS; part++)
        for (int launch = part; launch < rows->launches; launch += PARTS)
            add_moments(rows, launch, rest, scratch + (size_t)part * numbers, parts + (size_t)part * size);
    for (size_t part = 1; part < PARTS; part++)
        for (size_t i = 0; i < size; i++) parts[i] += parts[part * size + i];
    for (size_t i = 0; i < numbers; i++)
        for (size_t j = i + 1; j < numbers; j++) parts[i * numbers + j] = parts[j * numbers + i];
}

static void fill_basis(const double *vectors, int numbers, SubspaceNet *net) {
    const int lanes = subspace_lanes(numbers);
    for (int k = 0; k < net->shape.components; k++)
        for (int j = 0; j < numbers; j++)
            net->basis[(size_t)k * (size_t)lanes + (size_t)j] = (float)vectors[(size_t)k * (size_t)numbers + (size_t)j];
}

bool pose_components_fit(const PoseRows *rows, const Scene *scene, const BodyPose *poses, SubspaceNet *net,
                         Error *error) {
    const size_t numbers = (size_t)rows->numbers, size = numbers * numbers;
    double *parts = calloc(PARTS * (size + numbers) + size + numbers, sizeof *parts);
    bool ok = parts != NULL;
    if (ok) {
        double *scratch = parts + PARTS * size, *vectors = scratch + PARTS * numbers, *values = vectors + size;
        fill_rest(rows, scene, poses, net->rest);
        sum_moments(rows, net->rest, parts, scratch);
        ok = symmetric_eigenvectors(parts, numbers, values, vectors);
        if (ok) fill_basis(vectors, rows->numbers, net);
    }
    free(parts);
    return ok || error_memory(error, "subspace");
}

void pose_components_project(const PoseRows *rows, SubspaceNet *net, float *components) {
    const int count = net->shape.components;
    const int64_t states = (int64_t)rows->launches * rows->states;
#pragma omp parallel for schedule(static)
    for (int64_t i = 0; i < states; i++)
        for (int k = 0; k < count; k++)
            components[i * count + k] = subspace_component(net, rows->rows + i * rows->numbers, k);
    for (int k = 0; k < count; k++) net->low[k] = net->high[k] = components[k];
    for (int64_t i = 0; i < states; i++)
        for (int k = 0; k < count; k++) {
            const float z = components[i * count + k];
            if (z < net->low[k]) net->low[k] = z;
            if (z > net->high[k]) net->high[k] = z;
        }
}
