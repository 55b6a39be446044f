/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/array.h"
#include "common/parallel.h"
#include "dataset/dataset_launches.h"
#include "simulate/simulate.h"
#include "solvers/reference.h"
#include "solvers/sequential_impulses.h"

#include <stdlib.h>
#include <string.h>

/* One touching pair in one step, or in one sweep of it. */
typedef struct PairRow {
    float inputs[PAIR_INPUTS_MAX], changes[PAIR_CHANGES];
    int32_t frame, bodies[2];
} PairRow;

/* What one launch gave. */
typedef struct LaunchRows {
    PairRow *rows;
    size_t count, capacity;
    size_t start; /* of its rows in the dataset */
} LaunchRows;

/* The launch that a thread is recording. */
typedef struct LaunchRecorder {
    const Dataset *dataset; /* what is to be recorded */
    const Scene *scene;
    LaunchRows *launch;
    Reference reference;
    BodyVelocity *velocities;
    ContactImpulse *impulses;
    size_t velocity_capacity, impulse_capacity;
} LaunchRecorder;

static bool reserve(LaunchRecorder *recorder, const ContactProblem *problem) {
    return array_reserve((void **)&recorder->velocities, &recorder->velocity_capacity, (size_t)problem->body_count,
                         sizeof *recorder->velocities) &&
           array_reserve((void **)&recorder->impulses, &recorder->impulse_capacity, (size_t)problem->contact_count + 1,
                         sizeof *recorder->impulses);
}

/* The solution of the step's problem that the changes are taken from. */
static bool label(LaunchRecorder *recorder, const World *world, ContactSolution *solution, Error *error) {
    const ContactProblem *problem = world_problem(world);
    *solution = *world_solution(world);
    if (recorder->dataset->labels == DATASET_BY_ENGINE) return true;
    Reference *reference = &recorder->reference;
    if (!reference_solve(reference, problem, REFERENCE_TOLERANCE, REFERENCE_MAX_VISITS, NULL, error)) return false;
    if (!reserve(recorder, problem)) return error_memory(error, "dataset");
    for (int i = 0; i < problem->body_count; i++) {
        const ReferenceVelocity *v = &reference->velocities[i];
        recorder->velocities[i] = (BodyVelocity){vec2((float)v->x, (float)v->y), (float)v->spin};
    }
    for (int i = 0; i < problem->contact_count; i++)
        recorder->impulses[i] =
            (ContactImpulse){(float)reference->impulses[i].normal, (float)reference->impulses[i].tangent};
    *solution = (ContactSolution){recorder->velocities, recorder->impulses};
    return true;
}

/* A new row of a pair with its inputs; velocities: NULL, or those it has now. NULL when memory is short. */
static PairRow *add_row(LaunchRecorder *recorder, int frame, const ContactProblem *problem, int first,
                        const BodyVelocity *velocities) {
    LaunchRows *launch = recorder->launch;
    if (!array_reserve((void **)&launch->rows, &launch->capacity, launch->count + 1, sizeof *launch->rows)) return NULL;
    PairRow *row = &launch->rows[launch->count++];
    row->frame = frame;
    row->bodies[0] = problem->contacts[first].a;
    row->bodies[1] = problem->contacts[first].b;
    pair_inputs(problem, velocities, row->bodies[0], row->bodies[1], recorder->dataset->view, row->inputs);
    return row;
}

/* changes[3]: from one velocity to another. */
static void difference(float *changes, const BodyVelocity *to, const BodyVelocity *from) {
    changes[0] = to->linear.x - from->linear.x;
    changes[1] = to->linear.y - from->linear.y;
    changes[2] = to->angular - from->angular;
}

static void net_change(float *changes, const ContactProblem *problem, const ContactSolution *solution, int body) {
    const ProblemBody *before = &problem->bodies[body];
    const BodyVelocity free = {before->velocity, before->angular_velocity};
    difference(changes, &solution->velocities[body], &free);
}

static bool record_step(LaunchRecorder *recorder, int frame, const World *world, Error *error) {
    const ContactProblem *problem = world_problem(world);
    ContactSolution solution;
    if (!label(recorder, world, &solution, error)) return false;
    for (int first = 0, count; first < problem->contact_count; first += count) {
        count = pair_contact_count(problem, first);
        PairRow *row = add_row(recorder, frame, problem, first, NULL);
        if (row == NULL) return error_memory(error, "dataset");
        if (recorder->dataset->target == DATASET_PAIR) {
            pair_changes(problem, &solution, first, count, row->changes);
        } else {
            net_change(row->changes, problem, &solution, row->bodies[0]);
            net_change(row->changes + 3, problem, &solution, row->bodies[1]);
        }
    }
    return true;
}

/* The engine's sweeps once more, in plain text, pair by pair. */
static bool record_visits(LaunchRecorder *recorder, int frame, const World *world, Error *error) {
    const ContactProblem *problem = world_problem(world);
    const SequentialOptions options = {
        .accumulate = recorder->scene->accumulate_impulses, .warm = true, .relaxation = 1};
    if (!reserve(recorder, problem)) return error_memory(error, "dataset");
    ContactSolution solution = {recorder->velocities, recorder->impulses};
    sequential_impulses_begin(problem, &options, &solution);
    for (int sweep = 0; sweep < recorder->scene->iterations; sweep++)
        for (int first = 0, count; first < problem->contact_count; first += count) {
            count = pair_contact_count(problem, first);
            PairRow *row = add_row(recorder, frame, problem, first, solution.velocities);
            if (row == NULL) return error_memory(error, "dataset");
            const BodyVelocity *a = &solution.velocities[row->bodies[0]], *b = &solution.velocities[row->bodies[1]];
            BodyVelocity before_a = *a, before_b = *b;
            sequential_impulses_visit(problem, &options, first, count, &solution);
            difference(row->changes, a, &before_a);
            difference(row->changes + 3, b, &before_b);
        }
    return true;
}

static bool observe(void *context, int frame, const World *world, Error *error) {
    LaunchRecorder *recorder = context;
    return recorder->dataset->target == DATASET_IMPULSE ? record_visits(recorder, frame, world, error)
                                                        : record_step(recorder, frame, world, error);
}

/* What the threads share. */
typedef struct Recording {
    Scene *const *scenes;
    const Dataset *dataset;
    LaunchRows *launches;
} Recording;

static bool record_launch(void *context, int index, Error *error) {
    const Recording *recording = context;
    const Dataset *dataset = recording->dataset;
    Scene scene = dataset_launch(dataset, recording->scenes, index);
    LaunchRecorder recorder = {.dataset = dataset, .scene = &scene, .launch = &recording->launches[index]};
    Method method;
    StepObserver observer = {observe, &recorder};
    bool ok = method_parse(&method, "engine", error) && simulate_observed(&scene, &method, &observer, error);
    reference_free(&recorder.reference);
    free(recorder.velocities);
    free(recorder.impulses);
    return ok;
}

/* Copies the rows of launch i to row `at` and on. */
static void place_rows(const Dataset *dataset, LaunchRows *launch, int i, size_t at) {
    size_t inputs = (size_t)dataset_inputs(dataset);
    for (size_t k = 0; k < launch->count; k++, at++) {
        const PairRow *row = &launch->rows[k];
        memcpy(dataset->inputs + at * inputs, row->inputs, inputs * sizeof *row->inputs);
        memcpy(dataset->changes + at * PAIR_CHANGES, row->changes, sizeof row->changes);
        dataset->launch[at] = i;
        dataset->frame[at] = row->frame;
        memcpy(dataset->bodies + at * 2, row->bodies, sizeof row->bodies);
    }
    free(launch->rows);
    launch->rows = NULL;
}

/* Puts the launches' rows behind each other, in the order of the launches. */
static bool gather(Dataset *dataset, LaunchRows *launches, Error *error) {
    size_t rows = 0;
    for (int i = 0; i < dataset->launches; i++) {
        launches[i].start = rows;
        rows += launches[i].count;
    }
    dataset->inputs = malloc((rows + 1) * (size_t)dataset_inputs(dataset) * sizeof *dataset->inputs);
    dataset->changes = malloc((rows + 1) * PAIR_CHANGES * sizeof *dataset->changes);
    dataset->launch = malloc((rows + 1) * sizeof *dataset->launch);
    dataset->frame = malloc((rows + 1) * sizeof *dataset->frame);
    dataset->bodies = malloc((rows + 1) * 2 * sizeof *dataset->bodies);
    if (dataset->inputs == NULL || dataset->changes == NULL || dataset->launch == NULL || dataset->frame == NULL ||
        dataset->bodies == NULL)
        return error_memory(error, "dataset");
    dataset->rows = (int64_t)rows;
    /* Most of the time is the system's, which makes memory where it is first touched. */
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < dataset->launches; i++) place_rows(dataset, &launches[i], i, launches[i].start);
    if (rows == 0) return error_input(error, "dataset", "no two bodies touched in any launch");
    return true;
}

static Dataset *record_scenes(const DatasetOptions *options, Scene *const *scenes, const Progress *progress,
                              Error *error) {
    Dataset *dataset = dataset_of_launches(options, scenes, error);
    if (dataset == NULL) return NULL;
    LaunchRows *launches = calloc((size_t)dataset->launches, sizeof *launches);
    if (launches == NULL) error_memory(error, "dataset");
    Recording recording = {.scenes = scenes, .dataset = dataset, .launches = launches};
    const ParallelWork work = {record_launch, &recording};
    bool ok = launches != NULL && parallel_for(&work, dataset->launches, "recorded launches", progress, error) &&
              gather(dataset, launches, error);
    for (int i = 0; launches != NULL && i < dataset->launches; i++) free(launches[i].rows);
    free(launches);
    if (ok) return dataset;
    dataset_destroy(dataset);
    return NULL;
}

Dataset *dataset_record(const DatasetOptions *options, const Progress *progress, Error *error) {
    if (options->scene_count < 1 || options->scene_count > DATASET_MAX_SCENES) {
        error_input(error, "dataset", "%d scenes; from 1 to %d can be recorded", options->scene_count,
                    DATASET_MAX_SCENES);
        return NULL;
    }
    int launches = options->bomb_x.count + options->random;
    if (launches < 5 || launches > DATASET_MAX_LAUNCHES) {
        error_input(error, "dataset", "%d launches a scene; at least 5 are needed to hold out a fifth, at most %d",
                    launches, DATASET_MAX_LAUNCHES);
        return NULL;
    }
    if (options->target == DATASET_IMPULSE && options->labels == DATASET_BY_REFERENCE) {
        error_input(error, "dataset", "the target impulse is what a sweep of the engine does; the reference has none");
        return NULL;
    }
    Scene *scenes[DATASET_MAX_SCENES] = {NULL};
    bool ok = true;
    for (int i = 0; ok && i < options->scene_count; i++) {
        scenes[i] = scene_read(options->scenes[i], error);
        ok = scenes[i] != NULL &&
             (scenes[i]->bomb.present || error_input(error, options->scenes[i], "the scene has no bomb to launch"));
    }
    Dataset *dataset = ok ? record_scenes(options, scenes, progress, error) : NULL;
    for (int i = 0; i < options->scene_count; i++) scene_destroy(scenes[i]);
    return dataset;
}
