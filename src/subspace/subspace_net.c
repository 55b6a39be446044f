/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "subspace/subspace_net.h"

#include <stdlib.h>

enum { POSE = 3 }; /* x, y, angle */

bool subspace_shape_check(const SubspaceShape *shape, const char *where, Error *error) {
    bool ok = shape->bodies >= 1 && shape->bodies <= SUBSPACE_BODIES_MAX && shape->hidden >= ROW_LANES &&
              shape->hidden <= SUBSPACE_HIDDEN_MAX && shape->hidden % ROW_LANES == 0 && shape->frames_before >= 0 &&
              shape->frames_before <= SUBSPACE_FRAMES_MAX && shape->predictor_count >= 1 &&
              shape->predictor_count <= SUBSPACE_PREDICTORS_MAX && shape->components >= 1 &&
              shape->components <= SUBSPACE_COMPONENTS_MAX && shape->components <= SUBSPACE_POSE * shape->bodies;
    for (int i = 0; ok && i < shape->predictor_count; i++)
        ok = shape->predictors[i] > (i > 0 ? shape->predictors[i - 1] : 0);
    ok = ok && shape->predictors[shape->predictor_count - 1] == shape->components;
    return ok ||
           error_input(error, where,
                       "%d bodies, %d components, %d hidden units, %d frames and %d predictors "
                       "are out of bounds or do not fit together",
                       shape->bodies, shape->components, shape->hidden, shape->frames_before, shape->predictor_count);
}

/* Takes `count` numbers from the block; before there is one, only counts them. */
static float *take(SubspaceNet *net, size_t *used, size_t count) {
    float *at = net->block != NULL ? net->block + *used : NULL;
    *used += count;
    return at;
}

static SubspaceLayer take_layer(SubspaceNet *net, size_t *used, int from, int to) {
    const size_t lanes = (size_t)subspace_lanes(to);
    return (SubspaceLayer){from, (int)lanes, take(net, used, (size_t)from * lanes), take(net, used, lanes)};
}

static size_t lay_out(SubspaceNet *net) {
    const SubspaceShape *shape = &net->shape;
    const size_t numbers = (size_t)subspace_lanes(SUBSPACE_POSE * shape->bodies),
                 components = (size_t)shape->components;
    size_t used = 0;
    net->rest = take(net, &used, numbers);
    net->basis = take(net, &used, components * numbers);
    net->low = take(net, &used, components);
    net->high = take(net, &used, components);
    net->before = take(net, &used, (size_t)shape->frames_before * (size_t)(shape->bodies - 1) * POSE);
    for (int i = 0; i < shape->predictor_count; i++) {
        SubspacePredictor *predictor = &net->predictors[i];
        const int count = predictor->components = shape->predictors[i];
        predictor->linear = take(net, &used, 2 * (size_t)subspace_lanes(count));
        predictor->first = take_layer(net, &used, 2 * count + SUBSPACE_LAUNCH, shape->hidden);
        predictor->second = take_layer(net, &used, shape->hidden, shape->hidden);
        predictor->last = take_layer(net, &used, shape->hidden, count);
    }
    return used;
}

SubspaceNet *subspace_net_create(const SubspaceShape *shape, Error *error) {
    SubspaceNet *net = calloc(1, sizeof *net);
    if (net != NULL) {
        net->shape = *shape;
        net->block = calloc(lay_out(net), sizeof *net->block);
        if (net->block != NULL) {
            lay_out(net);
            return net;
        }
    }
    free(net);
    error_memory(error, "subspace");
    return NULL;
}

SubspaceNet subspace_net_sizes(const SubspaceShape *shape) {
    SubspaceNet net = {.shape = *shape};
    lay_out(&net);
    return net;
}

void subspace_net_destroy(SubspaceNet *net) {
    if (net == NULL) return;
    free(net->block);
    free(net);
}

const SubspacePredictor *subspace_net_choose(const SubspaceNet *net, int components) {
    int chosen = 0;
    for (int i = 1; i < net->shape.predictor_count; i++)
        if (net->predictors[i].components <= components) chosen = i;
    return &net->predictors[chosen];
}
