/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/frozen.h"

#include "common/array.h"
#include "simulate/simulate.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

void snapshots_free(SnapshotList *list) {
    for (int i = 0; i < list->count; i++) {
        world_destroy(list->items[i].world);
        free(list->items[i].reference);
        free(list->items[i].no_push_out);
    }
    free(list->items);
    *list = (SnapshotList){0};
}

static World *empty_world(const Scene *scene, Error *error) {
    Scene empty = *scene;
    empty.body_count = 0;
    empty.bomb.present = false;
    return scene_world(&empty, error);
}

/* A copy of the converged velocities of a step, or NULL with error set. */
static ReferenceVelocity *converged_velocities(SnapshotList *list, ConvergedStep *converged,
                                               const ContactProblem *problem, bool push_out, Error *error) {
    const size_t size = (size_t)problem->body_count * sizeof(ReferenceVelocity);
    if (!converged_step_solve(converged, problem, push_out, error)) return NULL;
    if (converged->reference.residual > list->residual) list->residual = converged->reference.residual;
    ReferenceVelocity *copy = malloc(size + 1);
    if (copy == NULL) error_memory(error, "study");
    if (copy != NULL && size > 0) memcpy(copy, converged->reference.velocities, size);
    return copy;
}

/* Stores the state before the step that led to `after`, and the step's converged velocities. */
static bool store(SnapshotList *list, const Scene *scene, const World *before, const World *after, int frame,
                  Phase phase, ConvergedStep *converged, Error *error) {
    const ContactProblem *problem = world_problem(after);
    if (!array_reserve((void **)&list->items, &list->capacity, (size_t)list->count + 1, sizeof *list->items))
        return error_memory(error, "study");
    Snapshot *snapshot = &list->items[list->count++];
    *snapshot = (Snapshot){.scene = scene, .frame = frame, .phase = phase};
    snapshot->reference = converged_velocities(list, converged, problem, true, error);
    if (snapshot->reference == NULL) return false;
    if (list->no_push_out) {
        snapshot->no_push_out = converged_velocities(list, converged, problem, false, error);
        if (snapshot->no_push_out == NULL) return false;
    }
    snapshot->world = empty_world(scene, error);
    return snapshot->world != NULL && world_copy(snapshot->world, before, error);
}

typedef struct Sampler {
    Stepper *engine;
    World *world, *before;
    ConvergedStep converged;
} Sampler;

static bool sample(SnapshotList *list, Sampler *sampler, const Scene *launched, const Sampling *sampling,
                   Error *error) {
    PhaseTracker tracker = {.impact_frames = launched->bomb.impact_frames};
    for (int frame = 1; frame <= launched->frames; frame++) {
        const Step step = {.scene = launched, .frame = frame};
        if (!world_copy(sampler->before, sampler->world, error) ||
            !simulate_step(sampler->engine, sampler->world, &step, error))
            return false;
        Phase phase = phase_next(&tracker, world_problem(sampler->world), frame);
        if (sampling_takes(sampling, phase, &tracker, frame) &&
            !store(list, launched, sampler->before, sampler->world, frame, phase, &sampler->converged, error))
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
              sample(list, &sampler, launched, sampling, error);
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
        const Step step = {.scene = snapshot->scene, .frame = snapshot->frame};
        if (!world_copy(world, snapshot->world, error) || !stepper_step(stepper, world, &step, error)) return false;
        if (!step_scores_add(&scores[snapshot->phase], snapshot->frame, world_problem(world),
                             world_solution(world)->velocities, push_out ? snapshot->reference : snapshot->no_push_out))
            return error_memory(error, "study");
    }
    return true;
}
