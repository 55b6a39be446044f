/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dataset/dataset_rows.h"

#include "common/array.h"
#include "reference/reference.h"
#include "simulate/simulate.h"
#include "sweeps/sequential_impulses.h"

#include <stdlib.h>

/* The launch being recorded. */
typedef struct LaunchRecorder {
    const Dataset *dataset; /* options of the recording */
    const Scene *scene;
    LaunchRows *launch;
    Reference reference;
    PairMoment labels; /* of the reference */
    PairMoment now;
} LaunchRecorder;

static bool reserve(PairMoment *moment, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    if (!pair_moment_reserve(moment, problem)) return error_memory(error, "dataset");
    *solution = pair_moment_solution(moment);
    return true;
}

/* The solution that the changes are computed from. */
static bool label(LaunchRecorder *recorder, const World *world, ContactSolution *solution, Error *error) {
    const ContactProblem *problem = world_problem(world);
    *solution = *world_solution(world);
    if (recorder->dataset->labels == DATASET_BY_ENGINE) return true;
    Reference *reference = &recorder->reference;
    if (!reference_solve(reference, problem, NULL, error)) return false;
    if (!reserve(&recorder->labels, problem, solution, error)) return false;
    for (int i = 0; i < problem->body_count; i++) {
        const ReferenceVelocity *v = &reference->velocities[i];
        solution->velocities[i] = (BodyVelocity){vec2((float)v->x, (float)v->y), (float)v->spin};
    }
    for (int i = 0; i < problem->contact_count; i++)
        solution->impulses[i] =
            (ContactImpulse){(float)reference->impulses[i].normal, (float)reference->impulses[i].tangent};
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
static void difference(float *changes, const BodyVelocity *to, const BodyVelocity *from) {
    changes[0] = to->linear.x - from->linear.x;
    changes[1] = to->linear.y - from->linear.y;
    changes[2] = to->angular - from->angular;
}

/* The state after the warm start, before the first sweep. */
static SequentialOptions sweeps_of(const Scene *scene) {
    return (SequentialOptions){.accumulate = scene->accumulate_impulses, .warm = true, .relaxation = 1};
}

static bool record_step(LaunchRecorder *recorder, int frame, const World *world, Error *error) {
    const Dataset *dataset = recorder->dataset;
    const ContactProblem *problem = world_problem(world);
    const SequentialOptions options = sweeps_of(recorder->scene);
    ContactSolution solution, begun;
    if (!label(recorder, world, &solution, error) || !reserve(&recorder->now, problem, &begun, error)) return false;
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
    if (!reserve(&recorder->now, problem, &now, error)) return false;
    sequential_impulses_begin(problem, &options, &now);
    for (int sweep = 0; sweep < recorder->scene->iterations; sweep++)
        for (int first = 0, count; first < problem->contact_count; first += count) {
            count = pair_contact_count(problem, first);
            PairRow *row = add_row(recorder, frame, problem, first, &recorder->now);
            if (row == NULL) return error_memory(error, "dataset");
            const BodyVelocity *a = &now.velocities[row->bodies[0]], *b = &now.velocities[row->bodies[1]];
            BodyVelocity before_a = *a, before_b = *b;
            sequential_impulses_visit(problem, &options, first, count, &now);
            difference(row->changes, a, &before_a);
            difference(row->changes + 3, b, &before_b);
            if (pair_views[recorder->dataset->view].by_contact)
                pair_to_contact_frame(&problem->contacts[first], row->changes);
        }
    return true;
}

static bool observe(void *context, int frame, const World *world, Error *error) {
    LaunchRecorder *recorder = context;
    return recorder->dataset->target == TARGET_IMPULSE ? record_visits(recorder, frame, world, error)
                                                       : record_step(recorder, frame, world, error);
}

bool dataset_record_rows(const Dataset *dataset, const Scene *launched, LaunchRows *rows, Error *error) {
    LaunchRecorder recorder = {.dataset = dataset, .scene = launched, .launch = rows};
    Method method;
    StepObserver observer = {observe, &recorder};
    bool ok = method_parse(&method, "engine", error) && simulate_observed(launched, &method, &observer, error);
    reference_free(&recorder.reference);
    pair_moment_free(&recorder.labels);
    pair_moment_free(&recorder.now);
    return ok;
}
