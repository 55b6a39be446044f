/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The frozen protocol: steps of the engine, and the scores of a method on them. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "runs/runs.h"
#include "scenes/scenes.h"
#include "studies/frozen.h"
#include "studies/rollout.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

static void snapshot_free(Snapshot *snapshot) {
    world_destroy(snapshot->world);
    free(snapshot->reference);
    free(snapshot->no_push_out);
}

void snapshots_free(SnapshotList *list) {
    for (int i = 0; i < list->count; i++) snapshot_free(&list->items[i]);
    free(list->items);
    *list = (SnapshotList){0};
}

static World *empty_world(const Scene *scene, Error *error) {
    Scene empty = *scene;
    empty.body_count = 0;
    empty.bomb.present = false;
    return scene_world(&empty, error);
}

/* *velocities: a copy of the converged velocities of a step, or NULL if the solve has not converged. */
static bool converged_velocities(ConvergedStep *converged, const ContactProblem *problem, bool push_out,
                                 ReferenceVelocity **velocities, Error *error) {
    const size_t size = (size_t)problem->body_count * sizeof **velocities;
    if (!converged_step_solve(converged, problem, push_out, error)) return false;
    if (!converged_step_found(converged)) return true;
    *velocities = malloc(size + 1);
    if (*velocities == NULL) return error_memory(error, "study");
    if (size > 0) memcpy(*velocities, converged->reference.velocities, size);
    return true;
}

/* Stores the state before the step that led to `after`, and the step's converged velocities, if there are any. */
static bool frozen_store(SnapshotList *list, const Scene *scene, const World *before, const World *after, int frame,
                         Phase phase, ConvergedStep *converged, Error *error) {
    const ContactProblem *problem = world_problem(after);
    if (!array_reserve((void **)&list->items, &list->capacity, (size_t)list->count + 1, sizeof *list->items))
        return error_memory(error, "study");
    Snapshot *snapshot = &list->items[list->count];
    *snapshot = (Snapshot){.scene = scene, .frame = frame, .phase = phase};
    bool ok = converged_velocities(converged, problem, true, &snapshot->reference, error);
    if (ok && list->no_push_out) ok = converged_velocities(converged, problem, false, &snapshot->no_push_out, error);
    if (ok && (snapshot->reference == NULL || (list->no_push_out && snapshot->no_push_out == NULL))) {
        snapshot_free(snapshot);
        list->unconverged++;
        return true;
    }
    list->count++;
    if (ok) snapshot->world = empty_world(scene, error);
    return ok && snapshot->world != NULL && world_copy(snapshot->world, before, error);
}

typedef struct Sampler {
    Stepper *engine;
    World *world, *before;
    ConvergedStep converged;
} Sampler;

static bool frozen_sample(SnapshotList *list, Sampler *sampler, const Scene *launched, const Sampling *sampling,
                          Error *error) {
    PhaseTracker tracker = {.impact_frames = launched->bomb.impact_frames};
    for (int frame = 1; frame <= launched->frames; frame++) {
        const Step step = {.scene = launched, .frame = frame};
        if (!world_copy(sampler->before, sampler->world, error) ||
            !simulate_step(sampler->engine, sampler->world, &step, error))
            return false;
        Phase phase = phase_next(&tracker, world_problem(sampler->world), frame);
        if (sampling_takes(sampling, phase, &tracker, frame) &&
            !frozen_store(list, launched, sampler->before, sampler->world, frame, phase, &sampler->converged, error))
            return false;
    }
    return true;
}

bool snapshots_add(SnapshotList *list, const Scene *launched, const Sampling *sampling, Error *error) {
    Method engine;
    if (!method_parse(&engine, "engine", error)) return false;
    Sampler sampler = {.engine = stepper_create(&engine, launched, error),
                       .world = scene_world(launched, error),
                       .before = empty_world(launched, error)};
    bool ok = sampler.engine != NULL && sampler.world != NULL && sampler.before != NULL &&
              frozen_sample(list, &sampler, launched, sampling, error);
    stepper_destroy(sampler.engine);
    world_destroy(sampler.world);
    world_destroy(sampler.before);
    converged_step_free(&sampler.converged);
    return ok;
}

bool snapshots_score(const SnapshotList *list, Stepper *stepper, World *world, StepScores scores[PHASES],
                     Error *error) {
    const bool push_out = !stepper_describe(stepper)->no_push_out;
    assert(push_out || list->no_push_out);
    for (int i = 0; i < list->count; i++) {
        const Snapshot *snapshot = &list->items[i];
        const Step step = {.scene = snapshot->scene, .frame = snapshot->frame, .engine_step = true};
        Error failure = {0};
        if (!world_copy(world, snapshot->world, error)) return false;
        if (!stepper_step(stepper, world, &step, &failure)) {
            if (failure.failure == FAILURE_ADAPTER) return true; /* as in closed loop */
            *error = failure;
            return false;
        }
        if (!step_scores_add(&scores[snapshot->phase], snapshot->frame, world_problem(world), world_solution(world),
                             push_out ? snapshot->reference : snapshot->no_push_out, push_out))
            return error_memory(error, "study");
    }
    return true;
}
