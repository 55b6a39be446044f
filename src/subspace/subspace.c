/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "subspace/subspace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool subspace_make(Subspace *subspace, const SubspaceNet *net, const SubspacePredictor *predictor, bool corrects,
                   Error *error) {
    const size_t lanes = (size_t)predictor->last.lanes, hidden = (size_t)net->shape.hidden,
                 numbers = (size_t)subspace_lanes(SUBSPACE_POSE * net->shape.bodies);
    *subspace = (Subspace){.net = net, .predictor = predictor, .kernels = row_kernels_best(), .corrects = corrects};
    float *at = calloc(3 * lanes + (size_t)predictor->first.from + 2 * hidden + numbers, sizeof *at);
    if (at == NULL) return error_memory(error, "subspace");
    subspace->numbers = at;
    subspace->now = at += numbers;
    subspace->last = at += lanes;
    subspace->next = at += lanes;
    subspace->first = at += lanes;
    subspace->second = at += hidden;
    subspace->inputs = at + hidden;
    return true;
}

void subspace_free(Subspace *subspace) {
    free(subspace->numbers);
    *subspace = (Subspace){0};
}

/* z = B u */
static void project(const Subspace *subspace, const float *numbers, float *components) {
    const SubspaceNet *net = subspace->net;
    const int count = SUBSPACE_POSE * net->shape.bodies, lanes = subspace_lanes(count);
    for (int k = 0; k < subspace->predictor->components; k++) {
        const float *row = net->basis + (size_t)k * (size_t)lanes;
        double sum = 0;
        for (int j = 0; j < count; j++) sum += (double)row[j] * ((double)numbers[j] - (double)net->rest[j]);
        components[k] = (float)sum;
    }
}

void subspace_start(Subspace *subspace, const float *last, const float *now) {
    project(subspace, last, subspace->last);
    project(subspace, now, subspace->now);
}

static void run_layer(const RowKernels *kernels, const SubspaceLayer *layer, const float *in, float *out) {
    memcpy(out, layer->biases, (size_t)layer->lanes * sizeof *out);
    kernels->combine(out, layer->rows, layer->lanes, in, layer->from);
}

/* next += N(...) */
static void correct(Subspace *subspace, const float launch[SUBSPACE_LAUNCH]) {
    const SubspacePredictor *predictor = subspace->predictor;
    const RowKernels *kernels = subspace->kernels;
    const int components = predictor->components, hidden = subspace->net->shape.hidden;
    float *inputs = subspace->inputs;
    for (int k = 0; k < components; k++) {
        inputs[k] = subspace->now[k];
        inputs[components + k] = subspace->now[k] - subspace->last[k];
    }
    memcpy(inputs + 2 * components, launch, SUBSPACE_LAUNCH * sizeof *launch);
    run_layer(kernels, &predictor->first, inputs, subspace->first);
    kernels->apply_tanh(subspace->first, hidden);
    run_layer(kernels, &predictor->second, subspace->first, subspace->second);
    kernels->apply_tanh(subspace->second, hidden);
    run_layer(kernels, &predictor->last, subspace->second, subspace->next);
}

SubspaceReport subspace_step(Subspace *subspace, const float launch[SUBSPACE_LAUNCH]) {
    const SubspacePredictor *predictor = subspace->predictor;
    const float *a = predictor->linear, *b = a + predictor->last.lanes, *low = subspace->net->low,
                *high = subspace->net->high;
    float *next = subspace->next;
    SubspaceReport report = {0, 0};
    if (subspace->corrects)
        correct(subspace, launch);
    else
        memset(next, 0, (size_t)predictor->last.lanes * sizeof *next);
    for (int k = 0; k < predictor->components; k++) {
        const float z = (a[k] * subspace->now[k] + b[k] * subspace->last[k]) + next[k];
        const bool finite = isfinite(z);
        const float kept = finite ? z : subspace->now[k];
        report.not_finite += !finite;
        report.beyond += finite && (z < low[k] || z > high[k]);
        next[k] = kept < low[k] ? low[k] : kept > high[k] ? high[k] : kept;
    }
    subspace->next = subspace->last;
    subspace->last = subspace->now;
    subspace->now = next;
    return report;
}

void subspace_reconstruct(Subspace *subspace) {
    const SubspaceNet *net = subspace->net;
    const int lanes = subspace_lanes(SUBSPACE_POSE * net->shape.bodies);
    memcpy(subspace->numbers, net->rest, (size_t)lanes * sizeof *subspace->numbers);
    subspace->kernels->combine(subspace->numbers, net->basis, lanes, subspace->now, subspace->predictor->components);
}
