/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What all steppers share: the frame of a step, the memory of the last one, and the momentum of free flight. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/steppers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void copy_items(void *to, const void *from, size_t bytes) {
    if (bytes > 0) memcpy(to, from, bytes);
}

/* It does not fail, as step_memory_match() has reserved the arrays. */
static void keep(StepMemory *memory, const World *world) {
    const ContactProblem *problem = world_problem(world);
    memory->body_count = problem->body_count;
    memory->contact_count = problem->contact_count;
    copy_items(memory->bodies, world_bodies(world), (size_t)problem->body_count * sizeof *memory->bodies);
    for (int i = 0; i < problem->contact_count; i++)
        memory->pairs[i] = (TouchingPair){problem->contacts[i].a, problem->contacts[i].b};
}

bool stepping_step(const SteppingKind *kind, void *state, World *world, const Step *step, Error *error) {
    ContactProblem problem;
    BegunStep begun = {world, step, &problem, NULL, NULL};
    if (!world_begin_step(world, step->scene->dt, &problem, &begun.solution, error)) return false;
    step_solving_begins(step);
    const bool solved = kind->solve(state, &begun, error);
    step_solving_ends(step);
    if (!solved) return false;
    if (kind->measure != NULL) kind->measure(state, &begun);
    if (!(begun.poses != NULL ? world_end_step_at(world, begun.poses, error) : world_end_step(world, error)))
        return false;
    if (kind->keep != NULL) kind->keep(state, world);
    if (kind->memory != NULL) keep(kind->memory(state), world);
    return true;
}

void step_memory_free(StepMemory *memory) {
    free(memory->bodies);
    free(memory->pairs);
    free(memory->of_bodies);
    free(memory->of_contacts);
    free(memory->known);
    free(memory->before);
    *memory = (StepMemory){0};
}

/* For what is kept of a step. */
static bool reserve(StepMemory *memory, size_t bodies, size_t contacts) {
    return array_reserve((void **)&memory->bodies, &memory->body_capacity, bodies, sizeof *memory->bodies) &&
           array_reserve((void **)&memory->pairs, &memory->pair_capacity, contacts, sizeof *memory->pairs) &&
           array_reserve(&memory->of_bodies, &memory->of_body_capacity, bodies * memory->each_body, 1) &&
           array_reserve(&memory->of_contacts, &memory->of_contact_capacity, contacts * memory->each_contact, 1);
}

bool step_memory_match(StepMemory *memory, const World *world, const Step *step) {
    const ContactProblem *problem = world_problem(world);
    const Body *body = world_bodies(world);
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    if (step->frame == 1) memory->body_count = memory->contact_count = 0;
    if (!step->scene->warm_starting) memory->contact_count = 0;
    if (!reserve(memory, bodies, contacts) ||
        !array_reserve((void **)&memory->known, &memory->known_capacity, bodies, sizeof *memory->known) ||
        !array_reserve((void **)&memory->before, &memory->before_capacity, contacts, sizeof *memory->before))
        return false;
    for (int i = 0; i < problem->body_count; i++) /* a body has no padding: eleven floats */
        memory->known[i] = i < memory->body_count && memcmp(&body[i], &memory->bodies[i], sizeof *body) == 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const int before = world_contacts_before(world)[i];
        const bool known = memory->known[contact->a] && memory->known[contact->b] && before >= 0 &&
                           before < memory->contact_count && memory->pairs[before].a == contact->a &&
                           memory->pairs[before].b == contact->b;
        memory->before[i] = known ? before : -1;
    }
    return true;
}

bool step_memory_copy(StepMemory *to, const StepMemory *from) {
    const size_t bodies = (size_t)from->body_count, contacts = (size_t)from->contact_count;
    to->each_body = from->each_body;
    to->each_contact = from->each_contact;
    to->body_count = to->contact_count = 0;
    if (!reserve(to, bodies, contacts)) return false;
    to->body_count = from->body_count;
    to->contact_count = from->contact_count;
    copy_items(to->bodies, from->bodies, bodies * sizeof *to->bodies);
    copy_items(to->pairs, from->pairs, contacts * sizeof *to->pairs);
    copy_items(to->of_bodies, from->of_bodies, bodies * to->each_body);
    copy_items(to->of_contacts, from->of_contacts, contacts * to->each_contact);
    return true;
}

float free_flight_momentum(const ContactProblem *problem, const ContactSolution *solution, bool *touched) {
    float sum = 0;
    memset(touched, 0, (size_t)problem->body_count * sizeof *touched);
    for (int i = 0; i < problem->contact_count; i++)
        touched[problem->contacts[i].a] = touched[problem->contacts[i].b] = true;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        if (touched[i] || body->inv_mass == 0) continue;
        const Vec2 change = vec2_sub(solution->velocities[i].linear, body->velocity);
        sum += sqrtf(vec2_dot(change, change)) / body->inv_mass;
    }
    return sum;
}
