/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "relation/relation_network.h"

#include "common/array.h"

#include <stdlib.h>
#include <string.h>

enum { RELATION_LAYERS = 3, OBJECT_LAYERS = 2 };

bool relation_network_create(RelationNetwork *network, Error *error) {
    static const int relation[RELATION_LAYERS + 1] = {RELATION_PAIR_INPUTS, RELATION_HIDDEN, RELATION_HIDDEN,
                                                      RELATION_EFFECTS},
                                                object[OBJECT_LAYERS + 1] = {RELATION_OBJECT_INPUTS, RELATION_HIDDEN,
                                                                             RELATION_OUTPUTS};
    *network = (RelationNetwork){.relation = network_create(RELATION_LAYERS, relation, error)};
    if (network->relation != NULL) network->object = network_create(OBJECT_LAYERS, object, error);
    if (network->object == NULL) return false;
    for (int l = 0; l < RELATION_LAYERS; l++) network->relation->activations[l] = ACTIVATION_TANH;
    network->object->activations[0] = ACTIVATION_TANH;
    return true;
}

void relation_network_destroy(RelationNetwork *network) {
    network_destroy(network->relation);
    network_destroy(network->object);
    *network = (RelationNetwork){0};
}

void relation_networks_destroy(RelationNetworks *networks) {
    for (int f = 0; f < RELATION_FORMS; f++) relation_network_destroy(&networks->forms[f]);
}

void relation_answers_free(RelationAnswers *answers) {
    free(answers->outputs);
    free(answers->known);
    free(answers->effects);
    free(answers->inputs);
    free(answers->columns);
    free(answers->scratch);
    *answers = (RelationAnswers){0};
}

static bool reserve(RelationAnswers *answers, const RelationNetwork *network, const RelationView *view) {
    const size_t bodies = (size_t)view->body_count + 1, rows = (size_t)view->row_count + 1,
                 relation = network_batch_scratch(network->relation), object = network_batch_scratch(network->object);
    return array_reserve((void **)&answers->outputs, &answers->output_capacity, bodies * RELATION_OUTPUTS,
                         sizeof(float)) &&
           array_reserve((void **)&answers->known, &answers->known_capacity, bodies, sizeof(bool)) &&
           array_reserve((void **)&answers->effects, &answers->effect_capacity, rows * RELATION_EFFECTS,
                         sizeof(float)) &&
           array_reserve((void **)&answers->inputs, &answers->input_capacity, bodies * RELATION_OBJECT_INPUTS,
                         sizeof(float)) &&
           array_reserve((void **)&answers->columns, &answers->column_capacity, bodies * RELATION_OUTPUTS,
                         sizeof(float)) &&
           array_reserve((void **)&answers->scratch, &answers->scratch_capacity, relation > object ? relation : object,
                         sizeof(float));
}

/* A NaN counts as outside, and is moved to the lower end. */
static bool check(float *numbers, int stride, int count, const float *low, const float *high, bool clamp) {
    bool inside = true;
    for (int i = 0; i < count; i++) {
        float *x = &numbers[i * stride];
        if (*x >= low[i] && *x <= high[i]) continue;
        inside = false;
        if (clamp) *x = *x > high[i] ? high[i] : low[i];
    }
    return inside;
}

static void check_ranges(RelationAnswers *answers, const RelationNetwork *network, RelationView *view, bool clamp) {
    for (int b = 0; b < view->body_count; b++) {
        const RelationBody *body = &view->bodies[b];
        bool known = check(view->body_inputs + b, view->body_count, RELATION_BODY_INPUTS, network->body_low,
                           network->body_high, clamp);
        for (int r = body->first; r < body->first + body->rows; r++)
            known = check(view->pair_inputs + r, view->row_count, RELATION_PAIR_INPUTS, network->pair_low,
                          network->pair_high, clamp) &&
                    known;
        answers->known[b] = known;
    }
}

/* Body inputs, and the sums of effects in the order of the rows. */
static void fill_object_inputs(RelationAnswers *answers, const RelationView *view) {
    const int bodies = view->body_count;
    memcpy(answers->inputs, view->body_inputs, (size_t)bodies * RELATION_BODY_INPUTS * sizeof *answers->inputs);
    for (int e = 0; e < RELATION_EFFECTS; e++) {
        const float *effects = answers->effects + (ptrdiff_t)e * view->row_count;
        float *sums = answers->inputs + (ptrdiff_t)(RELATION_BODY_INPUTS + e) * bodies;
        for (int b = 0; b < bodies; b++) {
            const RelationBody *body = &view->bodies[b];
            float sum = 0;
            for (int r = body->first; r < body->first + body->rows; r++) sum += effects[r];
            sums[b] = sum;
        }
    }
}

bool relation_answer(RelationAnswers *answers, const RelationNetwork *network, RelationView *view, bool clamp) {
    if (!reserve(answers, network, view)) return false;
    check_ranges(answers, network, view, clamp);
    if (view->body_count == 0) return true;
    network_predict_batch(network->relation, view->pair_inputs, answers->scratch, answers->effects, view->row_count);
    fill_object_inputs(answers, view);
    network_predict_batch(network->object, answers->inputs, answers->scratch, answers->columns, view->body_count);
    for (int b = 0; b < view->body_count; b++)
        for (int o = 0; o < RELATION_OUTPUTS; o++)
            answers->outputs[b * RELATION_OUTPUTS + o] = answers->columns[o * view->body_count + b];
    return true;
}
