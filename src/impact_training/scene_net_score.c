/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact_training/scene_net_score.h"

#include "impact_training/slot_fit.h"
#include "reference/solution_error.h"
#include "solvers/momentum.h"

#include <math.h>
#include <stdlib.h>

enum { MOMENTUM_SWEEPS = 20 };

/* Mean error of the network and its sweeps. */
static bool network_error(const SlotNetwork *network, const SlotSamples *samples, double *result, Error *error) {
    double *errors = malloc(((size_t)samples->count + 1) * sizeof *errors), sum = 0;
    bool ok = errors != NULL || error_memory(error, "scene-net");
    ok = ok && slot_errors(network, samples, 0, errors, error);
    for (int i = 0; ok && i < samples->count; i++) sum += errors[i];
    *result = samples->count > 0 ? sum / samples->count : NAN;
    free(errors);
    return ok;
}

/* Mean error of momentum with warm start. */
static bool momentum_error(const SlotSamples *samples, double *result, Error *error) {
    float factors[MOMENTUM_SWEEPS];
    for (int s = 0; s < MOMENTUM_SWEEPS; s++) factors[s] = momentum_factor_tuned(s, MOMENTUM_SWEEPS);
    Momentum momentum = {0};
    double sum = 0;
    bool ok = true;
    for (int i = 0; ok && i < samples->count; i++) {
        const ContactProblem *problem = &samples->items[i].problem;
        ContactSolution solution = {
            .velocities = malloc(((size_t)problem->body_count + 1) * sizeof *solution.velocities),
            .impulses = malloc(((size_t)problem->contact_count + 1) * sizeof *solution.impulses)};
        ok = (solution.velocities != NULL && solution.impulses != NULL) || error_memory(error, "scene-net");
        ok = ok && momentum_solve(&momentum, problem, factors, MOMENTUM_SWEEPS, &solution, error);
        if (ok) sum += solution_error(problem, solution.velocities, samples->items[i].reference).rms;
        free(solution.velocities);
        free(solution.impulses);
    }
    momentum_free(&momentum);
    *result = samples->count > 0 ? sum / samples->count : NAN;
    return ok;
}

bool scene_net_score(const SlotNetwork *network, const SlotSamples *samples, const SlotSamples *held_out,
                     SceneNetScore *score, Error *error) {
    score->samples = samples->count;
    return network_error(network, samples, &score->train, error) &&
           network_error(network, held_out, &score->held_out, error) &&
           momentum_error(held_out, &score->momentum, error);
}
