/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dataset/dataset_launches.h"

#include "simulate/launch_check.h"

#include <gsl/gsl_errno.h>
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

int dataset_launches_each(const DatasetOptions *options) {
    const int given = options->bomb_x.count + options->random;
    return options->table != NULL ? options->table->count : given > 0 ? given : LAUNCH_GRID;
}

/* Swept launches first, then random ones. */
static void draw_launches(const DatasetOptions *options, const Scene *scene, const gsl_rng *generator, Launch *out) {
    for (int k = 0; k < options->bomb_x.count + options->random; k++) {
        out[k] = launch_of(scene);
        if (k < options->bomb_x.count) {
            out[k].x = range_value(&options->bomb_x, k);
        } else {
            out[k].x = draw(generator, random_x);
            out[k].rotation = draw(generator, random_rotation);
            out[k].spin = draw(generator, random_spin);
        }
    }
}

/* A dataset has no columns for masses and frames. */
static bool check_launch(const Scene *scene, const Launch *launch, Error *error) {
    const Launch own = launch_of(scene);
    return (launch->mass == own.mass && launch->frame == own.frame) ||
           error_input(error, scene->name,
                       "a dataset has one mass and one frame of the bomb; the launches have others");
}

static bool choose_launches(const DatasetOptions *options, const Scene *scene, const gsl_rng *generator, Launch *out,
                            Error *error) {
    bool ok = true;
    if (options->table != NULL)
        ok = launches_for(options->table, scene, out, error);
    else if (options->bomb_x.count + options->random > 0)
        draw_launches(options, scene, generator, out);
    else
        ok = launches_for_training(scene, LAUNCH_GRID, out, error);
    for (int k = 0; ok && k < dataset_launches_each(options); k++) ok = check_launch(scene, &out[k], error);
    return ok && launches_check(scene, out, dataset_launches_each(options), error);
}

static bool put_launches(Dataset *dataset, const DatasetOptions *options, Scene *const *scenes,
                         const gsl_rng *generator, Error *error) {
    const int each = dataset_launches_each(options);
    Launch *launches = malloc((size_t)each * sizeof *launches);
    bool ok = launches != NULL || error_memory(error, "dataset");
    for (int i = 0; ok && i < dataset->launches; i++) {
        const int scene = i / each;
        if (i % each == 0) ok = choose_launches(options, scenes[scene], generator, launches, error);
        if (ok) put_launch(dataset, i, &launches[i % each]);
        dataset->launch_scene[i] = scene;
    }
    free(launches);
    return ok;
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
    gsl_set_error_handler_off(); /* its default aborts */
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
