/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/pair_network.h"

#include "common/array.h"
#include "common/names.h"
#include "sweeps/sequential_impulses.h"

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

static bool refuse_inputs(const Network *network, const char *path, Error *error) {
    NameList known = {0};
    for (int v = 0; v < PAIR_VIEWS; v++) {
        char view[64];
        snprintf(view, sizeof view, "%s (%d)", pair_views[v].name, pair_views[v].count);
        name_list_add(&known, view);
    }
    return error_input(error, path, "the network has %d inputs (%.80s); it needs those of %s", network->widths[0],
                       network->inputs, known.text);
}

static bool refuse_target(const Network *network, const char *path, Error *error) {
    NameList known = {0};
    for (int t = 0; t < PAIR_TARGETS; t++) name_list_add(&known, pair_target_names[t]);
    return error_unknown(error, path, network->target, "a target of pair networks", &known);
}

static bool find_target(const char *name, PairTarget *target) {
    for (PairTarget t = 0; t < PAIR_TARGETS; t++) {
        if (strcmp(pair_target_names[t], name) != 0) continue;
        *target = t;
        return true;
    }
    return false;
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
    bool seen = pair_view_of_inputs(network->inputs, &pair->view) && network->widths[0] == pair_views[pair->view].count;
    bool ok = (seen || refuse_inputs(network, path, error)) &&
              (find_target(network->target, &pair->target) || refuse_target(network, path, error)) &&
              check_view(pair, path, error) && check_outputs(pair, path, error);
    if (ok) {
        pair->scratch = malloc(network_batch_scratch(network) * sizeof *pair->scratch);
        ok = pair->scratch != NULL || error_memory(error, path);
    }
    if (!ok) pair_network_free(pair);
    return ok;
}

static int count_pairs(const ContactProblem *problem) {
    int pairs = 0;
    for (int first = 0; first < problem->contact_count; first += pair_contact_count(problem, first)) pairs++;
    return pairs;
}

/* The moment of the step for all pairs; *now is NULL for the problem's own velocities. */
static bool find_moment(PairNetwork *pair, const ContactProblem *problem, const PairMoment **now) {
    *now = NULL;
    if (!pair_views[pair->view].by_contact) return true;
    if (!pair_moment_reserve(&pair->moment, problem)) return false;
    static const SequentialOptions options = {.accumulate = true, .warm = true, .relaxation = 1.0f};
    ContactSolution begun = pair_moment_solution(&pair->moment);
    sequential_impulses_begin(problem, &options, &begun);
    if (pair->view == PAIR_NEIGHBOURS) pair_moment_jacobi(&pair->moment, problem);
    *now = &pair->moment;
    return true;
}

const float *pair_network_predict(PairNetwork *pair, const ContactProblem *problem, int *pairs) {
    const int count = *pairs = count_pairs(problem), width = pair_views[pair->view].count;
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
    const PairMoment *now;
    if (!find_moment(pair, problem, &now)) return NULL;
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

void pair_network_changes(const PairNetwork *pair, const ContactProblem *problem, int first, const float *outputs,
                          int stride, float changes[PAIR_CHANGES]) {
    const bool two = pair_network_outputs(pair) == 2;
    for (int i = 0; i < PAIR_CHANGES; i++) changes[i] = two ? 0 : outputs[i * stride];
    if (two) changes[3] = outputs[0], changes[4] = outputs[stride];
    if (pair_views[pair->view].by_contact) pair_from_contact_frame(&problem->contacts[first], changes);
    if (two) share_relative_change(problem, first, vec2(changes[3], changes[4]), changes);
}
