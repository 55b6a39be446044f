/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dataset/dataset_launches.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

/* The paper's random launches (3.3). */
static const double random_x = 15, random_rotation = 1.5, random_spin = 20;

static float draw(const gsl_rng *generator, double limit) { return (float)gsl_ran_flat(generator, -limit, limit); }

static void put_launch(Dataset *dataset, int i, const Launch *launch) {
    dataset->launch_x[i] = launch->x;
    dataset->launch_rotation[i] = launch->rotation;
    dataset->launch_spin[i] = launch->spin;
}

/* A dataset has no column for masses. */
static bool family_launches(const Scene *scene, Launch launches[LAUNCH_GRID], Error *error) {
    if (scene_span_varies(&scene->bomb.mass))
        return error_input(error, scene->name, "the mass of the bomb varies, which a dataset does not record");
    return launches_for_training(scene, LAUNCH_GRID, launches, error);
}

int dataset_launches_each(const DatasetOptions *options) {
    const int given = options->bomb_x.count + options->random;
    return given > 0 ? given : LAUNCH_GRID;
}

/* Swept launches first, then random ones; none given: the scene's family. */
static bool put_launches(Dataset *dataset, const DatasetOptions *options, Scene *const *scenes,
                         const gsl_rng *generator, Error *error) {
    const bool family = options->bomb_x.count + options->random == 0;
    int i = 0;
    for (int scene = 0; scene < options->scene_count; scene++) {
        Launch launch = launch_of(scenes[scene]), launches[LAUNCH_GRID];
        if (family && !family_launches(scenes[scene], launches, error)) return false;
        for (int k = 0; family && k < LAUNCH_GRID; k++, i++) {
            put_launch(dataset, i, &launches[k]);
            dataset->launch_scene[i] = scene;
        }
        for (int k = 0; k < options->bomb_x.count; k++, i++) {
            launch.x = range_value(&options->bomb_x, k);
            put_launch(dataset, i, &launch);
            dataset->launch_scene[i] = scene;
        }
        for (int k = 0; k < options->random; k++, i++) {
            launch.x = draw(generator, random_x);
            launch.rotation = draw(generator, random_rotation);
            launch.spin = draw(generator, random_spin);
            put_launch(dataset, i, &launch);
            dataset->launch_scene[i] = scene;
        }
    }
    return true;
}

/* Draws the held-out launches. */
static bool split(Dataset *dataset, int launches_per_scene, const gsl_rng *generator) {
    int *order = malloc((size_t)launches_per_scene * sizeof *order);
    if (order == NULL) return false;
    for (int scene = 0; scene < dataset->scene_count; scene++) {
        for (int i = 0; i < launches_per_scene; i++) order[i] = i;
        gsl_ran_shuffle(generator, order, (size_t)launches_per_scene, sizeof *order);
        for (int i = 0; i < launches_per_scene / 5; i++)
            dataset->launch_test[scene * launches_per_scene + order[i]] = 1;
    }
    free(order);
    return true;
}

/* The split is drawn first, so that it does not depend on later draws. */
static bool fill(Dataset *dataset, const DatasetOptions *options, Scene *const *scenes, Error *error) {
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    if (generator == NULL) return error_memory(error, "dataset");
    gsl_rng_set(generator, (unsigned long)options->seed);
    bool ok = split(dataset, dataset_launches_each(options), generator) || error_memory(error, "dataset");
    ok = ok && put_launches(dataset, options, scenes, generator, error);
    gsl_rng_free(generator);
    return ok;
}

Dataset *dataset_of_launches(const DatasetOptions *options, Scene *const *scenes, Error *error) {
    Dataset *dataset = calloc(1, sizeof *dataset);
    if (dataset == NULL) {
        error_memory(error, "dataset");
        return NULL;
    }
    dataset->view = options->view;
    dataset->target = options->target;
    dataset->labels = options->labels;
    dataset->scene_count = options->scene_count;
    dataset->launches = options->scene_count * dataset_launches_each(options);
    size_t launches = (size_t)dataset->launches;
    dataset->launch_scene = malloc(launches * sizeof *dataset->launch_scene);
    dataset->launch_x = malloc(launches * sizeof *dataset->launch_x);
    dataset->launch_rotation = malloc(launches * sizeof *dataset->launch_rotation);
    dataset->launch_spin = malloc(launches * sizeof *dataset->launch_spin);
    dataset->launch_test = calloc(launches, sizeof *dataset->launch_test);
    for (int i = 0; i < options->scene_count; i++) strcpy(dataset->scenes[i], scenes[i]->name);
    bool ok = dataset->launch_scene != NULL && dataset->launch_x != NULL && dataset->launch_rotation != NULL &&
              dataset->launch_spin != NULL && dataset->launch_test != NULL;
    if (!ok) error_memory(error, "dataset");
    if (ok && fill(dataset, options, scenes, error)) return dataset;
    dataset_destroy(dataset);
    return NULL;
}

Scene dataset_launch(const Dataset *dataset, Scene *const *scenes, int i) {
    const Scene *scene = scenes[dataset->launch_scene[i]];
    Launch launch = launch_of(scene);
    launch.x = dataset->launch_x[i];
    launch.rotation = dataset->launch_rotation[i];
    launch.spin = dataset->launch_spin[i];
    return launch_scene(scene, &launch);
}
