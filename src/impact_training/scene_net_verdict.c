/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact_training/scene_net_verdict.h"

#include "common/clock.h"
#include "reference/solution_error.h"
#include "solvers/scene_net.h"
#include "solvers/solvers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Sweeps of the timed rivals, between which time is linear; most sweeps; turns of all rivals. */
enum { FEW_SWEEPS = 10, MANY_SWEEPS = 60, MOST_SWEEPS = 200, PASSES = 7 };

/* No sweeps follow by the stopping rule. */
static const float never = 1e9f; /* m/s */

/* Space for a solution of any sample. */
static bool make_solution(ContactSolution *solution, const SlotSamples *samples, Error *error) {
    size_t bodies = 1, contacts = 1;
    for (int i = 0; i < samples->count; i++) {
        const ContactProblem *problem = &samples->items[i].problem;
        if ((size_t)problem->body_count > bodies) bodies = (size_t)problem->body_count;
        if ((size_t)problem->contact_count > contacts) contacts = (size_t)problem->contact_count;
    }
    *solution = (ContactSolution){.velocities = calloc(bodies, sizeof *solution->velocities),
                                  .impulses = calloc(contacts, sizeof *solution->impulses)};
    return (solution->velocities != NULL && solution->impulses != NULL) || error_memory(error, "scene-net");
}

/* Solves all samples. s: the time of the solver alone, if shorter than before. m/s: the mean error. */
static bool solve_all(ContactSolver *solver, const SlotSamples *samples, ContactSolution *solution, double *seconds,
                      double *mean, Error *error) {
    double sum = 0, passed = 0;
    for (int i = 0; i < samples->count; i++) {
        const SlotSample *sample = &samples->items[i];
        const double begin = clock_seconds();
        if (!solver->kind->solve(solver->state, &sample->problem, solution, error)) return false;
        passed += clock_seconds() - begin;
        sum += solution_error(&sample->problem, solution->velocities, sample->reference).rms;
    }
    if (passed < *seconds) *seconds = passed;
    *mean = sum / samples->count;
    return true;
}

static bool make_momentum(ContactSolver *solver, int sweeps, Error *error) {
    char text[16];
    Settings settings;
    snprintf(text, sizeof text, "k=%d", sweeps);
    const MethodDescription *description = &solver_momentum.description;
    if (!settings_parse(&settings, text, description->settings, description->name, error)) return false;
    *solver = (ContactSolver){&solver_momentum, solver_momentum.create(&settings, error)};
    return solver->state != NULL;
}

static void destroy(ContactSolver *solver) {
    if (solver->state != NULL) solver->kind->destroy(solver->state);
}

static bool momentum_error(const SlotSamples *samples, int sweeps, ContactSolution *solution, double *mean,
                           Error *error) {
    ContactSolver solver = {.state = NULL};
    double unused = INFINITY;
    const bool ok =
        make_momentum(&solver, sweeps, error) && solve_all(&solver, samples, solution, &unused, mean, error);
    destroy(&solver);
    return ok;
}

/* The number of sweeps whose time is nearest. */
static int sweeps_of(double seconds, double few, double many) {
    const double sweep = (many - few) / (MANY_SWEEPS - FEW_SWEEPS);
    const double sweeps = sweep > 0 ? round(FEW_SWEEPS + (seconds - few) / sweep) : MOST_SWEEPS;
    return (int)fmin(fmax(sweeps, 1), MOST_SWEEPS);
}

static bool measure(ContactSolver rivals[3], const SlotSamples *samples, ContactSolution *solution,
                    SceneNetVerdict *verdict, Error *error) {
    double seconds[3] = {INFINITY, INFINITY, INFINITY}, mean[3];
    for (int pass = 0; pass < PASSES; pass++)
        for (int i = 0; i < 3; i++)
            if (!solve_all(&rivals[i], samples, solution, &seconds[i], &mean[i], error)) return false;
    verdict->samples = samples->count;
    verdict->network = mean[0];
    verdict->microseconds = 1e6 * seconds[0] / samples->count;
    verdict->sweeps = sweeps_of(seconds[0], seconds[1], seconds[2]);
    return momentum_error(samples, verdict->sweeps, solution, &verdict->at_equal_time, error) &&
           momentum_error(samples, 20, solution, &verdict->at_20, error);
}

bool scene_net_verdict(const SlotNetwork *network, const SlotSamples *held_out, SceneNetVerdict *verdict,
                       Error *error) {
    ContactSolver rivals[3] = {{.state = NULL}, {.state = NULL}, {.state = NULL}};
    ContactSolution solution = {.velocities = NULL};
    *verdict = (SceneNetVerdict){.samples = 0};
    bool ok = held_out->count == 0 ||
              (make_solution(&solution, held_out, error) && scene_net_make(&rivals[0], network, never, error) &&
               make_momentum(&rivals[1], FEW_SWEEPS, error) && make_momentum(&rivals[2], MANY_SWEEPS, error) &&
               measure(rivals, held_out, &solution, verdict, error));
    for (int i = 0; i < 3; i++) destroy(&rivals[i]);
    free(solution.velocities);
    free(solution.impulses);
    return ok;
}
