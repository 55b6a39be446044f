/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Datasets: their launches, the rows of a launch, recording, and subsets. */
#include "learning/dataset.h"

#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/launches.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "methods/reference.h"
#include "methods/sweeps.h"
#include "runs/launch_check.h"
#include "scenes/scenes.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

/* The paper's random launches (3.3). */
static const double random_x = 15, random_rotation = 1.5, random_spin = 20;

static int launches_each(const DatasetOptions *options) {
    const int given = options->bomb_x.count + options->random;
    return options->table != NULL ? options->table->count : given > 0 ? given : LAUNCH_GRID;
}

/* Those of the table; or swept launches first, then random ones; or those of the scene's family. */
static bool choose_launches(const DatasetOptions *options, const Scene *scene, const gsl_rng *generator, Launch *out,
                            Error *error) {
    const int given = options->bomb_x.count + options->random, each = launches_each(options);
    const Launch own = launch_of(scene);
    bool ok = true;
    if (options->table != NULL)
        ok = launches_for(options->table, scene, out, error);
    else if (given == 0)
        ok = launches_for_training(scene, LAUNCH_GRID, out, error);
    for (int k = 0; options->table == NULL && k < given; k++) {
        out[k] = own;
        if (k < options->bomb_x.count) {
            out[k].x = range_value(&options->bomb_x, k);
        } else {
            out[k].x = (float)gsl_ran_flat(generator, -random_x, random_x);
            out[k].rotation = (float)gsl_ran_flat(generator, -random_rotation, random_rotation);
            out[k].spin = (float)gsl_ran_flat(generator, -random_spin, random_spin);
        }
    }
    for (int k = 0; ok && k < each; k++)
        if (out[k].mass != own.mass || out[k].frame != own.frame) /* a dataset has no columns for them */
            ok = error_input(error, scene->name,
                             "a dataset has one mass and one frame of the bomb; the launches have others");
    return ok && launches_check(scene, out, each, error);
}

/* Holds out a fifth of each scene's launches. NULL with error set when memory is short, else the generator. */
static gsl_rng *draw_split(const Dataset *dataset, uint64_t seed, uint8_t *test, Error *error) {
    const int each = dataset->launches / dataset->scene_count;
    gsl_set_error_handler_off(); /* its default aborts */
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    int *order = malloc((size_t)each * sizeof *order);
    if (generator == NULL || order == NULL) {
        if (generator != NULL) gsl_rng_free(generator);
        free(order);
        return error_memory(error, "dataset"), NULL;
    }
    gsl_rng_set(generator, (unsigned long)seed);
    memset(test, 0, (size_t)dataset->launches * sizeof *test);
    for (int scene = 0; scene < dataset->scene_count; scene++) {
        for (int i = 0; i < each; i++) order[i] = i;
        gsl_ran_shuffle(generator, order, (size_t)each, sizeof *order);
        for (int i = 0; i < each / 5; i++) test[scene * each + order[i]] = 1;
    }
    free(order);
    return generator;
}

bool dataset_split(const Dataset *dataset, uint64_t seed, uint8_t *test, Error *error) {
    gsl_rng *generator = draw_split(dataset, seed, test, error);
    if (generator != NULL) gsl_rng_free(generator);
    return generator != NULL;
}

/* Fills the launch tables. The split is drawn first, so that it does not depend on later draws. */
static bool fill_launches(Dataset *dataset, const DatasetOptions *options, Scene *const *scenes, Error *error) {
    const int each = launches_each(options);
    gsl_rng *generator = draw_split(dataset, options->seed, dataset->launch_test, error);
    Launch *launches = calloc((size_t)each, sizeof *launches);
    bool ok = generator != NULL && (launches != NULL || error_memory(error, "dataset"));
    for (int scene = 0; ok && scene < dataset->scene_count; scene++) {
        ok = choose_launches(options, scenes[scene], generator, launches, error);
        for (int i = 0; ok && i < each; i++) {
            const int at = scene * each + i;
            dataset->launch_scene[at] = scene;
            dataset->launch_x[at] = launches[i].x;
            dataset->launch_rotation[at] = launches[i].rotation;
            dataset->launch_spin[at] = launches[i].spin;
        }
    }
    if (generator != NULL) gsl_rng_free(generator);
    free(launches);
    return ok;
}

static Dataset *dataset_of_launches(const DatasetOptions *options, Scene *const *scenes, Error *error) {
    Dataset *dataset = calloc(1, sizeof *dataset);
    if (dataset == NULL) return error_memory(error, "dataset"), NULL;
    dataset->view = options->view;
    dataset->target = options->target;
    dataset->labels = options->labels;
    dataset->scene_count = options->scene_count;
    for (int i = 0; i < options->scene_count; i++) strcpy(dataset->scenes[i], scenes[i]->name);
    if ((dataset_make_launches(dataset, options->scene_count * launches_each(options)) ||
         error_memory(error, "dataset")) &&
        fill_launches(dataset, options, scenes, error))
        return dataset;
    dataset_destroy(dataset);
    return NULL;
}

/* One touching pair in one step, or in one sweep of it. */
typedef struct PairRow {
    float inputs[PAIR_INPUTS_MAX], changes[PAIR_CHANGES], context[PAIR_CONTEXT];
    int32_t frame, bodies[2];
} PairRow;

/* The rows of one launch. */
typedef struct LaunchRows {
    PairRow *rows;
    size_t count, capacity;
    size_t seen;     /* rows, of which one in `every` is kept; the others are made in `left_out` */
    size_t start;    /* index of its first row in the dataset */
    int unconverged; /* as in Dataset */
    PairRow left_out;
} LaunchRows;

/* What is recorded; shared by the threads. */
typedef struct Recording {
    const DatasetOptions *options;
    Scene *scenes[DATASET_MAX_SCENES];
    Dataset *dataset;     /* its launches, and no rows yet */
    LaunchRows *launches; /* [dataset->launches] */
} Recording;

static bool reserve(PairMoment *moment, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    if (!pair_moment_reserve(moment, problem)) return error_memory(error, "dataset");
    *solution = pair_moment_solution(moment);
    return true;
}

/* Appends a row of a pair with its current inputs (pair_inputs). NULL when memory is short. */
static PairRow *add_row(const Recording *recording, const LaunchStep *step, int first, const PairMoment *now) {
    LaunchRows *launch = &recording->launches[step->launch];
    const ContactProblem *problem = step->problem;
    const size_t every = recording->options->every > 1 ? (size_t)recording->options->every : 1;
    const bool kept = launch->seen++ % every == (size_t)step->launch % every;
    if (!array_reserve((void **)&launch->rows, &launch->capacity, launch->count + 1, sizeof *launch->rows)) return NULL;
    PairRow *row = kept ? &launch->rows[launch->count++] : &launch->left_out;
    row->frame = step->frame;
    row->bodies[0] = problem->contacts[first].a;
    row->bodies[1] = problem->contacts[first].b;
    pair_inputs(problem, now, first, recording->dataset->view, row->inputs);
    return row;
}

/* The state after the warm start, before the first sweep. */
static SequentialOptions sweeps_of(const Scene *scene) {
    return (SequentialOptions){.accumulate = scene->accumulate_impulses, .warm = true};
}

static bool record_step(void *context, const LaunchStep *step, Error *error) {
    const Recording *recording = context;
    const Dataset *dataset = recording->dataset;
    const ContactProblem *problem = step->problem;
    const SequentialOptions options = sweeps_of(step->scene);
    ContactSolution solution = *world_solution(step->world), begun;
    if (dataset->labels == DATASET_BY_REFERENCE) {
        if (!reference_solve(step->reference, problem, NULL, error)) return false;
        if (!reference_converged(step->reference)) {
            recording->launches[step->launch].unconverged++;
            return true;
        }
        if (!reserve(step->labels, problem, &solution, error)) return false;
        reference_round(step->reference, problem, &solution);
    }
    if (!reserve(step->now, problem, &begun, error)) return false;
    const bool by_contact = pair_views[dataset->view].by_contact;
    if (by_contact) sequential_impulses_begin(problem, &options, &begun);
    if (dataset->view == PAIR_NEIGHBOURS) pair_moment_jacobi(step->now, problem);
    for (int first = 0; first < problem->contact_count; first += pair_contact_count(problem, first)) {
        PairRow *row = add_row(recording, step, first, by_contact ? step->now : NULL);
        if (row == NULL) return error_memory(error, "dataset");
        pair_step_changes(problem, &solution, first, dataset->view, dataset->target, row->changes);
        pair_context(problem, first, row->context);
    }
    return true;
}

/* Repeats the engine's sweeps with the scalar reference implementation, pair by pair. */
static bool record_visits(void *context, const LaunchStep *step, Error *error) {
    const Recording *recording = context;
    const ContactProblem *problem = step->problem;
    const SequentialOptions options = sweeps_of(step->scene);
    ContactSolution now;
    if (!reserve(step->now, problem, &now, error)) return false;
    sequential_impulses_begin(problem, &options, &now);
    for (int sweep = 0; sweep < step->scene->iterations; sweep++)
        for (int first = 0, count; first < problem->contact_count; first += count) {
            count = pair_contact_count(problem, first);
            PairRow *row = add_row(recording, step, first, step->now);
            if (row == NULL) return error_memory(error, "dataset");
            const BodyVelocity *a = &now.velocities[row->bodies[0]], *b = &now.velocities[row->bodies[1]];
            BodyVelocity before_a = *a, before_b = *b;
            sequential_impulses_visit(problem, &options, first, count, &now);
            const float changes[PAIR_CHANGES] = {a->linear.x - before_a.linear.x, a->linear.y - before_a.linear.y,
                                                 a->angular - before_a.angular,   b->linear.x - before_b.linear.x,
                                                 b->linear.y - before_b.linear.y, b->angular - before_b.angular};
            memcpy(row->changes, changes, sizeof changes);
            if (pair_views[recording->dataset->view].by_contact)
                pair_to_contact_frame(&problem->contacts[first], row->changes);
        }
    return true;
}

/* Runs the launches of a scene with the engine. */
static bool record_scene(const Recording *recording, int scene, const Progress *progress, Error *error) {
    const Dataset *dataset = recording->dataset;
    const int each = dataset->launches / dataset->scene_count, first = scene * each;
    Method engine;
    Launch *launches = calloc((size_t)each, sizeof *launches);
    for (int i = 0; launches != NULL && i < each; i++) {
        launches[i] = launch_of(recording->scenes[scene]);
        launches[i].x = dataset->launch_x[first + i];
        launches[i].rotation = dataset->launch_rotation[first + i];
        launches[i].spin = dataset->launch_spin[first + i];
    }
    const LaunchWatch watch = {.scene = recording->scenes[scene],
                               .launches = launches,
                               .count = each,
                               .first = first,
                               .impact_frames = 1,
                               .after_frames = recording->scenes[scene]->frames,
                               .method = &engine,
                               .see = dataset->target == TARGET_IMPULSE ? record_visits : record_step,
                               .context = (void *)recording};
    const bool ok = (launches != NULL || error_memory(error, "dataset")) && method_parse(&engine, "engine", error) &&
                    launches_observe(&watch, NULL, progress, error);
    free(launches);
    return ok;
}

/* Concatenates the rows of the launches, in order. */
static bool gather(const Recording *recording, Error *error) {
    Dataset *dataset = recording->dataset;
    LaunchRows *launches = recording->launches;
    const size_t inputs = (size_t)dataset_inputs(dataset), changes = (size_t)pair_change_count(dataset->target);
    size_t rows = 0;
    for (int i = 0; i < dataset->launches; i++) {
        launches[i].start = rows;
        rows += launches[i].count;
        dataset->unconverged += launches[i].unconverged;
    }
    if (rows == 0 && dataset->unconverged > 0)
        return error_input(error, "dataset", "the reference converges in no step in which bodies touch");
    if (rows == 0) return error_input(error, "dataset", "no two bodies touched in any launch");
    if (!dataset_make_rows(dataset, (int64_t)rows, recording->options->context)) return error_memory(error, "dataset");
        /* In parallel: most of the time is page faults at the first write. */
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < dataset->launches; i++) {
        size_t at = launches[i].start;
        for (size_t k = 0; k < launches[i].count; k++, at++) {
            const PairRow *row = &launches[i].rows[k];
            memcpy(dataset->inputs + at * inputs, row->inputs, inputs * sizeof *row->inputs);
            memcpy(dataset->changes + at * changes, row->changes, changes * sizeof *row->changes);
            if (dataset->context != NULL)
                memcpy(dataset->context + at * PAIR_CONTEXT, row->context, sizeof row->context);
            dataset->launch[at] = i;
            dataset->frame[at] = row->frame;
            memcpy(dataset->bodies + at * 2, row->bodies, sizeof row->bodies);
        }
        free(launches[i].rows);
        launches[i].rows = NULL;
    }
    return true;
}

static bool check_options(const DatasetOptions *options, Error *error) {
    const int launches = launches_each(options);
    if (options->scene_count < 1 || options->scene_count > DATASET_MAX_SCENES)
        return error_input(error, "dataset", "%d scenes; expected 1 to %d", options->scene_count, DATASET_MAX_SCENES);
    if (launches < 5 || launches > DATASET_MAX_LAUNCHES)
        return error_input(error, "dataset",
                           "%d launches per scene; expected at least 5, to hold out a fifth, and at most %d", launches,
                           DATASET_MAX_LAUNCHES);
    if (options->target == TARGET_IMPULSE && options->labels == DATASET_BY_REFERENCE)
        return error_input(error, "dataset",
                           "the target impulse is the change by a sweep of the engine; the reference has none");
    if (options->target == TARGET_IMPULSE && options->view == PAIR_NEIGHBOURS)
        return error_input(error, "dataset", "the target impulse has no view neighbours: they change at every visit");
    if (options->target == TARGET_POINTS && !pair_views[options->view].by_contact)
        return error_input(error, "dataset",
                           "the target points needs the view contact or neighbours, whose inputs have the warm start");
    return !options->context || options->target == TARGET_PAIR ||
           error_input(error, "dataset", "the context is for laws on the target pair; the target %s has none",
                       pair_target_names[options->target]);
}

Dataset *dataset_record(const DatasetOptions *options, const Progress *progress, Error *error) {
    Recording recording = {.options = options};
    bool ok = check_options(options, error);
    for (int i = 0; ok && i < options->scene_count; i++) {
        const Scene *scene = recording.scenes[i] = scene_read(options->scenes[i], error);
        ok = scene != NULL &&
             (scene->bomb.present || error_input(error, options->scenes[i], "the scene has no bomb to launch"));
    }
    Dataset *dataset = recording.dataset = ok ? dataset_of_launches(options, recording.scenes, error) : NULL;
    ok = dataset != NULL;
    if (ok) {
        recording.launches = calloc((size_t)dataset->launches, sizeof *recording.launches);
        ok = recording.launches != NULL || error_memory(error, "dataset");
        ProgressStage stage = {.whole = progress};
        for (int scene = 0; ok && scene < dataset->scene_count; scene++) {
            progress_next_stage(&stage, 1.0 / dataset->scene_count);
            ok = record_scene(&recording, scene, &(Progress){progress_stage, &stage}, error);
        }
        ok = ok && gather(&recording, error);
        for (int i = 0; recording.launches != NULL && i < dataset->launches; i++) free(recording.launches[i].rows);
        free(recording.launches);
    }
    for (int i = 0; i < DATASET_MAX_SCENES; i++) scene_destroy(recording.scenes[i]);
    if (ok) return dataset;
    dataset_destroy(dataset);
    return NULL;
}

static bool is_kept(const Dataset *dataset, const bool *keep, int64_t row) {
    return dataset_is_test(dataset, row) || keep[dataset->launch[row]];
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
           (size_t)(subset->launch_test - (uint8_t *)subset->launch_block));
    memcpy(subset->launch_test, dataset->launch_test, (size_t)dataset->launches); /* of a view, elsewhere */
    DatasetArrays to, from;
    const int count = dataset_arrays(subset, &to);
    dataset_arrays(dataset, &from);
    for (int i = DATASET_FIRST_ROWS; i < count; i++) {
        const NpzArray *array = &from.list[i];
        const size_t size = sizeof(float) * (array->rank == 2 ? (size_t)array->shape[1] : 1); /* of a row */
        char *at = (char *)to.list[i].data;
        for (int64_t row = 0; row < dataset->rows; row++) {
            if (!is_kept(dataset, keep, row)) continue;
            memcpy(at, (const char *)array->data + (size_t)row * size, size);
            at += size;
        }
    }
    return subset;
}

/* Marks `count` training launches with rows; order[launches] is work space. */
static bool draw_kept(const Dataset *dataset, int count, uint64_t seed, bool *keep, int *order, Error *error) {
    int launches = 0;
    for (int64_t row = 0; row < dataset->rows; row++) keep[dataset->launch[row]] = !dataset_is_test(dataset, row);
    for (int i = 0; i < dataset->launches; i++)
        if (keep[i]) order[launches++] = i;
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
