/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A network for the impacts of one scene. It sees all bodies and contacts at once and predicts where the impulses will
   end; a few sweeps then correct the prediction. Sweeps alone carry a shock through a stack one contact per sweep.

   The network is used only if the residual of the warm start (residual.h) reaches the gate and the step resembles the
   training data: the same mass of the bomb, and all inputs within their range. All other steps are solved as by
   momentum (momentum.c). The residual after the sweeps correlates with the error, also on held-out launches: so few
   sweeps follow at first, and more if the residual is still large. Impulses act on both bodies alike and sweeps clamp
   them to their cones, so momentum is conserved whatever the network predicts. Source: a warm start by a network for
   the whole problem, as in Sambharya, Hall, Amos, Stellato, "Learning to Warm-Start Fixed-Point Optimization
   Algorithms" (2024), which also trains through the iterations that follow. Fails on other scenes, which have other
   slots; it refuses them. */
#include "solvers/scene_net.h"

#include "solvers/momentum.h"
#include "solvers/residual.h"
#include "solvers/scene_prediction.h"
#include "solvers/solvers.h"

#include <math.h>
#include <stdlib.h>

enum { REST_SWEEPS = 20, CALM_MORE = 24 };

/* More sweeps follow the network while the residual is this large; for a calm step, while it is this share of it. */
static const float near_default = 0.02f; /* m/s, RMS over the contacts */
static const float calm_share = 0.15f;

/* How a step is solved. */
typedef enum Route {
    ROUTE_MOMENTUM, /* `rest` sweeps with momentum */
    ROUTE_CALM,   /* the bomb is there, with the mass of the training, but the residual is below the gate: half as many
                       sweeps, and up to CALM_MORE more while the residual is too large */
    ROUTE_NETWORK /* the network, `after` sweeps, and more while the residual is too large */
} Route;

/* Sweeps cannot correct velocities beyond this: rounding alone would leave errors above 1e-3 m/s. */
static const float speed_max = 1e4f; /* m/s and rad/s */

typedef struct SceneNet {
    SlotNetwork *own;           /* or NULL */
    const SlotNetwork *network; /* the same, or the caller's */
    Momentum momentum;
    ScenePrediction prediction;
    bool predicts;                        /* false: the network is not evaluated */
    int after, rest, half;                /* sweeps after the network, and without it */
    StoppingRule rule;                    /* after the network; after calm steps a share of it */
    float after_factors[SLOT_SWEEPS_MAX]; /* [after] */
    bool after_without_momentum;          /* all of them are 0 */
    float *rest_factors, *half_factors;   /* [rest], [half] */
    float *more_factors;                  /* [rule.more] of the sweeps that follow if the residual is too large */
} SceneNet;

/* What settings choose. */
typedef struct SceneNetChoice {
    int after, rest;
    bool predicts;
    StoppingRule rule;
} SceneNetChoice;

static const SettingSpec settings[] = {
    {"network", "file of the trained network (default: the scene's)"},
    {"after", "sweeps after the network (default: as in its training)"},
    {"near", "residual, m/s: after those, blocks of 8 follow while it is at least this (default: 0.02)"},
    {"more", "sweeps that may follow, rounded up to whole blocks (default: 48)"},
    {"rest", "sweeps with momentum in steps without the network (default: 20; half in calm steps)"},
    {"net", "on|off: off leaves out all that is learned, the prediction and the factors (default: on)"},
    {NULL, NULL}};

static void destroy(void *state) {
    SceneNet *solver = state;
    if (solver == NULL) return;
    slot_network_destroy(solver->own);
    momentum_free(&solver->momentum);
    scene_prediction_free(&solver->prediction);
    free(solver->rest_factors);
    free(solver->half_factors);
    free(solver->more_factors);
    free(solver);
}

/* Learned factors are valid only for the number of sweeps they were learned for. */
static void choose_factors(SceneNet *solver) {
    const SlotNetwork *network = solver->network;
    bool learned = false;
    for (int s = 1; s < network->sweeps; s++) learned |= network->factors[s] > 0;
    learned |= !solver->predicts;
    solver->after_without_momentum = !learned;
    for (int s = 0; s < solver->after; s++)
        solver->after_factors[s] = solver->after == network->sweeps && solver->predicts ? network->factors[s]
                                   : learned ? momentum_factor_tuned(s, solver->after)
                                             : 0;
}

static SceneNet *make(const SlotNetwork *network, const SceneNetChoice *choice, Error *error) {
    SceneNet *solver = calloc(1, sizeof *solver);
    if (solver == NULL) {
        error_memory(error, "scene-net");
        return NULL;
    }
    solver->network = network;
    solver->predicts = choice->predicts;
    solver->after = choice->after;
    solver->rest = choice->rest;
    solver->rule = choice->rule;
    solver->half = (choice->rest + 1) / 2;
    solver->rest_factors = momentum_factors_make(solver->rest);
    solver->half_factors = momentum_factors_make(solver->half);
    solver->more_factors = momentum_factors_make(solver->rule.more);
    if (solver->rest_factors == NULL || solver->half_factors == NULL || solver->more_factors == NULL) {
        destroy(solver);
        error_memory(error, "scene-net");
        return NULL;
    }
    choose_factors(solver);
    return solver;
}

static void *create(const Settings *chosen, Error *error) {
    const char *path = settings_get(chosen, "network");
    if (path == NULL) {
        error_input(error, "scene-net", "the scene names no network for it: use scene-net:network=FILE");
        return NULL;
    }
    SlotNetwork *network = slot_network_read(path, error);
    if (network == NULL) return NULL;
    SceneNetChoice choice = {network->sweeps, REST_SWEEPS, true, {near_default, STOPPING_MORE}};
    SceneNet *solver = NULL;
    if (settings_int(chosen, "after", 0, SLOT_SWEEPS_MAX, &choice.after, error) &&
        settings_int(chosen, "rest", 1, SWEEPS_MAX, &choice.rest, error) &&
        settings_bool(chosen, "net", &choice.predicts, error) && stopping_read(&choice.rule, chosen, error))
        solver = make(network, &choice, error);
    if (solver == NULL)
        slot_network_destroy(network);
    else
        solver->own = network;
    return solver;
}

/* Before the bomb appears there is one body less. */
static bool fits(const SlotNetwork *network, const ContactProblem *problem, Error *error) {
    const int bodies = problem->marked < 0 ? network->body_count - 1 : network->body_count;
    if (problem->body_count != bodies)
        return error_input(error, "scene-net", "the network is for the scene %s of %d bodies; this one has %d",
                           network->scene, bodies, problem->body_count);
    if (problem->marked < 0 || problem->marked == network->bomb) return true;
    return error_input(error, "scene-net",
                       "the network is for the scene %s, with the bomb as body %d; here it is body %d", network->scene,
                       network->bomb, problem->marked);
}

static int within(float speed) { return fabsf(speed) <= speed_max; }

/* Checks velocities, and the effect of each impulse on the lightest body: large impulses that cancel each other leave
   rounding errors, too. */
static bool is_bounded(const Sweeps *sweeps) {
    int bounded = 1;
    float inverse = 0; /* 1/kg, of the lightest */
    for (int i = 0; i < sweeps->body_count; i++) {
        const SweepBody *body = &sweeps->bodies[i];
        bounded &= within(body->x) & within(body->y) & within(body->spin);
        inverse = body->inv_mass > inverse ? body->inv_mass : inverse;
    }
    for (int i = 0; i < sweeps->pair_count; i++) {
        const ContactImpulse *sums = sweeps->pairs[i].sums;
        for (int k = 0; k < 2; k++) bounded &= within(inverse * sums[k].normal) & within(inverse * sums[k].tangent);
    }
    return bounded != 0;
}

static bool run_after(SceneNet *solver) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    return solver->after_without_momentum ? sweeps_run(sweeps, solver->after)
                                          : sweeps_run_momentum(sweeps, solver->after_factors, solver->after);
}

static bool run_more(SceneNet *solver, const ContactProblem *problem, const StoppingRule *rule) {
    return momentum_run_more(&solver->momentum.sweeps, problem, rule, solver->more_factors);
}

static bool run(SceneNet *solver, const ContactProblem *problem, Route route) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    const StoppingRule *rule = &solver->rule;
    const StoppingRule calm = {calm_share * rule->near, rule->more < CALM_MORE ? rule->more : CALM_MORE};
    switch (route) {
    case ROUTE_CALM:
        return sweeps_run_momentum(sweeps, solver->half_factors, solver->half) && run_more(solver, problem, &calm);
    case ROUTE_NETWORK: return run_after(solver) && run_more(solver, problem, rule);
    case ROUTE_MOMENTUM: break;
    }
    return sweeps_run_momentum(sweeps, solver->rest_factors, solver->rest);
}

/* After the warm start. */
static bool choose_route(SceneNet *solver, const ContactProblem *problem, Route *route, NetworkFallbacks *fallbacks,
                         Error *error) {
    const SlotNetwork *network = solver->network;
    *route = ROUTE_MOMENTUM;
    if (problem->marked < 0) return true;
    bool known = problem->bodies[network->bomb].inv_mass == network->bomb_inv_mass;
    if (!residual_reaches(&solver->momentum.sweeps, problem->contact_count, network->gate)) {
        if (known) *route = ROUTE_CALM;
        return true;
    }
    if (known && !scene_prediction_in_range(&solver->prediction, network, problem, &known))
        return error_memory(error, "scene-net");
    if (known) *route = ROUTE_NETWORK;
    fallbacks->beyond_training += !known;
    return true;
}

static bool solve_without(SceneNet *solver, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    return momentum_solve(&solver->momentum, problem, solver->rest_factors, solver->rest, solution, error);
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    SceneNet *solver = state;
    Sweeps *sweeps = &solver->momentum.sweeps;
    if (!fits(solver->network, problem, error)) return false;
    if (!sweeps_begin_coloured(sweeps, sweeps_best_kernel(), problem)) return error_memory(error, "scene-net");
    Route route;
    solution->fallbacks = (NetworkFallbacks){0};
    if (!choose_route(solver, problem, &route, &solution->fallbacks, error)) return false;
    if (route == ROUTE_NETWORK && solver->predicts) {
        scene_prediction_make(&solver->prediction, solver->network, problem, &solution->fallbacks);
        sweeps_push(sweeps, solver->prediction.change);
        if (!is_bounded(sweeps)) {
            solution->fallbacks.not_finite++;
            return solve_without(solver, problem, solution, error);
        }
    }
    if (!run(solver, problem, route)) return error_memory(error, "scene-net");
    if (sweeps_end(sweeps, solution)) return true;
    solution->fallbacks.not_finite += route == ROUTE_NETWORK && solver->predicts;
    return solve_without(solver, problem, solution, error);
}

const ContactSolverKind solver_scene_net = {
    .description = {.name = "scene-net",
                    .summary = "a network predicts all impulses of a scene at impacts; sweeps follow",
                    .caption = "neural network for a scene",
                    .look = {METHOD_SKY, METHOD_DIAMOND},
                    .settings = settings,
                    .needs_network = true,
                    .twin = "scene-net:net=off",
                    .chart = METHOD_RUNS("", "near=3", "more=200", "net=off", "more=200,net=off"),
                    .chart_quick = METHOD_RUNS("", "net=off"),
                    .stability = METHOD_RUNS("", "net=off")},
    .create = create,
    .solve = solve,
    .destroy = destroy};

bool scene_net_make(ContactSolver *solver, const SlotNetwork *network, float near, Error *error) {
    solver->kind = &solver_scene_net;
    const SceneNetChoice choice = {network->sweeps, REST_SWEEPS, true, {near, STOPPING_MORE}};
    solver->state = make(network, &choice, error);
    return solver->state != NULL;
}
