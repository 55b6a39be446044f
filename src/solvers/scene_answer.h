/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a slot network says of a contact problem (network/slot_network.h). */
#pragma once
#include "solvers/scene_view.h"

/* Zero-initialise; arrays grow and are reused. */
typedef struct SceneAnswer {
    SceneView view;
    float inputs[4 * SLOT_WIDTH_MAX], first[SLOT_WIDTH_MAX], second[SLOT_WIDTH_MAX];
    float *outputs;         /* [2 slots there are] */
    ContactImpulse *change; /* [contact_count] */
    size_t output_capacity, change_capacity;
} SceneAnswer;

void scene_answer_free(SceneAnswer *answer);

/* Whether the problem, which has the network's bodies, is like those of its training: no input is beyond them. False when
   memory is short. */
bool scene_answer_knows(SceneAnswer *answer, const SlotNetwork *network, const ContactProblem *problem, bool *known);

/* Of a problem that is known: change, from the warm start to what the network says, inside the friction cones. Not finite
   where the network is not. Counts those that were outside of their cones. */
void scene_answer_find(SceneAnswer *answer, const SlotNetwork *network, const ContactProblem *problem,
                       NetworkFallbacks *fallbacks);
