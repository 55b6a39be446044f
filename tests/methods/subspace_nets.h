/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A small network of subspace, made by hand: two bodies, eight components, each of which is a number of a body. Without
   changes all move as they moved in the last step: z' = 2 z - z_before. */
#pragma once
#include "testing.h"

#include "nets/kinds.h"

enum { TEST_NUMBERS = 2 * SUBSPACE_POSE, TEST_RANGE = 1000 };

static inline SubspaceNet *subspace_net_by_hand(int frames_before) {
    const SubspaceShape shape = {.bodies = 2,
                                 .components = TEST_NUMBERS,
                                 .hidden = ROW_LANES,
                                 .frames_before = frames_before,
                                 .predictor_count = 2,
                                 .predictors = {4, TEST_NUMBERS}};
    Error error = {0};
    assert_ok(subspace_shape_check(&shape, "by hand", &error), error);
    SubspaceNet *net = subspace_net_create(&shape, &error);
    assert_ok(net != NULL, error);
    strcpy(net->scene, "single");
    for (int k = 0; k < TEST_NUMBERS; k++) {
        net->basis[k * subspace_lanes(TEST_NUMBERS) + k] = 1;
        net->low[k] = -TEST_RANGE;
        net->high[k] = TEST_RANGE;
        for (int i = 0; i < 2; i++) {
            const SubspacePredictor *predictor = &net->predictors[i];
            if (k >= predictor->components) continue;
            predictor->linear[k] = 2;
            predictor->linear[predictor->last.lanes + k] = -1;
        }
    }
    return net;
}
