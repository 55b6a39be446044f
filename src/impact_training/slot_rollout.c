/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact_training/slot_rollout.h"

#include "common/parallel.h"
#include "simulate/phases.h"
#include "solvers/residual.h"

#include <assert.h>
#include <omp.h>
#include <stdlib.h>

typedef struct Runs {
    const SlotRollout *rollout;
    World *prefix;          /* the world just before the bomb is added; shared by all launches */
    ContactSolver *solvers; /* [threads] */
    World **worlds;         /* [threads] */
    Sweeps *sweeps;         /* [threads] */
    SlotSamples *samples;   /* [launches] */
} Runs;

/* One step; `problem` is its contact problem. *finite: false if the new state is NaN or infinite. */
static bool step(const SlotRollout *rollout, const ContactSolver *solver, World *world, ContactProblem *problem,
                 bool *finite, Error *error) {
    ContactSolution *solution;
    if (!world_begin_step(world, rollout->scene->dt, problem, &solution, error) ||
        !solver->kind->solve(solver->state, problem, solution, error))
        return false;
    Error failure = {0};
    *finite = world_end_step(world, &failure);
    if (*finite || failure.kind == ERROR_INPUT) return true;
    *error = failure;
    return false;
}

static bool run_launch(void *context, int i, Error *error) {
    const Runs *runs = context;
    const SlotRollout *rollout = runs->rollout;
    const int thread = omp_get_thread_num();
    const Scene launched = launch_scene(rollout->scene, &rollout->launches[i]);
    World *world = runs->worlds[thread];
    if (!world_copy(world, runs->prefix, error) || !scene_add_bomb(&launched, world, error)) return false;
    PhaseTracker tracker = {.impact_frames = rollout->steps};
    bool finite = true;
    for (int frame = launched.bomb.frame + 1; finite && frame <= launched.frames; frame++) {
        ContactProblem problem;
        if (!step(rollout, &runs->solvers[thread], world, &problem, &finite, error)) return false;
        const Phase phase = phase_next(&tracker, &problem, frame);
        if (phase == PHASE_AFTER) return true;
        if (phase != PHASE_IMPACT) continue;
        Sweeps *sweeps = &runs->sweeps[thread];
        if (!sweeps_begin_coloured(sweeps, sweeps_best_kernel(), &problem)) return error_memory(error, "samples");
        if (residual_reaches(sweeps, problem.contact_count, rollout->gate) &&
            !slot_samples_add(&runs->samples[i], &problem, rollout->first_launch + i, frame - tracker.touch))
            return error_memory(error, "samples");
    }
    return true;
}

/* Runs the scene without its bomb up to the bomb's frame. */
static bool run_prefix(Runs *runs, Error *error) {
    Scene quiet = *runs->rollout->scene;
    quiet.bomb.present = false;
    runs->prefix = scene_world(&quiet, error);
    bool ok = runs->prefix != NULL, finite = true;
    for (int frame = 1; ok && frame <= runs->rollout->scene->bomb.frame; frame++) {
        ContactProblem problem;
        ok = step(runs->rollout, &runs->solvers[0], runs->prefix, &problem, &finite, error) &&
             (finite || error_input(error, quiet.name, "a body's state is NaN or infinite before the bomb is added"));
    }
    return ok;
}

static bool begin(Runs *runs, int threads, Error *error) {
    assert(threads > 0);
    runs->solvers = calloc((size_t)threads, sizeof *runs->solvers);
    runs->worlds = calloc((size_t)threads, sizeof(World *));
    runs->sweeps = calloc((size_t)threads, sizeof *runs->sweeps);
    runs->samples = calloc((size_t)runs->rollout->launch_count, sizeof *runs->samples);
    if (runs->sweeps == NULL || runs->solvers == NULL || runs->worlds == NULL || runs->samples == NULL)
        return error_memory(error, "samples");
    for (int i = 0; i < threads; i++) {
        runs->worlds[i] = scene_world(runs->rollout->scene, error);
        if (runs->worlds[i] == NULL || !runs->rollout->make_solver(runs->rollout->context, &runs->solvers[i], error))
            return false;
    }
    return run_prefix(runs, error);
}

static void end(Runs *runs, int threads) {
    for (int i = 0; i < threads; i++) {
        if (runs->solvers != NULL && runs->solvers[i].kind != NULL)
            runs->solvers[i].kind->destroy(runs->solvers[i].state);
        if (runs->worlds != NULL) world_destroy(runs->worlds[i]);
        if (runs->sweeps != NULL) sweeps_free(&runs->sweeps[i]);
    }
    world_destroy(runs->prefix);
    for (int i = 0; runs->samples != NULL && i < runs->rollout->launch_count; i++) slot_samples_free(&runs->samples[i]);
    free(runs->solvers);
    free(runs->worlds);
    free(runs->sweeps);
    free(runs->samples);
}

bool slot_rollout(const SlotRollout *rollout, SlotSamples *samples, const Progress *progress, Error *error) {
    Runs runs = {.rollout = rollout};
    const int threads = omp_get_max_threads();
    const ParallelWork work = {run_launch, &runs};
    bool ok = begin(&runs, threads, error) && parallel_for(&work, rollout->launch_count, "launches", progress, error);
    for (int i = 0; ok && i < rollout->launch_count; i++)
        ok = slot_samples_move(samples, &runs.samples[i]) || error_memory(error, "samples");
    end(&runs, threads);
    return ok;
}
