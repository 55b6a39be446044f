/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The prediction of a slot network (network/slot_network.h) for a contact problem. */
#pragma once
#include "solvers/scene_view.h"

/* Zero-initialise; arrays grow and are reused. */
typedef struct ScenePrediction {
    SceneView view;
    float inputs[4 * SLOT_WIDTH_MAX], first[SLOT_WIDTH_MAX], second[SLOT_WIDTH_MAX];
    float *outputs;         /* [2 slots present] */
    ContactImpulse *change; /* [contact_count] from the warm start to the prediction */
    size_t output_capacity, change_capacity;
} ScenePrediction;

void scene_prediction_free(ScenePrediction *prediction);

/* *known: whether all inputs are within the range of the training data. The problem must have the network's bodies.
   False when memory is short. */
bool scene_prediction_in_range(ScenePrediction *prediction, const SlotNetwork *network, const ContactProblem *problem,
                               bool *known);

/* After scene_prediction_in_range() of the same problem: fills `change`, with the predicted impulses clamped to their
   friction cones, and counts those that were outside. NaN or infinite if the network's outputs are. */
void scene_prediction_make(ScenePrediction *prediction, const SlotNetwork *network, const ContactProblem *problem,
                           NetworkFallbacks *fallbacks);
