/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Datasets: the rows of a launch, subsets, and the launches that are drawn. */
#include "learning/dataset.h"

#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "methods/reference.h"
#include "methods/sweeps.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

/* The launch being recorded. */
typedef struct LaunchRecorder {
    const Dataset *dataset; /* options of the recording */
    const Scene *scene;
    LaunchRows *launch;
    Reference reference;
    PairMoment labels; /* of the reference */
    PairMoment now;
} LaunchRecorder;

static bool dataset_reserve(PairMoment *moment, const ContactProblem *problem, ContactSolution *solution,
                            Error *error) {
    if (!pair_moment_reserve(moment, problem)) return error_memory(error, "dataset");
    *solution = pair_moment_solution(moment);
    return true;
}

/* The solution that the changes are computed from. *known: false if it did not converge, which is counted. */
static bool dataset_label(LaunchRecorder *recorder, const World *world, ContactSolution *solution, bool *known,
                          Error *error) {
    const ContactProblem *problem = world_problem(world);
    *solution = *world_solution(world);
    *known = true;
    if (recorder->dataset->labels == DATASET_BY_ENGINE) return true;
    Reference *reference = &recorder->reference;
    if (!reference_solve(reference, problem, NULL, error)) return false;
    *known = reference_converged(reference);
    recorder->launch->unconverged += !*known;
    if (!dataset_reserve(&recorder->labels, problem, solution, error)) return false;
    reference_round(reference, problem, solution);
    return true;
}

/* Appends a row of a pair with its current inputs (pair_inputs). NULL when memory is short. */
static PairRow *add_row(LaunchRecorder *recorder, int frame, const ContactProblem *problem, int first,
                        const PairMoment *now) {
    LaunchRows *launch = recorder->launch;
    if (!array_reserve((void **)&launch->rows, &launch->capacity, launch->count + 1, sizeof *launch->rows)) return NULL;
    PairRow *row = &launch->rows[launch->count++];
    row->frame = frame;
    row->bodies[0] = problem->contacts[first].a;
    row->bodies[1] = problem->contacts[first].b;
    pair_inputs(problem, now, first, recorder->dataset->view, row->inputs);
    return row;
}

/* changes[3]: the difference of two velocities. */
static void dataset_difference(float *changes, const BodyVelocity *to, const BodyVelocity *from) {
    changes[0] = to->linear.x - from->linear.x;
    changes[1] = to->linear.y - from->linear.y;
    changes[2] = to->angular - from->angular;
}

/* The state after the warm start, before the first sweep. */
static SequentialOptions sweeps_of(const Scene *scene) {
    return (SequentialOptions){.accumulate = scene->accumulate_impulses, .warm = true};
}

static bool record_step(LaunchRecorder *recorder, int frame, const World *world, Error *error) {
    const Dataset *dataset = recorder->dataset;
    const ContactProblem *problem = world_problem(world);
    const SequentialOptions options = sweeps_of(recorder->scene);
    ContactSolution solution, begun;
    bool known;
    if (!dataset_label(recorder, world, &solution, &known, error)) return false;
    if (!known) return true;
    if (!dataset_reserve(&recorder->now, problem, &begun, error)) return false;
    const bool by_contact = pair_views[dataset->view].by_contact;
    if (by_contact) sequential_impulses_begin(problem, &options, &begun);
    if (dataset->view == PAIR_NEIGHBOURS) pair_moment_jacobi(&recorder->now, problem);
    for (int first = 0; first < problem->contact_count; first += pair_contact_count(problem, first)) {
        PairRow *row = add_row(recorder, frame, problem, first, by_contact ? &recorder->now : NULL);
        if (row == NULL) return error_memory(error, "dataset");
        pair_step_changes(problem, &solution, first, dataset->view, dataset->target, row->changes);
        pair_context(problem, first, row->context);
    }
    return true;
}

/* Repeats the engine's sweeps with the scalar reference implementation, pair by pair. */
static bool record_visits(LaunchRecorder *recorder, int frame, const World *world, Error *error) {
    const ContactProblem *problem = world_problem(world);
    const SequentialOptions options = sweeps_of(recorder->scene);
    ContactSolution now;
    if (!dataset_reserve(&recorder->now, problem, &now, error)) return false;
    sequential_impulses_begin(problem, &options, &now);
    for (int sweep = 0; sweep < recorder->scene->iterations; sweep++)
        for (int first = 0, count; first < problem->contact_count; first += count) {
            count = pair_contact_count(problem, first);
            PairRow *row = add_row(recorder, frame, problem, first, &recorder->now);
            if (row == NULL) return error_memory(error, "dataset");
            const BodyVelocity *a = &now.velocities[row->bodies[0]], *b = &now.velocities[row->bodies[1]];
            BodyVelocity before_a = *a, before_b = *b;
            sequential_impulses_visit(problem, &options, first, count, &now);
            dataset_difference(row->changes, a, &before_a);
            dataset_difference(row->changes + 3, b, &before_b);
            if (pair_views[recorder->dataset->view].by_contact)
                pair_to_contact_frame(&problem->contacts[first], row->changes);
        }
    return true;
}

static bool dataset_observe(void *context, int frame, const World *world, Error *error) {
    LaunchRecorder *recorder = context;
    return recorder->dataset->target == TARGET_IMPULSE ? record_visits(recorder, frame, world, error)
                                                       : record_step(recorder, frame, world, error);
}

bool dataset_record_rows(const Dataset *dataset, const Scene *launched, LaunchRows *rows, Error *error) {
    LaunchRecorder recorder = {.dataset = dataset, .scene = launched, .launch = rows};
    Method method;
    StepObserver observer = {dataset_observe, &recorder};
    bool ok = method_parse(&method, "engine", error) && simulate_observed(launched, &method, &observer, error);
    reference_free(&recorder.reference);
    pair_moment_free(&recorder.labels);
    pair_moment_free(&recorder.now);
    return ok;
}

static bool is_kept(const Dataset *dataset, const bool *keep, int64_t row) {
    return dataset_is_test(dataset, row) || keep[dataset->launch[row]];
}

/* Copies the kept rows of an array with `size` bytes per row. */
static void copy_rows(void *to, const void *from, const Dataset *dataset, const bool *keep, size_t size) {
    char *at = to;
    for (int64_t row = 0; row < dataset->rows; row++) {
        if (!is_kept(dataset, keep, row)) continue;
        memcpy(at, (const char *)from + (size_t)row * size, size);
        at += size;
    }
}

static void copy_all_rows(Dataset *to, const Dataset *from, const bool *keep) {
    DatasetArrays arrays, others;
    const int count = dataset_arrays(to, &arrays);
    dataset_arrays(from, &others);
    for (int i = DATASET_FIRST_ROWS; i < count; i++)
        copy_rows((void *)arrays.list[i].data, others.list[i].data, from, keep, dataset_row_size(&others.list[i]));
}

Dataset *dataset_subset(const Dataset *dataset, const bool *keep, Error *error) {
    int64_t kept = 0, train = 0;
    for (int64_t row = 0; row < dataset->rows; row++) {
        kept += is_kept(dataset, keep, row);
        train += is_kept(dataset, keep, row) && !dataset_is_test(dataset, row);
    }
    if (train == 0) return error_input(error, "dataset", "no rows are left to train on"), NULL;
    Dataset *subset = malloc(sizeof *subset);
    if (subset == NULL) return error_memory(error, "dataset"), NULL;
    *subset = *dataset;
    subset->row_block = subset->launch_block = NULL;
    if (!dataset_make_launches(subset, dataset->launches) || !dataset_make_rows(subset, kept, dataset->context != NULL))
        return error_memory(error, "dataset"), dataset_destroy(subset), NULL;
    memcpy(subset->launch_block, dataset->launch_block,
           (size_t)(dataset->launch_test + dataset->launches - (uint8_t *)dataset->launch_block));
    copy_all_rows(subset, dataset, keep);
    return subset;
}

/* Writes the indices of training launches with rows to order[launches]; returns their number. */
static int list_launches(const Dataset *dataset, bool *has_rows, int *order) {
    int count = 0;
    for (int64_t row = 0; row < dataset->rows; row++) has_rows[dataset->launch[row]] = !dataset_is_test(dataset, row);
    for (int i = 0; i < dataset->launches; i++)
        if (has_rows[i]) order[count++] = i;
    return count;
}

static bool draw_kept(const Dataset *dataset, int count, uint64_t seed, bool *keep, int *order, Error *error) {
    const int launches = list_launches(dataset, keep, order);
    if (count < 1 || count > launches)
        return error_input(error, "dataset", "%d training launches requested; expected 1 to %d", count, launches);
    gsl_set_error_handler_off(); /* its default aborts */
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    if (generator == NULL) return error_memory(error, "dataset");
    gsl_rng_set(generator, (unsigned long)seed);
    gsl_ran_shuffle(generator, order, (size_t)launches, sizeof *order);
    gsl_rng_free(generator);
    memset(keep, 0, (size_t)dataset->launches * sizeof *keep);
    for (int i = 0; i < count; i++) keep[order[i]] = true;
    return true;
}

Dataset *dataset_draw_subset(const Dataset *dataset, int count, uint64_t seed, Error *error) {
    bool *keep = calloc((size_t)dataset->launches, sizeof *keep);
    int *order = malloc((size_t)dataset->launches * sizeof *order);
    Dataset *subset = NULL;
    if (keep == NULL || order == NULL)
        error_memory(error, "dataset");
    else if (draw_kept(dataset, count, seed, keep, order, error))
        subset = dataset_subset(dataset, keep, error);
    free(order);
    free(keep);
    return subset;
}

/* The paper's random launches (3.3). */
static const double random_x = 15, random_rotation = 1.5, random_spin = 20;

static float dataset_draw(const gsl_rng *generator, double limit) {
    return (float)gsl_ran_flat(generator, -limit, limit);
}

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
            out[k].x = dataset_draw(generator, random_x);
            out[k].rotation = dataset_draw(generator, random_rotation);
            out[k].spin = dataset_draw(generator, random_spin);
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
static bool dataset_split(Dataset *dataset, int launches_per_scene, const gsl_rng *generator) {
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
static bool dataset_fill(Dataset *dataset, const DatasetOptions *options, Scene *const *scenes, Error *error) {
    gsl_set_error_handler_off(); /* its default aborts */
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    if (generator == NULL) return error_memory(error, "dataset");
    gsl_rng_set(generator, (unsigned long)options->seed);
    bool ok = dataset_split(dataset, dataset_launches_each(options), generator) || error_memory(error, "dataset");
    ok = ok && put_launches(dataset, options, scenes, generator, error);
    gsl_rng_free(generator);
    return ok;
}

Dataset *dataset_of_launches(const DatasetOptions *options, Scene *const *scenes, Error *error) {
    Dataset *dataset = calloc(1, sizeof *dataset);
    if (dataset == NULL) return error_memory(error, "dataset"), NULL;
    dataset->view = options->view;
    dataset->target = options->target;
    dataset->labels = options->labels;
    dataset->scene_count = options->scene_count;
    for (int i = 0; i < options->scene_count; i++) strcpy(dataset->scenes[i], scenes[i]->name);
    if ((dataset_make_launches(dataset, options->scene_count * dataset_launches_each(options)) ||
         error_memory(error, "dataset")) &&
        dataset_fill(dataset, options, scenes, error))
        return dataset;
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
