/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A network for the impacts of one scene. It sees all bodies and contacts at once and predicts where the impulses will
   end; a few sweeps then correct the prediction. Sweeps alone carry a shock through a stack one contact per sweep.

   The network is used only if the residual of the warm start reaches the gate and the step resembles the
   training data: the same mass of the bomb, and all inputs within their range. All other steps are solved as by
   momentum (momentum.c). The residual after the sweeps correlates with the error, also on held-out launches: so few
   sweeps follow at first, and more if the residual is still large. Impulses act on both bodies alike and sweeps clamp
   them to their cones, so momentum is conserved whatever the network predicts. Source: a warm start by a network for
   the whole problem, as in Sambharya, Hall, Amos, Stellato, "Learning to Warm-Start Fixed-Point Optimization
   Algorithms" (2024), which also trains through the iterations that follow. Fails on other scenes, which have other
   slots; it refuses them. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/momentum.h"
#include "methods/residual.h"
#include "methods/scene_net.h"
#include "methods/stopping.h"
#include "methods/sweeps.h"
#include "nets/kinds.h"

#include <math.h>
#include <stdlib.h>

/* Zero-initialise; arrays grow and are reused. */
typedef struct ScenePrediction {
    SceneView view;
    float inputs[4 * SCENE_NET_WIDTH_MAX], first[SCENE_NET_WIDTH_MAX], second[SCENE_NET_WIDTH_MAX];
    float *outputs;         /* [2 slots present] */
    ContactImpulse *change; /* [contact_count] from the warm start to the prediction */
    ArrayBlock arrays;
} ScenePrediction;

static const float quarter_turn = 1.57079632679489662f; /* rad */

void scene_view_free(SceneView *view) {
    free(view->arrays.memory);
    *view = (SceneView){0};
}

static void load_body(float numbers[SLOT_BODY_NUMBERS], const ProblemBody *body) {
    numbers[0] = body->position.x;
    numbers[1] = body->position.y;
    numbers[2] = body->angle;
    numbers[3] = body->velocity.x;
    numbers[4] = body->velocity.y;
    numbers[5] = body->angular_velocity;
}

/* Quarter turns that map the box onto itself, as many as leave the smallest angle. */
static float turns_of(const ProblemBody *body) {
    const float step = body->size.x == body->size.y ? 1 : 2;
    return step * floorf(body->angle / (step * quarter_turn) + 0.5f);
}

float scene_view_angle(const ProblemBody *body) { return body->angle - quarter_turn * turns_of(body); }

/* Two bytes of a feature, edges of one box, renamed for so many quarter turns. */
static uint32_t turn_edges(uint32_t edges, int turns) {
    uint32_t turned = 0;
    for (int shift = 0; shift < 16; shift += 8) {
        const uint32_t edge = edges >> shift & 0xff;
        const bool known = edge >= EDGE_TOP && edge <= EDGE_RIGHT;
        turned |= (known ? (edge - EDGE_TOP + (uint32_t)turns) % 4 + EDGE_TOP : edge) << shift;
    }
    return turned;
}

/* 0 .. 3 */
static int turns_modulo_4(float turns) { return (int)(turns - 4 * floorf(turns / 4)); }

/* With the bomb rotated back by so many quarter turns. */
static uint32_t feature_of(const ContactProblem *problem, const ContactPoint *contact, int turns) {
    if (contact->a != problem->bomb && contact->b != problem->bomb) return contact->feature;
    const uint32_t a = contact->feature & 0xffff, b = contact->feature >> 16;
    return contact->a == problem->bomb ? turn_edges(a, turns) | b << 16 : a | turn_edges(b, turns) << 16;
}

uint32_t scene_view_feature(const ContactProblem *problem, const ContactPoint *contact) {
    const int bomb = problem->bomb;
    return feature_of(problem, contact, bomb < 0 ? 0 : turns_modulo_4(turns_of(&problem->bodies[bomb])));
}

static void load_contact(SceneView *view, const SceneNet *network, const ContactProblem *problem, int turns, int i) {
    const ContactPoint *contact = &problem->contacts[i];
    ContactImpulse *base = &view->base[i];
    *base = (ContactImpulse){contact->warm_normal, contact->warm_tangent};
    const int slot = scene_net_find(network, contact->a, contact->b, feature_of(problem, contact, turns));
    if (slot < 0) return;
    const int k = view->slots.slot_count++;
    view->contacts[k] = i;
    view->present[k] = slot;
    view->impulses[2 * k] = 2 * slot;
    view->impulses[2 * k + 1] = 2 * slot + 1;
    view->warm[2 * k] = base->normal;
    view->warm[2 * k + 1] = base->tangent;
    base->normal = contact_clamp(base->normal, 0, network->cap[slot]);
    const float most = contact->friction * base->normal;
    base->tangent = contact_clamp(base->tangent, -most, most);
}

bool scene_view_take(SceneView *view, const SceneNet *network, const ContactProblem *problem) {
    const size_t contacts = (size_t)problem->contact_count + 1, bodies = (size_t)problem->body_count;
    if (!ARRAY_BLOCK_RESERVE(&view->arrays, ARRAY_PART(view->state, bodies * SLOT_BODY_NUMBERS),
                             ARRAY_PART(view->ones, contacts), ARRAY_PART(view->warm, 2 * contacts),
                             ARRAY_PART(view->present, contacts), ARRAY_PART(view->impulses, 2 * contacts),
                             ARRAY_PART(view->contacts, contacts), ARRAY_PART(view->base, contacts)))
        return false;
    for (size_t i = 0; i < contacts; i++) view->ones[i] = 1;
    const ProblemBody *bomb = &problem->bodies[network->bomb];
    load_body(view->bomb, bomb);
    const float turns = turns_of(bomb);
    const int features_turn = turns_modulo_4(turns);
    view->bomb[2] -= quarter_turn * turns;
    for (int i = 0, k = 0; i < problem->body_count; i++)
        if (i != network->bomb) load_body(view->state + SLOT_BODY_NUMBERS * k++, &problem->bodies[i]);
    view->slots = (SceneNetView){view->bomb, view->state, 0, view->present, view->impulses, view->ones, view->warm};
    for (int i = 0; i < problem->contact_count; i++) load_contact(view, network, problem, features_turn, i);
    return true;
}

/* *known: whether all inputs are within the range of the training data. The problem must have the network's bodies.
   False when memory is short. */
static bool look_in_range(ScenePrediction *prediction, const SceneNet *network, const ContactProblem *problem,
                          bool *known) {
    const size_t contacts = (size_t)problem->contact_count;
    if (!scene_view_take(&prediction->view, network, problem) ||
        !ARRAY_BLOCK_RESERVE(&prediction->arrays, ARRAY_PART(prediction->outputs, 2 * contacts),
                             ARRAY_PART(prediction->change, contacts)))
        return false;
    scene_net_look(network, &prediction->view.slots, prediction->inputs);
    int within = 1; /* branchless, so that the loop is vectorised */
    for (int i = 0; i < scene_net_inputs(network); i++)
        within &= (prediction->inputs[i] >= network->low[i]) & (prediction->inputs[i] <= network->high[i]);
    *known = within != 0;
    return true;
}

/* After look_in_range() of the same problem: fills `change`, with the predicted impulses clamped to their
   friction cones, and counts those that were outside. NaN or infinite if the network's outputs are. */
static void predict_scene_net(ScenePrediction *prediction, const SceneNet *network, const ContactProblem *problem,
                              Fallbacks *fallbacks) {
    const SceneView *view = &prediction->view;
    scene_net_predict(network, prediction->inputs, &view->slots, prediction->first, prediction->second,
                      prediction->outputs);
    for (int i = 0; i < problem->contact_count; i++) prediction->change[i] = view->base[i];
    for (int k = 0; k < view->slots.slot_count; k++) {
        ContactImpulse *to = &prediction->change[view->contacts[k]];
        const float limit = problem->contacts[view->contacts[k]].friction;
        to->normal += prediction->outputs[2 * k];
        to->tangent += prediction->outputs[2 * k + 1];
        const ContactImpulse predicted = *to;
        to->normal = to->normal > 0 ? to->normal : 0;
        to->tangent = contact_clamp(to->tangent, -limit * to->normal, limit * to->normal);
        fallbacks->outside_cone += predicted.normal != to->normal || predicted.tangent != to->tangent;
    }
    for (int i = 0; i < problem->contact_count; i++) {
        prediction->change[i].normal -= problem->contacts[i].warm_normal;
        prediction->change[i].tangent -= problem->contacts[i].warm_tangent;
    }
}

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

/* What settings choose. */
typedef struct SceneNetChoice {
    int after, rest;   /* sweeps after the network, and without it */
    bool predicts;     /* false: the network is not evaluated */
    StoppingRule rule; /* after the network; after calm steps a share of it */
} SceneNetChoice;

typedef struct SceneNetSolver {
    SceneNet *own;           /* or NULL */
    const SceneNet *network; /* the same, or the caller's */
    Momentum momentum;
    ScenePrediction prediction;
    SceneNetChoice choice;
    int half;                                  /* sweeps in calm steps */
    float after_factors[SCENE_NET_SWEEPS_MAX]; /* [after] */
    float *rest_factors, *half_factors;        /* [rest], [half] */
    float *more_factors;                       /* [rule.more] of the sweeps that follow if the residual is too large */
} SceneNetSolver;

static const SettingSpec settings[] = {
    {"network", "file of the trained network (default: the scene's)", SETTING_OWN},
    {"after", "sweeps after the network (default: as in its training)",
     SETTING_INT(SceneNetChoice, after, 0, SCENE_NET_SWEEPS_MAX)},
    {"near", "sweeps go on while contacts miss their velocity by this, m/s (in blocks of 8; default: 0.02)",
     SETTING_OWN},
    {"more", "sweeps that near may add (rounded up to whole blocks; default: 48)", SETTING_OWN},
    {"rest", "sweeps with momentum in steps without the network (default: 20; half in calm steps)",
     SETTING_INT(SceneNetChoice, rest, 1, SWEEPS_MAX)},
    {"net", "on|off: off leaves out all that is learned, the prediction and the factors (default: on)",
     SETTING_BOOL(SceneNetChoice, predicts)},
    {0}};

static void destroy_scene_net(void *state) {
    SceneNetSolver *solver = state;
    if (solver == NULL) return;
    scene_net_destroy(solver->own);
    momentum_free(&solver->momentum);
    scene_view_free(&solver->prediction.view);
    free(solver->prediction.arrays.memory);
    free(solver->rest_factors);
    free(solver->half_factors);
    free(solver->more_factors);
    free(solver);
}

static SceneNetSolver *make_scene_net(const SceneNet *network, const SceneNetChoice *choice, Error *error) {
    SceneNetSolver *solver = calloc(1, sizeof *solver);
    if (solver == NULL) return error_memory(error, "scene-net"), NULL;
    solver->network = network;
    solver->choice = *choice;
    solver->half = (choice->rest + 1) / 2;
    solver->rest_factors = momentum_factors_make(solver->choice.rest);
    solver->half_factors = momentum_factors_make(solver->half);
    solver->more_factors = momentum_factors_make(solver->choice.rule.more);
    if (solver->rest_factors == NULL || solver->half_factors == NULL || solver->more_factors == NULL) {
        destroy_scene_net(solver);
        return error_memory(error, "scene-net"), NULL;
    }
    /* Learned factors are valid only for the number of sweeps they were learned for. */
    bool learned = !choice->predicts;
    for (int s = 1; s < network->sweeps; s++) learned |= network->factors[s] > 0;
    for (int s = 0; s < choice->after; s++)
        solver->after_factors[s] = choice->after == network->sweeps && choice->predicts ? network->factors[s]
                                   : learned                                            ? momentum_factor(s)
                                                                                        : 0;
    return solver;
}

static void *create_scene_net(const Settings *chosen, Error *error) {
    const char *path = method_network(chosen, NULL, "scene-net", error);
    SceneNet *network = path != NULL ? scene_net_read(path, error) : NULL;
    if (network == NULL) return NULL;
    SceneNetChoice choice = {network->sweeps, REST_SWEEPS, true, {0, near_default, STOPPING_MORE}};
    SceneNetSolver *solver =
        settings_read(chosen, settings, &choice, error) && stopping_read(&choice.rule, chosen, error)
            ? make_scene_net(network, &choice, error)
            : NULL;
    if (solver == NULL)
        scene_net_destroy(network);
    else
        solver->own = network;
    return solver;
}

/* Before the bomb appears there is one body less. */
static bool scene_net_fits(const SceneNet *network, const ContactProblem *problem, Error *error) {
    const int bodies = problem->bomb < 0 ? network->body_count - 1 : network->body_count;
    if (problem->body_count != bodies)
        return error_input(error, "scene-net", "the network is for the scene %s of %d bodies; this one has %d",
                           network->scene, bodies, problem->body_count);
    if (problem->bomb < 0 || problem->bomb == network->bomb) return true;
    return error_input(error, "scene-net",
                       "the network is for the scene %s, with the bomb as body %d; here it is body %d", network->scene,
                       network->bomb, problem->bomb);
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

static bool run_sweeps(SceneNetSolver *solver, const ContactProblem *problem, Route route) {
    Momentum *momentum = &solver->momentum;
    const SceneNetChoice *choice = &solver->choice;
    const StoppingRule *rule = &choice->rule;
    const StoppingRule calm = {0, calm_share * rule->near, rule->more < CALM_MORE ? rule->more : CALM_MORE};
    if (!momentum_begin(momentum, problem)) return false;
    switch (route) {
    case ROUTE_CALM:
        return momentum_run(momentum, solver->half_factors, solver->half) &&
               momentum_run_more(momentum, &calm, solver->more_factors);
    case ROUTE_NETWORK:
        return momentum_run(momentum, solver->after_factors, choice->after) &&
               momentum_run_more(momentum, rule, solver->more_factors);
    case ROUTE_MOMENTUM: break;
    }
    return momentum_run(momentum, solver->rest_factors, choice->rest);
}

/* After the warm start. */
static bool choose_route(SceneNetSolver *solver, const ContactProblem *problem, Route *route, Fallbacks *fallbacks,
                         Error *error) {
    const SceneNet *network = solver->network;
    *route = ROUTE_MOMENTUM;
    if (problem->bomb < 0) return true;
    bool known = problem->bodies[network->bomb].inv_mass == network->bomb_inv_mass;
    if (!residual_reaches(&solver->momentum.sweeps, problem->contact_count, network->gate)) {
        if (known) *route = ROUTE_CALM;
        return true;
    }
    if (known && !look_in_range(&solver->prediction, network, problem, &known)) return error_memory(error, "scene-net");
    if (known) *route = ROUTE_NETWORK;
    fallbacks->beyond_training += !known;
    return true;
}

static bool scene_net_solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    SceneNetSolver *solver = state;
    Sweeps *sweeps = &solver->momentum.sweeps;
    Route route;
    if (!scene_net_fits(solver->network, problem, error)) return false;
    if (!sweeps_begin_coloured(sweeps, sweeps_best_kernel(), problem)) return error_memory(error, "scene-net");
    solution->fallbacks = (Fallbacks){0};
    if (!choose_route(solver, problem, &route, &solution->fallbacks, error)) return false;
    const bool predicts = route == ROUTE_NETWORK && solver->choice.predicts;
    bool usable = true;
    if (predicts) {
        predict_scene_net(&solver->prediction, solver->network, problem, &solution->fallbacks);
        sweeps_push(sweeps, solver->prediction.change);
        usable = is_bounded(sweeps);
    }
    if (usable && !run_sweeps(solver, problem, route)) return error_memory(error, "scene-net");
    if (usable && sweeps_end(sweeps, solution))
        return islands_take_gain(&solver->momentum.islands, problem, solution) || error_memory(error, "scene-net");
    /* Without the network. */
    solution->fallbacks.not_finite += predicts;
    return momentum_solve(&solver->momentum, problem, solver->rest_factors, solver->choice.rest, solution, error);
}

const ContactSolverKind solver_scene_net = {
    .description = {.name = "scene-net",
                    .summary = "a network predicts all impulses of a scene at impacts; sweeps follow",
                    .caption = "neural network for a scene",
                    .settings = settings,
                    .needs_network = true,
                    .twin = "scene-net:net=off",
                    .chart = METHOD_RUNS("", "near=3", "more=200", "net=off", "more=200,net=off"),
                    .chart_quick = METHOD_RUNS("", "net=off"),
                    .stability = METHOD_RUNS("", "net=off")},
    .create = create_scene_net,
    .solve = scene_net_solve,
    .destroy = destroy_scene_net};

bool scene_net_make(ContactSolver *solver, const SceneNet *network, float near, Error *error) {
    solver->kind = &solver_scene_net;
    const SceneNetChoice choice = {network->sweeps, REST_SWEEPS, true, {0, near, STOPPING_MORE}};
    solver->state = make_scene_net(network, &choice, error);
    return solver->state != NULL;
}
