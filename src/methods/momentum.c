/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sequential impulses with momentum extrapolation between sweeps: before each sweep the impulses, and the velocities,
   which are linear in them, continue along their last change. With p[s] and v[s] after sweep s,

       p = p[s] + beta[s] (p[s] - p[s-1]),   v = v[s] + beta[s] (v[s] - v[s-1])

   is where sweep s + 1 begins; the sweep projects the impulses back into their cones. Source: Nesterov, "A Method of
   Solving a Convex Programming Problem with Convergence Rate O(1/k^2)" (1983); for contacts Mazhar, Heyn, Negrut,
   Tasora, "Using Nesterov's Method to Accelerate Multibody Dynamics with Friction and Contact" (2015), with full
   gradient steps in place of sweeps. Sweeps visit contacts in the order of colours: as accurate, and faster
   (tests/bench/colours). Fails while friction cones change from sweep to sweep: then the extrapolation is wrong, so the
   first sweeps of an impact gain little. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/solvers.h"
#include "methods/sweeps.h"

#include <math.h>
#include <stdlib.h>

/* Adds factor times the change since *before to *now. A factor or change of 0 must keep all bits: + 0 turns -0 into 0,
   and x - 0 is x even for x = -0. */
static void extrapolate(float *now, float *before, float factor) {
    float next = *now - (factor * (*before - *now) + 0.0f);
    *before = *now;
    *now = next;
}

static void extrapolate_all(const ContactProblem *problem, float factor, ContactSolution *before,
                            ContactSolution *now) {
    for (int i = 0; i < problem->body_count; i++) {
        extrapolate(&now->velocities[i].linear.x, &before->velocities[i].linear.x, factor);
        extrapolate(&now->velocities[i].linear.y, &before->velocities[i].linear.y, factor);
        extrapolate(&now->velocities[i].angular, &before->velocities[i].angular, factor);
    }
    for (int i = 0; i < problem->contact_count; i++) {
        extrapolate(&now->impulses[i].normal, &before->impulses[i].normal, factor);
        extrapolate(&now->impulses[i].tangent, &before->impulses[i].tangent, factor);
    }
}

static void begin_scalar(const ContactProblem *problem, const int32_t *visits, ContactSolution *solution) {
    static const SequentialOptions cold = {.accumulate = false};
    sequential_impulses_begin(problem, &cold, solution);
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[visits[i]];
        const ContactImpulse warm = {contact->warm_normal, contact->warm_tangent};
        solution->impulses[visits[i]] = warm;
        contact_push(solution->velocities, contact, problem->bodies, warm);
    }
}

void momentum_solve_scalar(const ContactProblem *problem, const int32_t *visits, const float *factors, int count,
                           ContactSolution *before, ContactSolution *solution) {
    static const SequentialOptions options = {.accumulate = true, .warm = true};
    begin_scalar(problem, visits, solution);
    begin_scalar(problem, visits, before);
    for (int sweep = 0; sweep < count; sweep++) {
        extrapolate_all(problem, factors[sweep], before, solution);
        for (int i = 0; i < problem->contact_count; i++)
            sequential_impulses_visit(problem, &options, visits[i], 1, solution);
    }
}

float momentum_factor_tuned(int sweep, int count) {
    float rising = (float)sweep / ((float)sweep + 1.4f), most = 1.0f - 7.0f / (15.0f + (float)count);
    return rising < most ? rising : most;
}

float *momentum_factors_make(int count) {
    float *factors = malloc((size_t)count * sizeof *factors);
    for (int s = 0; factors != NULL && s < count; s++) factors[s] = momentum_factor_tuned(s, count);
    return factors;
}

void momentum_free(Momentum *momentum) {
    sweeps_free(&momentum->sweeps);
    free(momentum->arrays.memory);
    free(momentum->more_factors);
    *momentum = (Momentum){0};
}

/* Momentum makes the residual rise and fall. It begins again at this multiple of the least sum of squares. */
static const float overshoot = 4;

bool momentum_run_more(Sweeps *sweeps, const ContactProblem *problem, const StoppingRule *rule, const float *factors) {
    float least = HUGE_VALF;
    for (int done = 0, rising = 0; stopping_needs_more(rule, done, sweeps, problem); done += STOPPING_BLOCK) {
        const float left = residual_of_sweeps(sweeps);
        if (left > overshoot * least) rising = 0, least = left;
        if (left < least) least = left;
        if (!(rising == 0 ? sweeps_run_momentum(sweeps, factors, STOPPING_BLOCK)
                          : sweeps_continue_momentum(sweeps, factors + rising, STOPPING_BLOCK)))
            return false;
        rising += STOPPING_BLOCK;
    }
    return true;
}

bool momentum_solve(Momentum *momentum, const ContactProblem *problem, const float *factors, int count,
                    ContactSolution *solution, Error *error) {
    if (!sweeps_begin_coloured(&momentum->sweeps, sweeps_best_kernel(), problem) ||
        !sweeps_run_momentum(&momentum->sweeps, factors, count) ||
        !momentum_run_more(&momentum->sweeps, problem, &momentum->rule, momentum->more_factors))
        return error_memory(error, "momentum");
    if (sweeps_end(&momentum->sweeps, solution)) return true;
    ContactSolution *before = &momentum->before;
    if (!ARRAY_BLOCK_RESERVE(&momentum->arrays, ARRAY_PART(before->velocities, problem->body_count),
                             ARRAY_PART(before->impulses, problem->contact_count)))
        return error_memory(error, "momentum");
    momentum_solve_scalar(problem, momentum->sweeps.colours.visits, factors, count, before, solution);
    return true;
}

typedef struct State {
    StoppingRule rule;
    Momentum momentum;
    float *factors; /* [rule.k] */
} State;

static const SettingSpec settings[] = {SWEEPS_SETTING, STOPPING_SETTINGS("sweeps"), KEEP_SETTING(SETTING_OWN), {0}};

static void destroy(void *state) {
    State *solver = state;
    if (solver == NULL) return;
    momentum_free(&solver->momentum);
    free(solver->factors);
    free(solver);
}

static void *create(const Settings *chosen, Error *error) {
    static const State standard = {.rule.k = 10};
    State *solver = stopping_make(chosen, settings, &standard, sizeof standard, "momentum", error);
    if (solver == NULL) return NULL;
    solver->factors = momentum_factors_make(solver->rule.k);
    solver->momentum.rule = solver->rule;
    if (solver->rule.more > 0) solver->momentum.more_factors = momentum_factors_make(solver->rule.more);
    if (solver->factors != NULL && (solver->rule.more == 0 || solver->momentum.more_factors != NULL)) return solver;
    destroy(solver);
    error_memory(error, "momentum");
    return NULL;
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    State *solver = state;
    return momentum_solve(&solver->momentum, problem, solver->factors, solver->rule.k, solution, error);
}

const ContactSolverKind solver_momentum = {
    .description = {.name = "momentum",
                    .summary = "sequential impulses with momentum extrapolation between sweeps",
                    .caption = "sequential impulses with momentum",
                    .settings = settings,
                    .chart = METHOD_RUNS("k=5", "k=20", "k=50", "k=100", "k=1,near=0.005,more=10000",
                                         "k=1,near=0.0002,more=10000", "k=5,near=0.5,more=10000",
                                         "k=5,near=0.1,more=10000", "k=5,near=0.02,more=10000",
                                         "k=5,near=0.005,more=10000", "k=5,near=0.0002,more=10000"),
                    .chart_quick = METHOD_RUNS("k=10", "k=20", "k=5,near=0.1,more=10000"),
                    .stability = METHOD_RUNS("", "k=20"),
                    .stability_place = 3},
    .create = create,
    .solve = solve,
    .destroy = destroy};
