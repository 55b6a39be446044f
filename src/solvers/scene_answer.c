/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/scene_answer.h"

#include "common/array.h"
#include "sweeps/contact_velocity.h"

#include <stdlib.h>

void scene_answer_free(SceneAnswer *answer) {
    scene_view_free(&answer->view);
    free(answer->outputs);
    free(answer->change);
    *answer = (SceneAnswer){0};
}

static bool reserve(SceneAnswer *answer, size_t contacts) {
    return array_reserve((void **)&answer->outputs, &answer->output_capacity, 2 * contacts, sizeof *answer->outputs) &&
           array_reserve((void **)&answer->change, &answer->change_capacity, contacts, sizeof *answer->change);
}

bool scene_answer_knows(SceneAnswer *answer, const SlotNetwork *network, const ContactProblem *problem, bool *known) {
    if (!scene_view_take(&answer->view, network, problem) || !reserve(answer, (size_t)problem->contact_count))
        return false;
    slot_network_look(network, &answer->view.slots, answer->inputs);
    int within = 1; /* without branches: all inputs in a few vector instructions */
    for (int i = 0; i < slot_network_inputs(network); i++)
        within &= (answer->inputs[i] >= network->low[i]) & (answer->inputs[i] <= network->high[i]);
    *known = within != 0;
    return true;
}

void scene_answer_find(SceneAnswer *answer, const SlotNetwork *network, const ContactProblem *problem,
                       NetworkFallbacks *fallbacks) {
    const SceneView *view = &answer->view;
    slot_network_predict(network, answer->inputs, &view->slots, answer->first, answer->second, answer->outputs);
    for (int i = 0; i < problem->contact_count; i++) answer->change[i] = view->base[i];
    for (int k = 0; k < view->slots.slot_count; k++) {
        ContactImpulse *to = &answer->change[view->contacts[k]];
        const float limit = problem->contacts[view->contacts[k]].friction;
        to->normal += answer->outputs[2 * k];
        to->tangent += answer->outputs[2 * k + 1];
        const ContactImpulse said = *to;
        to->normal = to->normal > 0 ? to->normal : 0;
        to->tangent = contact_clamp(to->tangent, -limit * to->normal, limit * to->normal);
        fallbacks->outside_cone += said.normal != to->normal || said.tangent != to->tangent;
    }
    for (int i = 0; i < problem->contact_count; i++) {
        answer->change[i].normal -= problem->contacts[i].warm_normal;
        answer->change[i].tangent -= problem->contacts[i].warm_tangent;
    }
}
