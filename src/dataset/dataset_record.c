/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/array.h"
#include "common/parallel.h"
#include "dataset/dataset.h"
#include "simulate/simulate.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

/* One touching pair in one step. */
typedef struct PairRow {
    float inputs[PAIR_INPUTS], changes[PAIR_CHANGES];
    int32_t frame, bodies[2];
} PairRow;

/* What one launch gave. */
typedef struct LaunchRows {
    PairRow *rows;
    size_t count, capacity;
    size_t start; /* of its rows in the dataset */
} LaunchRows;

static bool observe(void *context, int frame, const World *world, Error *error) {
    LaunchRows *launch = context;
    const ContactProblem *problem = world_problem(world);
    for (int first = 0, count; first < problem->contact_count; first += count) {
        count = pair_contact_count(problem, first);
        if (!array_reserve((void **)&launch->rows, &launch->capacity, launch->count + 1, sizeof *launch->rows))
            return error_memory(error, "dataset");
        PairRow *row = &launch->rows[launch->count++];
        row->frame = frame;
        row->bodies[0] = problem->contacts[first].a;
        row->bodies[1] = problem->contacts[first].b;
        pair_inputs(problem, row->bodies[0], row->bodies[1], row->inputs);
        pair_changes(problem, world_solution(world), first, count, row->changes);
    }
    return true;
}

/* Draws which launches are held out: a fifth of each scene's, at least one. */
static bool split(Dataset *dataset, int launches_per_scene, uint64_t seed, Error *error) {
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    int *order = malloc((size_t)launches_per_scene * sizeof *order);
    if (generator == NULL || order == NULL) {
        if (generator != NULL) gsl_rng_free(generator);
        free(order);
        return error_memory(error, "dataset");
    }
    gsl_rng_set(generator, (unsigned long)seed);
    for (int scene = 0; scene < dataset->scene_count; scene++) {
        for (int i = 0; i < launches_per_scene; i++) order[i] = i;
        gsl_ran_shuffle(generator, order, (size_t)launches_per_scene, sizeof *order);
        for (int i = 0; i < launches_per_scene / 5; i++)
            dataset->launch_test[scene * launches_per_scene + order[i]] = 1;
    }
    gsl_rng_free(generator);
    free(order);
    return true;
}

/* The launch tables, without rows yet. */
static Dataset *dataset_of_launches(const DatasetOptions *options, Scene *const *scenes, Error *error) {
    Dataset *dataset = calloc(1, sizeof *dataset);
    if (dataset == NULL) {
        error_memory(error, "dataset");
        return NULL;
    }
    int per_scene = options->bomb_x.count;
    size_t launches = (size_t)options->scene_count * (size_t)per_scene;
    dataset->launch_scene = malloc(launches * sizeof *dataset->launch_scene);
    dataset->launch_x = malloc(launches * sizeof *dataset->launch_x);
    dataset->launch_test = calloc(launches, sizeof *dataset->launch_test);
    dataset->launches = (int)launches;
    dataset->scene_count = options->scene_count;
    bool ok = dataset->launch_scene != NULL && dataset->launch_x != NULL && dataset->launch_test != NULL;
    if (!ok) error_memory(error, "dataset");
    for (int i = 0; ok && i < dataset->launches; i++) {
        dataset->launch_scene[i] = i / per_scene;
        dataset->launch_x[i] = range_value(&options->bomb_x, i % per_scene);
    }
    for (int i = 0; i < options->scene_count; i++) strcpy(dataset->scenes[i], scenes[i]->name);
    if (ok && split(dataset, per_scene, options->seed, error)) return dataset;
    dataset_destroy(dataset);
    return NULL;
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
    Scene scene = *recording->scenes[dataset->launch_scene[index]];
    scene.bomb.body.position.x = dataset->launch_x[index];
    Method method;
    StepObserver observer = {observe, &recording->launches[index]};
    return method_parse(&method, "engine", error) && simulate_observed(&scene, &method, &observer, error);
}

/* Copies the rows of launch i to row `at` and on. */
static void place_rows(const Dataset *dataset, LaunchRows *launch, int i, size_t at) {
    for (size_t k = 0; k < launch->count; k++, at++) {
        const PairRow *row = &launch->rows[k];
        memcpy(dataset->inputs + at * PAIR_INPUTS, row->inputs, sizeof row->inputs);
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
    dataset->inputs = malloc((rows + 1) * PAIR_INPUTS * sizeof *dataset->inputs);
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
    if (options->bomb_x.count < 5) {
        error_input(error, "dataset", "%d launches a scene; at least 5 are needed to hold out a fifth",
                    options->bomb_x.count);
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
