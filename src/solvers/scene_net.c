/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A network for the impacts of one scene: it sees all bodies and contacts at once, says where the impulses will end, and
   a few sweeps from there do the rest. A shock runs through a stack one contact a sweep; the network has seen where
   it goes.

   Asked only where the cached start is far off (impact_gap.h) and the step is like those that it learned from: the
   bomb of the same mass, and no input beyond those of the training. All other steps are momentum's (momentum.c), and so
   is what is left of a step that the network did not bring near. Impulses act on both bodies alike, and the sweeps bring
   them into their cones, so momentum is kept whatever the network says. Source: a warm start by a network for the whole
   problem as in Sambharya, Hall, Amos, Stellato, "Learning to Warm-Start Fixed-Point Optimization Algorithms" (2024),
   which trains through the iterations that follow, too. Fails on other scenes, which have no slots; it says so. */
#include "solvers/scene_net.h"

#include "common/array.h"
#include "solvers/contact_velocity.h"
#include "solvers/impact_gap.h"
#include "solvers/momentum.h"
#include "solvers/scene_view.h"
#include "solvers/solvers.h"

#include <math.h>
#include <stdlib.h>

enum { REST_SWEEPS = 20 };

/* What is pushed beyond it cannot be taken back: rounding alone would leave more than 1e-3 m/s. */
static const float speed_max = 1e4f; /* m/s and rad/s */

typedef struct SceneNet {
    SlotNetwork *own;           /* or NULL */
    const SlotNetwork *network; /* that one, or another's */
    Momentum momentum;
    SceneView view;
    float inputs[4 * SLOT_WIDTH_MAX], first[SLOT_WIDTH_MAX], second[SLOT_WIDTH_MAX];
    float *outputs;         /* [2 slots there are] */
    ContactImpulse *change; /* [contact_count] from the warm start to the network's */
    size_t output_capacity, change_capacity;
    int after, rest;                      /* sweeps with the network, and without */
    float after_factors[SLOT_SWEEPS_MAX]; /* [after] */
    bool after_plain;                     /* no factor of them does anything */
    float *rest_factors;                  /* [rest] */
} SceneNet;

static const SettingSpec settings[] = {{"network", "file of the trained network (the scene's own)"},
                                       {"after", "sweeps after the network (as it was trained for)"},
                                       {"rest", "sweeps with momentum where it is not asked (20)"},
                                       {NULL, NULL}};

static void destroy(void *state) {
    SceneNet *solver = state;
    if (solver == NULL) return;
    slot_network_destroy(solver->own);
    momentum_free(&solver->momentum);
    scene_view_free(&solver->view);
    free(solver->outputs);
    free(solver->change);
    free(solver->rest_factors);
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
}

static SceneNet *make(const SlotNetwork *network, int after, int rest, Error *error) {
    SceneNet *solver = calloc(1, sizeof *solver);
    float *rest_factors = malloc((size_t)rest * sizeof *rest_factors);
    if (solver == NULL || rest_factors == NULL) {
        free(solver);
        free(rest_factors);
        error_memory(error, "scene-net");
        return NULL;
    }
    solver->network = network;
    solver->after = after;
    solver->rest = rest;
    solver->rest_factors = rest_factors;
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
    SceneNet *solver = NULL;
    if (settings_int(chosen, "after", 0, SLOT_SWEEPS_MAX, &after, error) &&
        settings_int(chosen, "rest", 1, SWEEPS_MAX, &rest, error))
        solver = make(network, after, rest, error);
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

/* Whether a step is like those of the training; where it is, the view and inputs are there. False with error set where
   memory is short. */
static bool is_known(SceneNet *solver, const ContactProblem *problem, bool *known, Error *error) {
    const SlotNetwork *network = solver->network;
    *known = false;
    if (problem->bodies[network->bomb].inv_mass != network->bomb_inv_mass) return true;
    if (!scene_view_take(&solver->view, network, problem) ||
        !array_reserve((void **)&solver->outputs, &solver->output_capacity, 2 * (size_t)problem->contact_count,
                       sizeof *solver->outputs) ||
        !array_reserve((void **)&solver->change, &solver->change_capacity, (size_t)problem->contact_count,
                       sizeof *solver->change))
        return error_memory(error, "scene-net");
    slot_network_look(network, &solver->view.slots, solver->inputs);
    for (int i = 0; i < slot_network_inputs(network); i++)
        if (!(solver->inputs[i] >= network->low[i] && solver->inputs[i] <= network->high[i])) return true;
    *known = true;
    return true;
}

/* From the warm start to what the network says, inside the cone. */
static void find_change(SceneNet *solver, const ContactProblem *problem, NetworkFallbacks *fallbacks) {
    const SceneView *view = &solver->view;
    slot_network_predict(solver->network, solver->inputs, &view->slots, solver->first, solver->second, solver->outputs);
    for (int i = 0; i < problem->contact_count; i++) solver->change[i] = view->base[i];
    for (int k = 0; k < view->slots.slot_count; k++) {
        ContactImpulse *to = &solver->change[view->contacts[k]];
        const float limit = problem->contacts[view->contacts[k]].friction;
        to->normal += solver->outputs[2 * k];
        to->tangent += solver->outputs[2 * k + 1];
        const ContactImpulse said = *to;
        to->normal = to->normal > 0 ? to->normal : 0;
        to->tangent = contact_clamp(to->tangent, -limit * to->normal, limit * to->normal);
        fallbacks->outside_cone += said.normal != to->normal || said.tangent != to->tangent;
    }
    for (int i = 0; i < problem->contact_count; i++) {
        solver->change[i].normal -= problem->contacts[i].warm_normal;
        solver->change[i].tangent -= problem->contacts[i].warm_tangent;
    }
}

static bool is_bounded(const Sweeps *sweeps) {
    bool bounded = true;
    for (int i = 0; i < sweeps->body_count; i++) {
        const SweepBody *body = &sweeps->bodies[i];
        bounded &= fabsf(body->x) <= speed_max && fabsf(body->y) <= speed_max && fabsf(body->spin) <= speed_max;
    }
    return bounded;
}

static bool run_after(SceneNet *solver) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    return solver->after_plain ? sweeps_run(sweeps, solver->after)
                               : sweeps_run_momentum(sweeps, solver->after_factors, solver->after);
}

/* Where the network did not help, the step is still as far off as when it was asked. */
static bool run(SceneNet *solver, const ContactProblem *problem, bool asked) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    if (asked) {
        if (!run_after(solver)) return false;
        if (!impact_gap_reaches(sweeps, problem->contact_count, solver->network->gate)) return true;
    }
    return sweeps_run_momentum(sweeps, solver->rest_factors, solver->rest);
}

static bool solve_without(SceneNet *solver, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    return momentum_solve(&solver->momentum, problem, solver->rest_factors, solver->rest, solution, error);
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    SceneNet *solver = state;
    Sweeps *sweeps = &solver->momentum.sweeps;
    const SweepKernel kernel = sweeps_best_kernel();
    if (!fits(solver->network, problem, error)) return false;
    if (!sweeps_begin(sweeps, kernel, problem, true, 1)) return error_memory(error, "scene-net");
    bool asked = problem->bomb >= 0 && impact_gap_reaches(sweeps, problem->contact_count, solver->network->gate);
    solution->fallbacks = (NetworkFallbacks){0};
    if (asked) {
        if (!is_known(solver, problem, &asked, error)) return false;
        solution->fallbacks.beyond_training += !asked;
    }
    if (asked) {
        find_change(solver, problem, &solution->fallbacks);
        sweeps_push(sweeps, solver->change);
        if (!is_bounded(sweeps)) {
            solution->fallbacks.not_finite++;
            return solve_without(solver, problem, solution, error);
        }
    }
    if (!run(solver, problem, asked)) return error_memory(error, "scene-net");
    if (sweeps_end(sweeps, solution)) return true;
    solution->fallbacks.not_finite += asked;
    return solve_without(solver, problem, solution, error);
}

const ContactSolverKind solver_scene_net = {
    "scene-net", "a network of the whole scene where the bomb strikes, then sweeps", settings, create, solve, destroy};

bool scene_net_make(ContactSolver *solver, const SlotNetwork *network, Error *error) {
    solver->kind = &solver_scene_net;
    solver->state = make(network, network->sweeps, REST_SWEEPS, error);
    return solver->state != NULL;
}
