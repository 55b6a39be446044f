/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's network in place of constraint solving (Avatavului, Ifrim, Voncila 2023, sections 3.1 to 3.3).

   Pair by pair, from the velocities before the solve: ten numbers of the two bodies go in, and the change of
   their velocities comes out, to be added. All pairs see the same state, as they did in the training data, so
   their order does not matter. A network with

     two outputs gives the change of b's velocity relative to a's. The paper leaves open how it is shared and what
       becomes of the spins; here it is the impulse that makes this change, acting at the middle of the contact
       points, so that momentum is kept;
     six outputs gives the change of both velocities and spins, added as it is: momentum is not kept.

   `constant` says for every pair what the network's training data were on average. It is no method, but the mark that
   one has to beat before it can be said to have learned anything.

   Fails on stacks: it sees one pair and no other, so no impulse can be carried through a chain of boxes; and what
   it leaves of a velocity that should be zero adds up to sinking. */
#include "common/array.h"
#include "dynamics/pair.h"
#include "network/network.h"
#include "solvers/solvers.h"

#include <math.h>
#include <stdlib.h>

typedef struct PairNet {
    Network *network;
    PairView view;
    bool constant; /* the mean of the training data in place of what the network says */
    float *scratch;
    float *numbers; /* inputs[.., pairs], then outputs[.., pairs], of the step's pairs */
    size_t capacity;
} PairNet;

static const SettingSpec settings[] = {{"network", "file of the trained network (the scene's own)"}, {NULL, NULL}};

static void destroy(void *state) {
    PairNet *solver = state;
    if (solver == NULL) return;
    network_destroy(solver->network);
    free(solver->scratch);
    free(solver->numbers);
    free(solver);
}

static PairNet *create_as(const char *name, const Settings *chosen, Error *error) {
    const char *path = settings_get(chosen, "network");
    if (path == NULL) {
        error_input(error, name, "the scene names no network for it: use %s:network=FILE", name);
        return NULL;
    }
    PairNet *solver = calloc(1, sizeof *solver);
    if (solver == NULL) {
        error_memory(error, "pair-net");
        return NULL;
    }
    solver->network = network_read(path, error);
    if (solver->network == NULL) goto fail;
    const Network *network = solver->network;
    int inputs = network->widths[0], outputs = network->widths[network->layers];
    if (!pair_view_of_inputs(network->inputs, &solver->view) || inputs != pair_views[solver->view].count ||
        (outputs != 2 && outputs != PAIR_CHANGES)) {
        error_input(error, path, "a network with %d inputs (%.80s) and %d outputs; pair-net needs %d (%s) and 2 or %d",
                    inputs, network->inputs, outputs, pair_views[PAIR_RELATIVE].count, pair_views[PAIR_RELATIVE].inputs,
                    PAIR_CHANGES);
        goto fail;
    }
    solver->scratch = malloc(network_batch_scratch(solver->network) * sizeof *solver->scratch);
    if (solver->scratch == NULL) {
        error_memory(error, "pair-net");
        goto fail;
    }
    return solver;
fail:
    destroy(solver);
    return NULL;
}

static void *create(const Settings *chosen, Error *error) { return create_as("pair-net", chosen, error); }

static void *create_constant(const Settings *chosen, Error *error) {
    PairNet *solver = create_as("constant", chosen, error);
    if (solver != NULL) solver->constant = true;
    return solver;
}

/* The middle of the pair's contact points, from a body's centre. */
static Vec2 middle_arm(const ContactProblem *problem, int first, int count, Vec2 center) {
    Vec2 sum = vec2(0, 0);
    for (int i = first; i < first + count; i++) sum = vec2_add(sum, problem->contacts[i].position);
    return vec2_sub(vec2_scale(1.0f / (float)count, sum), center);
}

/* Six changes from the two outputs: equal and opposite impulses. */
static void share_relative_change(const ContactProblem *problem, int first, int count, Vec2 change,
                                  float changes[PAIR_CHANGES]) {
    const ProblemBody *a = &problem->bodies[problem->contacts[first].a];
    const ProblemBody *b = &problem->bodies[problem->contacts[first].b];
    Vec2 impulse = vec2_scale(1.0f / (a->inv_mass + b->inv_mass), change);
    Vec2 arm_a = middle_arm(problem, first, count, a->position), arm_b = middle_arm(problem, first, count, b->position);
    changes[0] = -a->inv_mass * impulse.x;
    changes[1] = -a->inv_mass * impulse.y;
    changes[2] = -a->inv_inertia * vec2_cross(arm_a, impulse);
    changes[3] = b->inv_mass * impulse.x;
    changes[4] = b->inv_mass * impulse.y;
    changes[5] = b->inv_inertia * vec2_cross(arm_b, impulse);
}

static void add_changes(BodyVelocity *velocity, const ProblemBody *body, const float changes[3]) {
    if (body->inv_mass == 0.0f) return;
    velocity->linear = vec2_add(velocity->linear, vec2(changes[0], changes[1]));
    velocity->angular += changes[2];
}

static int count_pairs(const ContactProblem *problem) {
    int pairs = 0;
    for (int first = 0; first < problem->contact_count; first += pair_contact_count(problem, first)) pairs++;
    return pairs;
}

/* The network's outputs[.., pairs] for all pairs of the step, in the solver's numbers. NULL: no memory. */
static const float *predict_pairs(PairNet *solver, const ContactProblem *problem, int pairs) {
    const int count = pair_views[solver->view].count;
    const size_t inputs_size = (size_t)pairs * (size_t)count;
    const size_t outputs_size = (size_t)pairs * (size_t)solver->network->widths[solver->network->layers];
    if (!array_reserve((void **)&solver->numbers, &solver->capacity, inputs_size + outputs_size, sizeof(float)))
        return NULL;
    float *inputs = solver->numbers, *outputs = solver->numbers + inputs_size;
    if (solver->constant) {
        for (size_t i = 0; i < outputs_size; i++) outputs[i] = solver->network->output_mean[i / (size_t)pairs];
        return outputs;
    }
    for (int first = 0, p = 0; first < problem->contact_count; first += pair_contact_count(problem, first), p++) {
        float numbers[PAIR_INPUTS_MAX];
        pair_inputs(problem, NULL, first, solver->view, numbers);
        for (int i = 0; i < count; i++) inputs[i * pairs + p] = numbers[i];
    }
    network_predict_batch(solver->network, inputs, solver->scratch, outputs, pairs);
    return outputs;
}

/* outputs: one number of the pair every `pairs`. */
static void apply_pair(const PairNet *solver, const ContactProblem *problem, int first, int count, const float *outputs,
                       int pairs, BodyVelocity *velocities) {
    int a = problem->contacts[first].a, b = problem->contacts[first].b;
    float changes[PAIR_CHANGES];
    if (solver->network->widths[solver->network->layers] == 2)
        share_relative_change(problem, first, count, vec2(outputs[0], outputs[pairs]), changes);
    else
        for (int i = 0; i < PAIR_CHANGES; i++) changes[i] = outputs[i * pairs];
    /* A number that is not finite never reaches a body: the pair is left as it is. */
    for (int i = 0; i < PAIR_CHANGES; i++)
        if (!isfinite(changes[i])) return;
    add_changes(&velocities[a], &problem->bodies[a], changes);
    add_changes(&velocities[b], &problem->bodies[b], changes + 3);
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    PairNet *solver = state;
    for (int i = 0; i < problem->body_count; i++)
        solution->velocities[i] = (BodyVelocity){problem->bodies[i].velocity, problem->bodies[i].angular_velocity};
    for (int i = 0; i < problem->contact_count; i++) solution->impulses[i] = (ContactImpulse){0, 0};
    const int pairs = count_pairs(problem);
    if (pairs == 0) return true;
    const float *outputs = predict_pairs(solver, problem, pairs);
    if (outputs == NULL) return error_memory(error, "pair-net");
    for (int first = 0, count; first < problem->contact_count; first += count, outputs++) {
        count = pair_contact_count(problem, first);
        apply_pair(solver, problem, first, count, outputs, pairs, solution->velocities);
    }
    return true;
}

const ContactSolverKind solver_pair_net = {
    "pair-net", "the paper's network: the change of a pair's velocities, pair by pair", settings, create, solve,
    destroy};

const ContactSolverKind solver_constant = {
    "constant", "what pair-net was trained on, on average: the same for every pair", settings, create_constant, solve,
    destroy};
