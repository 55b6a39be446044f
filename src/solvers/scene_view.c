/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/scene_view.h"

#include "common/array.h"
#include "solvers/contact_velocity.h"

#include <stdlib.h>

void scene_view_free(SceneView *view) {
    free(view->contacts);
    free(view->base);
    free(view->state);
    free(view->ones);
    free(view->warm);
    free(view->present);
    free(view->impulses);
    *view = (SceneView){0};
}

static bool reserve(SceneView *view, const ContactProblem *problem) {
    const size_t contacts = (size_t)problem->contact_count + 1, bodies = (size_t)problem->body_count;
    if (!array_reserve((void **)&view->state, &view->state_capacity, bodies * SLOT_BODY_NUMBERS, sizeof(float)) ||
        !array_reserve((void **)&view->warm, &view->warm_capacity, 2 * contacts, sizeof(float)) ||
        !array_reserve((void **)&view->present, &view->present_capacity, contacts, sizeof(int32_t)) ||
        !array_reserve((void **)&view->impulses, &view->impulse_capacity, 2 * contacts, sizeof(int32_t)) ||
        !array_reserve((void **)&view->contacts, &view->contact_capacity, contacts, sizeof(int32_t)) ||
        !array_reserve((void **)&view->base, &view->base_capacity, contacts, sizeof *view->base))
        return false;
    const size_t had = view->ones_capacity;
    if (!array_reserve((void **)&view->ones, &view->ones_capacity, contacts, sizeof(float))) return false;
    for (size_t i = had; i < view->ones_capacity; i++) view->ones[i] = 1;
    return true;
}

static void put_body(float numbers[SLOT_BODY_NUMBERS], const ProblemBody *body) {
    numbers[0] = body->position.x;
    numbers[1] = body->position.y;
    numbers[2] = body->angle;
    numbers[3] = body->velocity.x;
    numbers[4] = body->velocity.y;
    numbers[5] = body->angular_velocity;
}

static void put_contact(SceneView *view, const SlotNetwork *network, const ContactPoint *contact, int i) {
    ContactImpulse *base = &view->base[i];
    *base = (ContactImpulse){contact->warm_normal, contact->warm_tangent};
    const int slot = slot_network_find(network, contact->a, contact->b, contact->feature);
    if (slot < 0) return;
    const int k = view->slots.slot_count++;
    view->contacts[k] = i;
    view->present[k] = slot;
    view->impulses[2 * k] = 2 * slot;
    view->impulses[2 * k + 1] = 2 * slot + 1;
    view->warm[2 * k] = base->normal;
    view->warm[2 * k + 1] = base->tangent;
    base->normal = contact_clamp(base->normal, 0, network->cap[slot]);
    const float most = contact->friction * base->normal;
    base->tangent = contact_clamp(base->tangent, -most, most);
}

bool scene_view_take(SceneView *view, const SlotNetwork *network, const ContactProblem *problem) {
    if (!reserve(view, problem)) return false;
    put_body(view->bomb, &problem->bodies[network->bomb]);
    for (int i = 0, k = 0; i < problem->body_count; i++)
        if (i != network->bomb) put_body(view->state + SLOT_BODY_NUMBERS * k++, &problem->bodies[i]);
    view->slots = (SlotView){view->bomb, view->state, 0, view->present, view->impulses, view->ones, view->warm};
    for (int i = 0; i < problem->contact_count; i++) put_contact(view, network, &problem->contacts[i], i);
    return true;
}
