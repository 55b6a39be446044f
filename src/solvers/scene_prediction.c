/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/scene_prediction.h"

#include "common/array.h"
#include "sweeps/contact_velocity.h"

#include <stdlib.h>

void scene_prediction_free(ScenePrediction *prediction) {
    scene_view_free(&prediction->view);
    free(prediction->outputs);
    free(prediction->change);
    *prediction = (ScenePrediction){0};
}

static bool reserve(ScenePrediction *prediction, size_t contacts) {
    return array_reserve((void **)&prediction->outputs, &prediction->output_capacity, 2 * contacts,
                         sizeof *prediction->outputs) &&
           array_reserve((void **)&prediction->change, &prediction->change_capacity, contacts,
                         sizeof *prediction->change);
}

bool scene_prediction_in_range(ScenePrediction *prediction, const SlotNetwork *network, const ContactProblem *problem,
                               bool *known) {
    if (!scene_view_take(&prediction->view, network, problem) || !reserve(prediction, (size_t)problem->contact_count))
        return false;
    slot_network_look(network, &prediction->view.slots, prediction->inputs);
    int within = 1; /* branchless, so that the loop is vectorised */
    for (int i = 0; i < slot_network_inputs(network); i++)
        within &= (prediction->inputs[i] >= network->low[i]) & (prediction->inputs[i] <= network->high[i]);
    *known = within != 0;
    return true;
}

void scene_prediction_make(ScenePrediction *prediction, const SlotNetwork *network, const ContactProblem *problem,
                           NetworkFallbacks *fallbacks) {
    const SceneView *view = &prediction->view;
    slot_network_predict(network, prediction->inputs, &view->slots, prediction->first, prediction->second,
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
