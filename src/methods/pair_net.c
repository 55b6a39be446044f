/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Networks of pairs: their files and predictions, the solver that applies them, and the methods contact-net and
   pair-net. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "methods/pair_net.h"
#include "methods/sweeps.h"
#include "nets/nets.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void pair_network_free(PairNetwork *pair) {
    network_destroy(pair->network);
    free(pair->scratch);
    free(pair->numbers);
    pair_moment_free(&pair->moment);
    *pair = (PairNetwork){0};
}

/* Whether the view has the inputs that the target needs. */
static bool check_view(const PairNetwork *pair, const char *path, Error *error) {
    if (pair->target == TARGET_POINTS && !pair_views[pair->view].by_contact)
        return error_input(
            error, path, "the network has the target points and the inputs %s; it needs those of contact or neighbours",
            pair_views[pair->view].name);
    if (pair->target == TARGET_IMPULSE && pair->view == PAIR_NEIGHBOURS)
        return error_input(
            error, path,
            "the network has the target impulse and the inputs neighbours, which change at every visit; it "
            "needs those of another view");
    return true;
}

static bool check_outputs(const PairNetwork *pair, const char *path, Error *error) {
    const int outputs = pair_network_outputs(pair);
    const char *names = pair_output_names(pair->view, pair->target, outputs);
    if (names != NULL && strcmp(names, pair->network->outputs) == 0) return true;
    char needed[128];
    if (pair->target == TARGET_POINTS)
        snprintf(needed, sizeof needed, "%d (%s)", PAIR_POINT_CHANGES,
                 pair_output_names(pair->view, pair->target, PAIR_POINT_CHANGES));
    else
        snprintf(needed, sizeof needed, "2 (%s) or %d (%s)", pair_output_names(pair->view, pair->target, 2),
                 PAIR_CHANGES, pair_output_names(pair->view, pair->target, PAIR_CHANGES));
    return error_input(
        error, path, "the network has the inputs %s, the target %s and %d outputs (%.80s); it needs outputs %s",
        pair_views[pair->view].name, pair_target_names[pair->target], outputs, pair->network->outputs, needed);
}

bool pair_network_read(PairNetwork *pair, const char *path, Error *error) {
    Network *network = pair->network = network_read(path, error);
    if (network == NULL) return false;
    NameList known = {0};
    bool ok = pair_view_of_inputs(network->inputs, &pair->view) && network->widths[0] == pair_views[pair->view].count;
    if (!ok) {
        for (int v = 0; v < PAIR_VIEWS; v++) {
            char view[64];
            snprintf(view, sizeof view, "%s (%d)", pair_views[v].name, pair_views[v].count);
            name_list_add(&known, view);
        }
        error_input(error, path, "the network has %d inputs (%.80s); it needs those of %s", network->widths[0],
                    network->inputs, known.text);
        pair_network_free(pair);
        return false;
    }
    for (pair->target = 0; pair->target < PAIR_TARGETS; pair->target++)
        if (strcmp(pair_target_names[pair->target], network->target) == 0) break;
    for (int t = 0; t < PAIR_TARGETS; t++) name_list_add(&known, pair_target_names[t]);
    ok = pair->target < PAIR_TARGETS ? check_view(pair, path, error) && check_outputs(pair, path, error)
                                     : error_unknown(error, path, network->target, "a target of pair networks", &known);
    if (ok) {
        pair->scratch = malloc(network_batch_scratch(network) * sizeof *pair->scratch);
        ok = pair->scratch != NULL || error_memory(error, path);
    }
    if (!ok) pair_network_free(pair);
    return ok;
}

const float *pair_network_predict(PairNetwork *pair, const ContactProblem *problem, int *pairs) {
    int count = 0;
    for (int first = 0; first < problem->contact_count; first += pair_contact_count(problem, first)) count++;
    *pairs = count;
    const int width = pair_views[pair->view].count;
    const size_t inputs_size = (size_t)count * (size_t)width;
    const size_t outputs_size = (size_t)count * (size_t)pair_network_outputs(pair);
    if (!array_reserve((void **)&pair->numbers, &pair->capacity, inputs_size + outputs_size + 1, sizeof(float)))
        return NULL;
    float *inputs = pair->numbers, *outputs = pair->numbers + inputs_size;
    if (count == 0) return outputs;
    if (pair->constant) {
        for (size_t i = 0; i < outputs_size; i++) outputs[i] = pair->network->output_mean[i / (size_t)count];
        return outputs;
    }
    const PairMoment *now = NULL; /* of the step, for all pairs; NULL: the problem's own velocities */
    if (pair_views[pair->view].by_contact) {
        static const SequentialOptions options = {.accumulate = true, .warm = true};
        if (!pair_moment_reserve(&pair->moment, problem)) return NULL;
        ContactSolution begun = pair_moment_solution(&pair->moment);
        sequential_impulses_begin(problem, &options, &begun);
        if (pair->view == PAIR_NEIGHBOURS) pair_moment_jacobi(&pair->moment, problem);
        now = &pair->moment;
    }
    for (int first = 0, p = 0; first < problem->contact_count; first += pair_contact_count(problem, first), p++) {
        float numbers[PAIR_INPUTS_MAX];
        pair_inputs(problem, now, first, pair->view, numbers);
        for (int i = 0; i < width; i++) inputs[i * count + p] = numbers[i];
    }
    network_predict_batch(pair->network, inputs, pair->scratch, outputs, count);
    return outputs;
}

void pair_network_predict_one(PairNetwork *pair, const ContactProblem *problem, const PairMoment *now, int first,
                              float *outputs) {
    if (pair->constant) {
        memcpy(outputs, pair->network->output_mean, (size_t)pair_network_outputs(pair) * sizeof *outputs);
        return;
    }
    float inputs[PAIR_INPUTS_MAX];
    pair_inputs(problem, now, first, pair->view, inputs);
    network_predict(pair->network, inputs, pair->scratch, outputs);
}

/* The mean of the pair's contact points, from a body's centre. */
static Vec2 mean_arm(const ContactProblem *problem, int first, int count, Vec2 center) {
    Vec2 sum = vec2(0, 0);
    for (int i = first; i < first + count; i++) sum = vec2_add(sum, problem->contacts[i].position);
    return vec2_sub(vec2_scale(1.0f / (float)count, sum), center);
}

/* Six changes from that of the relative velocity, by equal and opposite impulses. */
static void share_relative_change(const ContactProblem *problem, int first, Vec2 change, float changes[PAIR_CHANGES]) {
    const int count = pair_contact_count(problem, first);
    const ProblemBody *a = &problem->bodies[problem->contacts[first].a];
    const ProblemBody *b = &problem->bodies[problem->contacts[first].b];
    Vec2 impulse = vec2_scale(1.0f / (a->inv_mass + b->inv_mass), change);
    Vec2 arm_a = mean_arm(problem, first, count, a->position), arm_b = mean_arm(problem, first, count, b->position);
    changes[0] = -a->inv_mass * impulse.x;
    changes[1] = -a->inv_mass * impulse.y;
    changes[2] = -a->inv_inertia * vec2_cross(arm_a, impulse);
    changes[3] = b->inv_mass * impulse.x;
    changes[4] = b->inv_mass * impulse.y;
    changes[5] = b->inv_inertia * vec2_cross(arm_b, impulse);
}

/* Converts outputs (one number every `stride`) to changes of the two bodies in world axes: of velocity (2) and angular
   velocity (1) of a, then of b. Six outputs are these changes. Two outputs are the change of the relative velocity: the
   bodies get the effect of the impulse that makes it, at the mean of the contact points. Not for TARGET_POINTS. */
static void changes_of(const PairNetwork *pair, const ContactProblem *problem, int first, const float *outputs,
                       int stride, float changes[PAIR_CHANGES]) {
    const bool two = pair_network_outputs(pair) == 2;
    for (int i = 0; i < PAIR_CHANGES; i++) changes[i] = two ? 0 : outputs[i * stride];
    if (two) changes[3] = outputs[0], changes[4] = outputs[stride];
    if (pair_views[pair->view].by_contact) pair_from_contact_frame(&problem->contacts[first], changes);
    if (two) share_relative_change(problem, first, vec2(changes[3], changes[4]), changes);
}

/* The common part of pair-net and contact-net, which accept different networks. */

typedef struct PairSolver {
    PairNetwork network;
    int sweep_count;  /* for TARGET_IMPULSE */
    bool predicts;    /* false: the mean of its training data */
    int *pair_counts; /* [body_count] number of pairs of each body */
    size_t count_capacity;
} PairSolver;

#define PAIR_SOLVER_SWEEPS                                                                             \
    {                                                                                                  \
        "k", "sweeps over all pairs per step, for the target impulse (default: the scene's, else 10)", \
            SETTING_INT(PairSolver, sweep_count, 1, SWEEPS_MAX)                                        \
    }
#define PAIR_SOLVER_NET                                                                           \
    {                                                                                             \
        "net", "on|off: off predicts the mean of the training data for every pair (default: on)", \
            SETTING_BOOL(PairSolver, predicts)                                                    \
    }

static void destroy_solver(void *state) {
    PairSolver *solver = state;
    if (solver == NULL) return;
    pair_network_free(&solver->network);
    free(solver->pair_counts);
    free(solver);
}

/* Reads the network and the settings of the table. name: of the method. */
static PairSolver *create_solver(const char *name, const SettingSpec *known, const Settings *chosen, Error *error) {
    static const PairSolver standard = {.sweep_count = 10, .predicts = true};
    const char *path = method_network(chosen, NULL, name, error);
    PairSolver *solver = path != NULL ? settings_make(chosen, known, &standard, sizeof standard, name, error) : NULL;
    if (solver == NULL || pair_network_read(&solver->network, path, error)) {
        if (solver != NULL) solver->network.constant = !solver->predicts;
        return solver;
    }
    free(solver);
    return NULL;
}

static BodyVelocity changed(const BodyVelocity *velocity, const ProblemBody *body, const float changes[3]) {
    if (body->inv_mass == 0.0f) return *velocity;
    return (BodyVelocity){vec2_add(velocity->linear, vec2(changes[0], changes[1])), velocity->angular + changes[2]};
}

static bool is_finite_velocity(const BodyVelocity *velocity) {
    return isfinite(velocity->linear.x) && isfinite(velocity->linear.y) && isfinite(velocity->angular);
}

/* A change with a NaN or infinite number is discarded and counted. */
static void add_changes(const PairNetwork *network, const ContactProblem *problem, int first,
                        const float changes[PAIR_CHANGES], ContactSolution *solution) {
    const int a = problem->contacts[first].a, b = problem->contacts[first].b;
    const ProblemBody *body_a = &problem->bodies[a], *body_b = &problem->bodies[b];
    const BodyVelocity of_a = changed(&solution->velocities[a], body_a, changes);
    const BodyVelocity of_b = changed(&solution->velocities[b], body_b, changes + 3);
    if (!is_finite_velocity(&of_a) || !is_finite_velocity(&of_b)) {
        solution->fallbacks.not_finite++;
        return;
    }
    solution->velocities[a] = of_a;
    solution->velocities[b] = of_b;
    if (network->target != TARGET_NET && pair_network_outputs(network) != PAIR_CHANGES) return;
    if (body_a->inv_mass == 0.0f || body_b->inv_mass == 0.0f) return;
    const double mass_a = 1.0 / body_a->inv_mass, mass_b = 1.0 / body_b->inv_mass; /* N s, created in all: */
    const double x = mass_a * changes[0] + mass_b * changes[3], y = mass_a * changes[1] + mass_b * changes[4];
    solution->momentum_error += (float)sqrt(x * x + y * y);
}

static bool count_pairs(PairSolver *solver, const ContactProblem *problem) {
    const size_t bodies = (size_t)problem->body_count + 1;
    if (!array_reserve((void **)&solver->pair_counts, &solver->count_capacity, bodies, sizeof *solver->pair_counts))
        return false;
    memset(solver->pair_counts, 0, bodies * sizeof *solver->pair_counts);
    for (int first = 0; first < problem->contact_count; first += pair_contact_count(problem, first)) {
        solver->pair_counts[problem->contacts[first].a]++;
        solver->pair_counts[problem->contacts[first].b]++;
    }
    return true;
}

/* outputs: one number of the pair every `stride`. A point without outputs, or with NaN or infinite ones, keeps its warm
   start. */
static void push_points(const ContactProblem *problem, int first, const float *outputs, int stride,
                        ContactSolution *solution) {
    const int count = pair_contact_count(problem, first);
    const float inverse_mass = pair_inverse_mass(problem, first);
    for (int i = 0; i < count; i++) {
        const ContactPoint *contact = &problem->contacts[first + i];
        ContactImpulse impulse = {contact->warm_normal, contact->warm_tangent};
        if (i < PAIR_POINTS) {
            const float *beyond = outputs + 2 * i * stride;
            const ContactImpulse predicted = {impulse.normal + beyond[0] / inverse_mass,
                                              impulse.tangent + beyond[stride] / inverse_mass};
            if (isfinite(predicted.normal) && isfinite(predicted.tangent))
                impulse = predicted;
            else
                solution->fallbacks.not_finite++;
        }
        const float normal = impulse.normal > 0.0f ? impulse.normal : 0.0f, most = contact->friction * normal;
        solution->impulses[first + i] = (ContactImpulse){normal, contact_clamp(impulse.tangent, -most, most)};
        solution->fallbacks.outside_cone += impulse.normal != solution->impulses[first + i].normal ||
                                            impulse.tangent != solution->impulses[first + i].tangent;
        contact_push(solution->velocities, contact, problem->bodies, solution->impulses[first + i]);
    }
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    PairSolver *solver = state;
    PairNetwork *network = &solver->network;
    contact_solution_begin(problem, solution);
    solution->momentum_error = 0;
    solution->fallbacks = (Fallbacks){0};
    /* An impulse: sweeps over the pairs, each predicted from the current velocities. */
    const PairMoment now = {.velocities = solution->velocities};
    for (int sweep = 0; network->target == TARGET_IMPULSE && sweep < solver->sweep_count; sweep++)
        for (int first = 0; first < problem->contact_count; first += pair_contact_count(problem, first)) {
            float output[PAIR_CHANGES], changes[PAIR_CHANGES];
            pair_network_predict_one(network, problem, &now, first, output);
            changes_of(network, problem, first, output, 1, changes);
            add_changes(network, problem, first, changes, solution);
        }
    if (network->target == TARGET_IMPULSE) return true;
    /* Else all are predicted at once. */
    int pairs;
    const float *outputs = pair_network_predict(network, problem, &pairs);
    if (outputs == NULL || (network->target == TARGET_NET && !count_pairs(solver, problem)))
        return error_memory(error, "pair network");
    for (int first = 0; first < problem->contact_count; first += pair_contact_count(problem, first), outputs++) {
        if (network->target == TARGET_POINTS) {
            push_points(problem, first, outputs, pairs, solution);
            continue;
        }
        float changes[PAIR_CHANGES];
        changes_of(network, problem, first, outputs, pairs, changes);
        /* Every pair of a body predicts its whole change, so the body takes their mean. */
        const ContactPoint *contact = &problem->contacts[first];
        for (int i = 0; network->target == TARGET_NET && i < PAIR_CHANGES; i++)
            changes[i] /= (float)solver->pair_counts[i < PAIR_CHANGES / 2 ? contact->a : contact->b];
        add_changes(network, problem, first, changes, solution);
    }
    return true;
}

/* A network of contact points, beyond the paper. It predicts impulses, so every action has an equal reaction.

   The network sees each pair after the warm start, in the frame of its contact. For each contact point it predicts how
   far the impulse p = (normal, tangent) goes beyond the warm start p0, as a change d of the relative velocity. The
   result is projected onto the friction cone:

       p = P(p0 + d / (1/ma + 1/mb)),   P: pn' = max(pn, 0), pt' = clamp(pt, -mu pn', mu pn')

   Momentum and angular momentum are conserved by construction, and p is the warm start of the next step. Cone and
   accumulation are those of sequential impulses (Catto 2006). Fails on chains of boxes: all pairs are predicted from
   the same velocities, so an impulse travels one pair per step, and a box between two others is pushed twice. */

static const SettingSpec contact_net_settings[] = {
    {"network", "file of a network with the target points (default: the scene's)", SETTING_OWN}, PAIR_SOLVER_NET, {0}};

static void *contact_net_create(const Settings *chosen, Error *error) {
    PairSolver *solver = create_solver("contact-net", contact_net_settings, chosen, error);
    if (solver == NULL || solver->network.target == TARGET_POINTS) return solver;
    error_input(error, settings_get(chosen, "network"),
                "the network has the target %s, which is for pair-net; contact-net needs the target points",
                pair_target_names[solver->network.target]);
    destroy_solver(solver);
    return NULL;
}

const ContactSolverKind solver_contact_net = {
    .description = {.name = "contact-net",
                    .summary =
                        "beyond the paper: a network predicts impulses at contact points, clamped to the friction cone",
                    .caption = "neural network for contact points",
                    .settings = contact_net_settings,
                    .needs_network = true,
                    .twin = "contact-net:net=off",
                    .chart = METHOD_RUNS("", "net=off"),
                    .chart_quick = METHOD_RUNS("", "net=off"),
                    .stability = METHOD_RUNS("", "net=off")},
    .create = contact_net_create,
    .solve = solve,
    .destroy = destroy_solver};

/* The paper's network in place of constraint solving (Avatavului, Ifrim, Voncila 2023, sections 3.1 to 3.3).

   The network sees one pair of bodies at a time and predicts the change of their velocities, which is added to them.

   With two outputs it predicts the change of b's velocity relative to a's. The paper leaves open how the two bodies
   share this change and how their spins change. Here it is the effect of one impulse at the mean of the contact points,
   so momentum is conserved. With six outputs it predicts the change of both velocities and spins, added as it is:
   momentum is not conserved.

   The paper also leaves open which change the network is trained to predict, its target:

     pair     all pairs are predicted from the velocities before the solve, as in the training data; the order does not
              matter;
     net      the same, but each body takes the mean of the changes that its pairs predict: each is the body's whole
              change, so a sum would count it several times;
     impulse  k sweeps over the pairs, each predicted from the current velocities. The network has no warm start, so the
              sweeps begin from the velocities before the solve.

   momentum_error adds up the momentum that six outputs, or means of net changes, create, pair by pair and visit by
   visit. It counts even correct net changes, since parts of them come from other pairs.

   Fails on stacks: the network sees a single pair, so no impulse travels through a chain of boxes, and what remains of
   a velocity that should be zero adds up to sinking. With inputs in the frame of the contact, its warm starts are 0 in
   its own runs, since it returns no impulses, but those of the engine in its training data. */

static const SettingSpec settings[] = {{"network", "file of the trained network (default: the scene's)", SETTING_OWN},
                                       PAIR_SOLVER_SWEEPS,
                                       PAIR_SOLVER_NET,
                                       {0}};

static void *pair_net_create(const Settings *chosen, Error *error) {
    PairSolver *solver = create_solver("pair-net", settings, chosen, error);
    if (solver == NULL) return NULL;
    const PairNetwork *network = &solver->network;
    const char *path = settings_get(chosen, "network");
    if (network->target == TARGET_POINTS)
        error_input(error, path,
                    "the network has the target points, which is for contact-net; pair-net needs the target pair, "
                    "net or impulse");
    else if (network->target == TARGET_IMPULSE && pair_views[network->view].by_contact)
        error_input(error, path,
                    "the network has the target impulse and the inputs %s, which include accumulated impulses; "
                    "pair-net has none",
                    pair_views[network->view].name);
    else
        return solver;
    destroy_solver(solver);
    return NULL;
}

const ContactSolverKind solver_pair_net = {
    .description = {.name = "pair-net",
                    .summary = "the paper's network: predicts the change of velocities, pair by pair",
                    .caption = "neural network for pairs",
                    .settings = settings,
                    .needs_network = true,
                    .twin = "pair-net:net=off",
                    .chart = METHOD_RUNS("", "net=off"),
                    .chart_quick = METHOD_RUNS("", "net=off"),
                    .stability = METHOD_RUNS("", "net=off")},
    .create = pair_net_create,
    .solve = solve,
    .destroy = destroy_solver};
