/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dataset/dataset_rows.h"

#include "common/array.h"
#include "simulate/simulate.h"
#include "solvers/reference.h"
#include "solvers/sequential_impulses.h"

#include <stdlib.h>

/* The launch that is being recorded. */
typedef struct LaunchRecorder {
    const Dataset *dataset; /* what is to be recorded */
    const Scene *scene;
    LaunchRows *launch;
    Reference reference;
    BodyVelocity *velocities;
    ContactImpulse *impulses;
    size_t velocity_capacity, impulse_capacity;
} LaunchRecorder;

static bool reserve(LaunchRecorder *recorder, const ContactProblem *problem) {
    return array_reserve((void **)&recorder->velocities, &recorder->velocity_capacity, (size_t)problem->body_count,
                         sizeof *recorder->velocities) &&
           array_reserve((void **)&recorder->impulses, &recorder->impulse_capacity, (size_t)problem->contact_count + 1,
                         sizeof *recorder->impulses);
}

/* The solution of the step's problem that the changes are taken from. */
static bool label(LaunchRecorder *recorder, const World *world, ContactSolution *solution, Error *error) {
    const ContactProblem *problem = world_problem(world);
    *solution = *world_solution(world);
    if (recorder->dataset->labels == DATASET_BY_ENGINE) return true;
    Reference *reference = &recorder->reference;
    if (!reference_solve(reference, problem, REFERENCE_TOLERANCE, REFERENCE_MAX_VISITS, NULL, error)) return false;
    if (!reserve(recorder, problem)) return error_memory(error, "dataset");
    for (int i = 0; i < problem->body_count; i++) {
        const ReferenceVelocity *v = &reference->velocities[i];
        recorder->velocities[i] = (BodyVelocity){vec2((float)v->x, (float)v->y), (float)v->spin};
    }
    for (int i = 0; i < problem->contact_count; i++)
        recorder->impulses[i] =
            (ContactImpulse){(float)reference->impulses[i].normal, (float)reference->impulses[i].tangent};
    *solution = (ContactSolution){recorder->velocities, recorder->impulses};
    return true;
}

/* A new row of a pair with its inputs; velocities: NULL, or those it has now. NULL when memory is short. */
static PairRow *add_row(LaunchRecorder *recorder, int frame, const ContactProblem *problem, int first,
                        const BodyVelocity *velocities) {
    LaunchRows *launch = recorder->launch;
    if (!array_reserve((void **)&launch->rows, &launch->capacity, launch->count + 1, sizeof *launch->rows)) return NULL;
    PairRow *row = &launch->rows[launch->count++];
    row->frame = frame;
    row->bodies[0] = problem->contacts[first].a;
    row->bodies[1] = problem->contacts[first].b;
    pair_inputs(problem, velocities, row->bodies[0], row->bodies[1], recorder->dataset->view, row->inputs);
    return row;
}

/* changes[3]: from one velocity to another. */
static void difference(float *changes, const BodyVelocity *to, const BodyVelocity *from) {
    changes[0] = to->linear.x - from->linear.x;
    changes[1] = to->linear.y - from->linear.y;
    changes[2] = to->angular - from->angular;
}

static void net_change(float *changes, const ContactProblem *problem, const ContactSolution *solution, int body) {
    const ProblemBody *before = &problem->bodies[body];
    const BodyVelocity free = {before->velocity, before->angular_velocity};
    difference(changes, &solution->velocities[body], &free);
}

static bool record_step(LaunchRecorder *recorder, int frame, const World *world, Error *error) {
    const ContactProblem *problem = world_problem(world);
    ContactSolution solution;
    if (!label(recorder, world, &solution, error)) return false;
    for (int first = 0, count; first < problem->contact_count; first += count) {
        count = pair_contact_count(problem, first);
        PairRow *row = add_row(recorder, frame, problem, first, NULL);
        if (row == NULL) return error_memory(error, "dataset");
        if (recorder->dataset->target == DATASET_PAIR) {
            pair_changes(problem, &solution, first, count, row->changes);
        } else {
            net_change(row->changes, problem, &solution, row->bodies[0]);
            net_change(row->changes + 3, problem, &solution, row->bodies[1]);
        }
    }
    return true;
}

/* The engine's sweeps once more, in plain text, pair by pair. */
static bool record_visits(LaunchRecorder *recorder, int frame, const World *world, Error *error) {
    const ContactProblem *problem = world_problem(world);
    const SequentialOptions options = {
        .accumulate = recorder->scene->accumulate_impulses, .warm = true, .relaxation = 1};
    if (!reserve(recorder, problem)) return error_memory(error, "dataset");
    ContactSolution solution = {recorder->velocities, recorder->impulses};
    sequential_impulses_begin(problem, &options, &solution);
    for (int sweep = 0; sweep < recorder->scene->iterations; sweep++)
        for (int first = 0, count; first < problem->contact_count; first += count) {
            count = pair_contact_count(problem, first);
            PairRow *row = add_row(recorder, frame, problem, first, solution.velocities);
            if (row == NULL) return error_memory(error, "dataset");
            const BodyVelocity *a = &solution.velocities[row->bodies[0]], *b = &solution.velocities[row->bodies[1]];
            BodyVelocity before_a = *a, before_b = *b;
            sequential_impulses_visit(problem, &options, first, count, &solution);
            difference(row->changes, a, &before_a);
            difference(row->changes + 3, b, &before_b);
        }
    return true;
}

static bool observe(void *context, int frame, const World *world, Error *error) {
    LaunchRecorder *recorder = context;
    return recorder->dataset->target == DATASET_IMPULSE ? record_visits(recorder, frame, world, error)
                                                        : record_step(recorder, frame, world, error);
}

bool dataset_record_rows(const Dataset *dataset, const Scene *launched, LaunchRows *rows, Error *error) {
    LaunchRecorder recorder = {.dataset = dataset, .scene = launched, .launch = rows};
    Method method;
    StepObserver observer = {observe, &recorder};
    bool ok = method_parse(&method, "engine", error) && simulate_observed(launched, &method, &observer, error);
    reference_free(&recorder.reference);
    free(recorder.velocities);
    free(recorder.impulses);
    return ok;
}
