/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A network for the impacts of one scene: it sees all bodies and contacts at once, says where the impulses will end, and
   a few sweeps from there do the rest. A shock runs through a stack one contact a sweep; the network has seen where
   it goes.

   Asked only where the cached start is far off (impact_gap.h) and the step is like those that it learned from: the
   bomb of the same mass, and no input beyond those of the training. All other steps are momentum's (momentum.c). The gap
   that is left after the sweeps goes up and down with the error, on launches that the network never saw, too: so few
   sweeps do at first, and a step that they did not bring near goes on. Impulses act on both bodies alike, and the
   sweeps bring them into their cones, so momentum is kept whatever the network says. Source: a warm start by a network
   for the whole problem as in Sambharya, Hall, Amos, Stellato, "Learning to Warm-Start Fixed-Point Optimization
   Algorithms" (2024), which trains through the iterations that follow, too. Fails on other scenes, which have no slots;
   it says so. */
#include "solvers/scene_net.h"

#include "solvers/impact_gap.h"
#include "solvers/momentum.h"
#include "solvers/scene_answer.h"
#include "solvers/solvers.h"

#include <math.h>
#include <stdlib.h>

enum { REST_SWEEPS = 20, MORE_SWEEPS = 48, CALM_MORE = 24, LOOK_EVERY = 8 };

/* The gap from which on a step goes on after the network and its sweeps; and, of it, the share that is still too much
   where there was little to do from the start: there all bodies are to be right. */
static const float near_default = 0.02f; /* m/s, RMS over the contacts */
static const float calm_share = 0.15f;

/* What is done of a step: as the method momentum does, `rest` sweeps; where the bomb is there, of the training's mass, but
   the gap is below the gate, half as many, and up to CALM_MORE more while that is not near enough; the network, `after`
   sweeps, and up to MORE_SWEEPS more while that is not. */
typedef enum Way { BY_MOMENTUM, CALM, BY_NETWORK } Way;

/* What is pushed beyond it cannot be taken back: rounding alone would leave more than 1e-3 m/s. */
static const float speed_max = 1e4f; /* m/s and rad/s */

typedef struct SceneNet {
    SlotNetwork *own;           /* or NULL */
    const SlotNetwork *network; /* that one, or another's */
    Momentum momentum;
    SceneAnswer answer;
    float near;                           /* m/s */
    int after, rest, half;                /* sweeps with the network, and without */
    float after_factors[SLOT_SWEEPS_MAX]; /* [after] */
    bool after_plain;                     /* no factor of them does anything */
    float *rest_factors, *half_factors;   /* [rest], [half] */
    float more_factors[MORE_SWEEPS];      /* of those that a step goes on by */
} SceneNet;

static const SettingSpec settings[] = {
    {"network", "file of the trained network (the scene's own)"},
    {"after", "sweeps after the network (as it was trained for)"},
    {"near", "m/s that contacts may miss their aim by before more sweeps follow (0.02)"},
    {"rest", "sweeps with momentum where it is not asked (20; half where calm)"},
    {NULL, NULL}};

static void destroy(void *state) {
    SceneNet *solver = state;
    if (solver == NULL) return;
    slot_network_destroy(solver->own);
    momentum_free(&solver->momentum);
    scene_answer_free(&solver->answer);
    free(solver->rest_factors);
    free(solver->half_factors);
    free(solver);
}

/* Factors that were learned hold for as many sweeps as they were learned for. */
static void choose_factors(SceneNet *solver) {
    const SlotNetwork *network = solver->network;
    bool learned = false;
    for (int s = 1; s < network->sweeps; s++) learned |= network->factors[s] > 0;
    solver->after_plain = !learned;
    for (int s = 0; s < solver->after; s++)
        solver->after_factors[s] = solver->after == network->sweeps ? network->factors[s]
                                   : learned                        ? momentum_factor_by_hand(s, solver->after)
                                                                    : 0;
    for (int s = 0; s < solver->rest; s++) solver->rest_factors[s] = momentum_factor_by_hand(s, solver->rest);
    for (int s = 0; s < solver->half; s++) solver->half_factors[s] = momentum_factor_by_hand(s, solver->half);
    for (int s = 0; s < MORE_SWEEPS; s++) solver->more_factors[s] = momentum_factor_by_hand(s, MORE_SWEEPS);
}

static SceneNet *make(const SlotNetwork *network, int after, int rest, float near, Error *error) {
    SceneNet *solver = calloc(1, sizeof *solver);
    if (solver == NULL) {
        error_memory(error, "scene-net");
        return NULL;
    }
    solver->network = network;
    solver->after = after;
    solver->rest = rest;
    solver->near = near;
    solver->half = (rest + 1) / 2;
    solver->rest_factors = malloc((size_t)rest * sizeof *solver->rest_factors);
    solver->half_factors = malloc((size_t)solver->half * sizeof *solver->half_factors);
    if (solver->rest_factors == NULL || solver->half_factors == NULL) {
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
    int after = network->sweeps, rest = REST_SWEEPS;
    float near = near_default;
    SceneNet *solver = NULL;
    if (settings_int(chosen, "after", 0, SLOT_SWEEPS_MAX, &after, error) &&
        settings_int(chosen, "rest", 1, SWEEPS_MAX, &rest, error) &&
        settings_float(chosen, "near", 0, 1e6f, &near, error))
        solver = make(network, after, rest, near, error);
    if (solver == NULL)
        slot_network_destroy(network);
    else
        solver->own = network;
    return solver;
}

/* Before the bomb comes there is one body less. */
static bool fits(const SlotNetwork *network, const ContactProblem *problem, Error *error) {
    const int bodies = problem->bomb < 0 ? network->body_count - 1 : network->body_count;
    if (problem->body_count != bodies)
        return error_input(error, "scene-net", "the network is for the scene %s of %d bodies; this one has %d",
                           network->scene, bodies, problem->body_count);
    if (problem->bomb < 0 || problem->bomb == network->bomb) return true;
    return error_input(error, "scene-net", "the network is for the scene %s, where the bomb is body %d; here it is %d",
                       network->scene, network->bomb, problem->bomb);
}

static int within(float speed) { return fabsf(speed) <= speed_max; }

/* The bodies, and what an impulse by itself does to the lightest: pushes that cancel each other round as much. */
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
    return solver->after_plain ? sweeps_run(sweeps, solver->after)
                               : sweeps_run_momentum(sweeps, solver->after_factors, solver->after);
}

/* What is left tells how near a step is: sweeps go on while that is `near` or more, `most` in all. What is far off then is
   so in long waves, a heavy bomb on all boxes under it, and those take momentum that has had time to gather: one run,
   looked at now and then, and not many. */
static bool go_on(SceneNet *solver, const ContactProblem *problem, float near, int most) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    const float *factors = solver->more_factors;
    for (int done = 0; done < most && impact_gap_reaches(sweeps, problem->contact_count, near); done += LOOK_EVERY)
        if (!(done == 0 ? sweeps_run_momentum(sweeps, factors, LOOK_EVERY)
                        : sweeps_continue_momentum(sweeps, factors + done, LOOK_EVERY)))
            return false;
    return true;
}

static bool run(SceneNet *solver, const ContactProblem *problem, Way way) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    switch (way) {
    case CALM:
        return sweeps_run_momentum(sweeps, solver->half_factors, solver->half) &&
               go_on(solver, problem, calm_share * solver->near, CALM_MORE);
    case BY_NETWORK: return run_after(solver) && go_on(solver, problem, solver->near, MORE_SWEEPS);
    case BY_MOMENTUM: break;
    }
    return sweeps_run_momentum(sweeps, solver->rest_factors, solver->rest);
}

/* After the warm start. */
static bool choose_way(SceneNet *solver, const ContactProblem *problem, Way *way, NetworkFallbacks *fallbacks,
                       Error *error) {
    const SlotNetwork *network = solver->network;
    *way = BY_MOMENTUM;
    if (problem->bomb < 0) return true;
    bool known = problem->bodies[network->bomb].inv_mass == network->bomb_inv_mass;
    if (!impact_gap_reaches(&solver->momentum.sweeps, problem->contact_count, network->gate)) {
        if (known) *way = CALM;
        return true;
    }
    if (known && !scene_answer_knows(&solver->answer, network, problem, &known))
        return error_memory(error, "scene-net");
    if (known) *way = BY_NETWORK;
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
    Way way;
    solution->fallbacks = (NetworkFallbacks){0};
    if (!choose_way(solver, problem, &way, &solution->fallbacks, error)) return false;
    if (way == BY_NETWORK) {
        scene_answer_find(&solver->answer, solver->network, problem, &solution->fallbacks);
        sweeps_push(sweeps, solver->answer.change);
        if (!is_bounded(sweeps)) {
            solution->fallbacks.not_finite++;
            return solve_without(solver, problem, solution, error);
        }
    }
    if (!run(solver, problem, way)) return error_memory(error, "scene-net");
    if (sweeps_end(sweeps, solution)) return true;
    solution->fallbacks.not_finite += way == BY_NETWORK;
    return solve_without(solver, problem, solution, error);
}

const ContactSolverKind solver_scene_net = {
    .description = {.name = "scene-net",
                    .summary = "a network of the whole scene where the bomb strikes, then sweeps",
                    .settings = settings,
                    .title = "Network of the scene",
                    .needs_network = true,
                    .chart = METHOD_RUNS("", "near=3", "near=0.5", "near=0.1")},
    .create = create,
    .solve = solve,
    .destroy = destroy};

bool scene_net_make(ContactSolver *solver, const SlotNetwork *network, float near, Error *error) {
    solver->kind = &solver_scene_net;
    solver->state = make(network, network->sweeps, REST_SWEEPS, near, error);
    return solver->state != NULL;
}
