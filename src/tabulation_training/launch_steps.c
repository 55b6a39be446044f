/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tabulation_training/launch_steps.h"

#include "common/array.h"
#include "common/clock.h"
#include "simulate/phases.h"

#include <stdlib.h>
#include <string.h>

struct LaunchSteps {
    const Scene *scene;
    World *prefix, *world; /* just before the bomb is added; in use */
};

void asked_steps_clear(AskedSteps *steps) {
    for (int i = 0; i < steps->count; i++) free(steps->items[i].block);
    steps->count = 0;
    steps->steps = 0;
    steps->seconds = 0;
}

void asked_steps_free(AskedSteps *steps) {
    asked_steps_clear(steps);
    free(steps->items);
    *steps = (AskedSteps){0};
}

/* A copy in the block; *at moves on. */
static void *keep(char **at, const void *data, size_t size) {
    void *to = *at;
    if (size > 0) memcpy(to, data, size);
    *at += size;
    return to;
}

static bool see(void *context, const HybridStep *step, Error *error) {
    AskedSteps *steps = context;
    const double begin = clock_thread_seconds();
    const size_t bodies = (size_t)step->problem->body_count, contacts = (size_t)step->problem->contact_count;
    const size_t numbers = TABULATION_NUMBERS * (bodies - 1);
    if (!array_reserve((void **)&steps->items, &steps->capacity, (size_t)steps->count + 1, sizeof *steps->items))
        return error_memory(error, "hybrid");
    AskedStep *copy = &steps->items[steps->count];
    *copy = (AskedStep){.problem = *step->problem, .hash = step->query.hash, .entry = step->entry};
    /* All parts consist of four-byte numbers. */
    char *at = copy->block =
        malloc(bodies * (sizeof(ProblemBody) + sizeof(BodyVelocity)) +
               contacts * (sizeof(ContactPoint) + sizeof(ContactImpulse)) + numbers * sizeof(float));
    if (at == NULL) return error_memory(error, "hybrid");
    steps->count++;
    copy->problem.bodies = keep(&at, step->problem->bodies, bodies * sizeof(ProblemBody));
    copy->problem.contacts = keep(&at, step->problem->contacts, contacts * sizeof(ContactPoint));
    copy->solution.velocities = keep(&at, step->solution->velocities, bodies * sizeof(BodyVelocity));
    copy->solution.impulses = keep(&at, step->solution->impulses, contacts * sizeof(ContactImpulse));
    copy->others = keep(&at, step->others, numbers * sizeof(float));
    memcpy(copy->bomb, step->bomb, sizeof copy->bomb);
    steps->seconds += clock_thread_seconds() - begin;
    return true;
}

/* *finite: false if the new state is NaN or infinite. */
static bool take_step(const Scene *scene, const ContactSolver *solver, World *world, ContactProblem *problem,
                      bool *finite, Error *error) {
    ContactSolution *solution;
    if (!world_begin_step(world, scene->dt, problem, &solution, error) ||
        !solver->kind->solve(solver->state, problem, solution, error))
        return false;
    Error failure = {0};
    *finite = world_end_step(world, &failure);
    if (*finite || failure.kind == ERROR_INPUT) return true;
    *error = failure;
    return false;
}

static bool run_prefix(LaunchSteps *runs, Error *error) {
    Scene quiet = *runs->scene;
    quiet.bomb.present = false;
    ContactSolver solver;
    if (!hybrid_make(&solver, NULL, NULL, error)) return false;
    bool ok = (runs->prefix = scene_world(&quiet, error)) != NULL, finite = true;
    for (int frame = 1; ok && frame <= runs->scene->bomb.frame; frame++) {
        ContactProblem problem;
        ok = take_step(runs->scene, &solver, runs->prefix, &problem, &finite, error) &&
             (finite || error_input(error, quiet.name, "a body's state is NaN or infinite before the bomb is added"));
    }
    solver.kind->destroy(solver.state);
    return ok;
}

LaunchSteps *launch_steps_create(const Scene *scene, Error *error) {
    LaunchSteps *runs = calloc(1, sizeof *runs);
    if (runs == NULL) {
        error_memory(error, "hybrid");
        return NULL;
    }
    runs->scene = scene;
    runs->world = scene_world(scene, error);
    if (runs->world != NULL && run_prefix(runs, error)) return runs;
    launch_steps_destroy(runs);
    return NULL;
}

void launch_steps_destroy(LaunchSteps *runs) {
    if (runs == NULL) return;
    world_destroy(runs->prefix);
    world_destroy(runs->world);
    free(runs);
}

bool launch_steps_run(LaunchSteps *runs, const Launch *launch, const Tabulation *memory, int steps, AskedSteps *asked,
                      Error *error) {
    const Scene launched = launch_scene(runs->scene, launch);
    ContactSolver solver;
    if (!world_copy(runs->world, runs->prefix, error) || !scene_add_bomb(&launched, runs->world, error) ||
        !hybrid_make(&solver, memory, &(HybridWatch){see, asked}, error))
        return false;
    PhaseTracker tracker = {.impact_frames = steps};
    bool ok = true, finite = true;
    for (int frame = launched.bomb.frame + 1; ok && finite && frame <= launched.frames; frame++) {
        ContactProblem problem;
        ok = take_step(runs->scene, &solver, runs->world, &problem, &finite, error);
        asked->steps++;
        if (ok && phase_next(&tracker, &problem, frame) == PHASE_AFTER) break;
    }
    solver.kind->destroy(solver.state);
    return ok;
}
