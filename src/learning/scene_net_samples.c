/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Samples of scene-net: copies of problems, labels, inputs, bytes; and the launches that they are from. */
#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/scene_training.h"
#include "learning/scene_training_internal.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "methods/residual.h"
#include "methods/scene_net.h"
#include "methods/sweeps.h"
#include "nets/kinds.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

bool problem_copy(ContactProblem *copy, const ContactProblem *problem) {
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    ProblemBody *block = malloc(bodies * sizeof *problem->bodies + contacts * sizeof *problem->contacts + 1);
    *copy = *problem;
    copy->bodies = block;
    copy->contacts = block != NULL ? (ContactPoint *)(block + bodies) : NULL;
    if (block == NULL) return false;
    memcpy(block, problem->bodies, bodies * sizeof *problem->bodies);
    if (contacts > 0) memcpy(block + bodies, problem->contacts, contacts * sizeof *problem->contacts);
    return true;
}

void problem_copy_free(ContactProblem *copy) { free((void *)copy->bodies); }

static void free_sample(SceneNetSample *sample) {
    problem_copy_free(&sample->problem);
    free(sample->reference);
    free(sample->goal);
    unrolled_problem_free(&sample->unrolled);
    scene_view_free(&sample->view);
    free(sample->inputs);
}

void scene_net_samples_free(SceneNetSamples *samples) {
    for (int i = 0; i < samples->count; i++) free_sample(&samples->items[i]);
    free(samples->items);
    *samples = (SceneNetSamples){0};
}

static bool scene_net_samples_reserve(SceneNetSamples *samples, int count) {
    return array_reserve((void **)&samples->items, &samples->capacity, (size_t)samples->count + (size_t)count,
                         sizeof *samples->items);
}

bool scene_net_samples_add(SceneNetSamples *samples, const ContactProblem *problem, int launch, int since) {
    if (!scene_net_samples_reserve(samples, 1)) return false;
    SceneNetSample *sample = &samples->items[samples->count++];
    *sample = (SceneNetSample){.launch = launch, .since = since};
    return problem_copy(&sample->problem, problem);
}

bool scene_net_samples_move(SceneNetSamples *samples, SceneNetSamples *from) {
    if (!scene_net_samples_reserve(samples, from->count + 1)) return false;
    for (int i = 0; i < from->count; i++) samples->items[samples->count++] = from->items[i];
    samples->unconverged += from->unconverged;
    free(from->items);
    *from = (SceneNetSamples){0};
    return true;
}

typedef struct Labels {
    SceneNetSample *items;
    Reference *references; /* [threads] */
} Labels;

/* Everything of a label but the goal's impulses. */
static bool begin_label(SceneNetSample *sample, const ReferenceVelocity *velocities) {
    const size_t bodies = (size_t)sample->problem.body_count, contacts = (size_t)sample->problem.contact_count;
    sample->reference = malloc(bodies * sizeof *sample->reference + 1);
    sample->goal = malloc(contacts * sizeof *sample->goal + 1);
    if (sample->reference == NULL || sample->goal == NULL ||
        !unrolled_problem_make(&sample->unrolled, &sample->problem))
        return false;
    memcpy(sample->reference, velocities, bodies * sizeof *sample->reference);
    return true;
}

static bool label_scene_net_samples(void *context, int i, Error *error) {
    const Labels *labels = context;
    SceneNetSample *sample = &labels->items[i];
    Reference *reference = &labels->references[omp_get_thread_num()];
    if (!reference_solve(reference, &sample->problem, NULL, error)) return false;
    if (!reference_converged(reference)) return true; /* no label */
    if (!begin_label(sample, reference->velocities)) return error_memory(error, "labels");
    for (int k = 0; k < sample->problem.contact_count; k++)
        sample->goal[k] = (ContactImpulse){(float)reference->impulses[k].normal, (float)reference->impulses[k].tangent};
    return true;
}

static void leave_out_unlabelled(SceneNetSamples *samples, int first) {
    int kept = first;
    for (int i = first; i < samples->count; i++) {
        if (samples->items[i].goal != NULL)
            samples->items[kept++] = samples->items[i];
        else
            free_sample(&samples->items[i]);
    }
    samples->unconverged += samples->count - kept;
    samples->count = kept;
}

bool scene_net_samples_label(SceneNetSamples *samples, int first, const Progress *progress, Error *error) {
    const int threads = omp_get_max_threads();
    Reference *references = calloc((size_t)threads, sizeof *references);
    if (references == NULL) return error_memory(error, "labels");
    Labels labels = {samples->items + first, references};
    const ParallelWork work = {label_scene_net_samples, &labels};
    bool ok = parallel_for(&work, samples->count - first, "labels", progress, error);
    for (int i = 0; i < threads; i++) reference_free(&references[i]);
    free(references);
    if (ok) leave_out_unlabelled(samples, first);
    return ok;
}

bool scene_net_samples_compute_inputs(SceneNetSamples *samples, int first, const SceneNet *network, Error *error) {
    bool ok = true;
#pragma omp parallel for schedule(dynamic, 64) reduction(&& : ok)
    for (int i = first; i < samples->count; i++) {
        SceneNetSample *sample = &samples->items[i];
        bool fine = scene_view_take(&sample->view, network, &sample->problem);
        if (fine && sample->inputs == NULL)
            sample->inputs = malloc((size_t)scene_net_inputs(network) * sizeof *sample->inputs);
        fine = fine && sample->inputs != NULL;
        if (fine) scene_net_look(network, &sample->view.slots, sample->inputs);
        ok = ok && fine;
    }
    return ok || error_memory(error, "samples");
}

/* *finite: false if the new state is NaN or infinite. */
static bool scene_net_samples_step(const Scene *scene, const ContactSolver *solver, World *world, bool *finite,
                                   Error *error) {
    Error failure = {0};
    *finite = world_step(world, solver->kind->solve, solver->state, scene->dt, &failure);
    if (*finite || failure.failure != FAILURE_NONE) return true;
    *error = failure;
    return false;
}

World *launch_prefix(const Scene *scene, const ContactSolver *solver, Error *error) {
    Scene quiet = *scene;
    quiet.bomb.present = false;
    World *world = scene_world(&quiet, error);
    bool ok = world != NULL, finite = true;
    for (int frame = 1; ok && frame <= scene->bomb.frame; frame++)
        ok = scene_net_samples_step(scene, solver, world, &finite, error) &&
             (finite || error_input(error, quiet.name, "a body's state is NaN or infinite before the bomb is added"));
    if (ok) return world;
    world_destroy(world);
    return NULL;
}

bool launch_run(const Scene *scene, const Launch *launch, const World *prefix, const ContactSolver *solver, int steps,
                LaunchSee *see, void *context, Error *error) {
    const Scene launched = launch_scene(scene, launch);
    World *world = scene_world(scene, error);
    PhaseTracker tracker = {.impact_frames = steps};
    Phase phase = PHASE_REST;
    bool ok = world != NULL && world_copy(world, prefix, error) && scene_add_bomb(&launched, world, error),
         finite = true;
    for (int frame = launched.bomb.frame + 1; ok && finite && phase != PHASE_AFTER && frame <= launched.frames;
         frame++) {
        ok = scene_net_samples_step(scene, solver, world, &finite, error);
        if (!ok) break;
        phase = phase_next(&tracker, world_problem(world), frame);
        ok = see(context, world_problem(world), phase, frame - tracker.touch, error);
    }
    world_destroy(world);
    return ok;
}

typedef struct Runs {
    const SceneNetRollout *rollout;
    World *prefix;
    SceneNetSamples *samples; /* [launches] */
} Runs;

/* One launch. */
typedef struct Run {
    const SceneNetRollout *rollout;
    int launch;
    SceneNetSamples *samples;
    Sweeps sweeps;
} Run;

static bool keep_impact(void *context, const ContactProblem *problem, Phase phase, int since, Error *error) {
    Run *run = context;
    if (phase != PHASE_IMPACT) return true;
    return (sweeps_begin_coloured(&run->sweeps, sweeps_best_kernel(), problem) &&
            (!residual_reaches(&run->sweeps, problem->contact_count, run->rollout->gate) ||
             scene_net_samples_add(run->samples, problem, run->launch, since))) ||
           error_memory(error, "samples");
}

static bool run_launch(void *context, int i, Error *error) {
    const Runs *runs = context;
    const SceneNetRollout *rollout = runs->rollout;
    ContactSolver solver = {0};
    Run run = {.rollout = rollout, .launch = rollout->first_launch + i, .samples = &runs->samples[i]};
    const bool ok = rollout->make_solver(rollout->context, &solver, error) &&
                    launch_run(rollout->scene, &rollout->launches[i], runs->prefix, &solver, rollout->steps,
                               keep_impact, &run, error);
    solver_destroy(&solver);
    sweeps_free(&run.sweeps);
    return ok;
}

bool scene_net_rollout(const SceneNetRollout *rollout, SceneNetSamples *samples, const Progress *progress,
                       Error *error) {
    const size_t count = (size_t)rollout->launch_count;
    Runs runs = {.rollout = rollout, .samples = calloc(count, sizeof *runs.samples)};
    ContactSolver solver = {0};
    bool ok = (runs.samples != NULL || error_memory(error, "samples")) &&
              rollout->make_solver(rollout->context, &solver, error);
    if (ok) runs.prefix = launch_prefix(rollout->scene, &solver, error);
    solver_destroy(&solver);
    ok = ok && runs.prefix != NULL &&
         parallel_for(&(ParallelWork){run_launch, &runs}, rollout->launch_count, "launches", progress, error);
    for (size_t i = 0; runs.samples != NULL && i < count; i++) {
        if (ok) ok = scene_net_samples_move(samples, &runs.samples[i]) || error_memory(error, "samples");
        scene_net_samples_free(&runs.samples[i]);
    }
    world_destroy(runs.prefix);
    free(runs.samples);
    return ok;
}
