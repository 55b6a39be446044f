/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/scene_view.h"

#include "collision/manifold.h"
#include "common/array.h"
#include "sweeps/contact_velocity.h"

#include <math.h>
#include <stdlib.h>

static const float quarter_turn = 1.57079632679489662f; /* rad */

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

static void load_body(float numbers[SLOT_BODY_NUMBERS], const ProblemBody *body) {
    numbers[0] = body->position.x;
    numbers[1] = body->position.y;
    numbers[2] = body->angle;
    numbers[3] = body->velocity.x;
    numbers[4] = body->velocity.y;
    numbers[5] = body->angular_velocity;
}

/* Quarter turns that map the box onto itself, as many as leave the smallest angle. */
static float turns_of(const ProblemBody *body) {
    const float step = body->size.x == body->size.y ? 1 : 2;
    return step * floorf(body->angle / (step * quarter_turn) + 0.5f);
}

float scene_view_angle(const ProblemBody *body) { return body->angle - quarter_turn * turns_of(body); }

/* Two bytes of a feature, edges of one box, renamed for so many quarter turns. */
static uint32_t turn_edges(uint32_t edges, int turns) {
    uint32_t turned = 0;
    for (int shift = 0; shift < 16; shift += 8) {
        const uint32_t edge = edges >> shift & 0xff;
        const bool known = edge >= EDGE_TOP && edge <= EDGE_RIGHT;
        turned |= (known ? (edge - EDGE_TOP + (uint32_t)turns) % 4 + EDGE_TOP : edge) << shift;
    }
    return turned;
}

static uint32_t turn_feature(uint32_t feature, bool of_a, int turns) {
    const uint32_t a = feature & 0xffff, b = feature >> 16;
    return of_a ? turn_edges(a, turns) | b << 16 : a | turn_edges(b, turns) << 16;
}

/* 0 .. 3 */
static int turns_modulo_4(float turns) { return (int)(turns - 4 * floorf(turns / 4)); }

/* With the bomb rotated back by so many quarter turns. */
static uint32_t feature_of(const ContactProblem *problem, const ContactPoint *contact, int turns) {
    if (contact->a != problem->marked && contact->b != problem->marked) return contact->feature;
    return turn_feature(contact->feature, contact->a == problem->marked, turns);
}

uint32_t scene_view_feature(const ContactProblem *problem, const ContactPoint *contact) {
    const int bomb = problem->marked;
    return feature_of(problem, contact, bomb < 0 ? 0 : turns_modulo_4(turns_of(&problem->bodies[bomb])));
}

static void load_contact(SceneView *view, const SlotNetwork *network, const ContactProblem *problem, int turns, int i) {
    const ContactPoint *contact = &problem->contacts[i];
    ContactImpulse *base = &view->base[i];
    *base = (ContactImpulse){contact->warm_normal, contact->warm_tangent};
    const int slot = slot_network_find(network, contact->a, contact->b, feature_of(problem, contact, turns));
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
    const ProblemBody *bomb = &problem->bodies[network->bomb];
    load_body(view->bomb, bomb);
    const float turns = turns_of(bomb);
    const int features_turn = turns_modulo_4(turns);
    view->bomb[2] -= quarter_turn * turns;
    for (int i = 0, k = 0; i < problem->body_count; i++)
        if (i != network->bomb) load_body(view->state + SLOT_BODY_NUMBERS * k++, &problem->bodies[i]);
    view->slots = (SlotView){view->bomb, view->state, 0, view->present, view->impulses, view->ones, view->warm};
    for (int i = 0; i < problem->contact_count; i++) load_contact(view, network, problem, features_turn, i);
    return true;
}
