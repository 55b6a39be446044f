/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/pair.h"

const char pair_input_names[] = "dx dy vxa vya vxb vyb wa wb angle_a angle_b";
const char pair_change_names[] = "dvxa dvya dwa dvxb dvyb dwb";

void pair_inputs(const ContactProblem *problem, int a, int b, float inputs[PAIR_INPUTS]) {
    const ProblemBody *body_a = &problem->bodies[a], *body_b = &problem->bodies[b];
    const float values[PAIR_INPUTS] = {body_b->position.x - body_a->position.x,
                                       body_b->position.y - body_a->position.y,
                                       body_a->velocity.x,
                                       body_a->velocity.y,
                                       body_b->velocity.x,
                                       body_b->velocity.y,
                                       body_a->angular_velocity,
                                       body_b->angular_velocity,
                                       body_a->angle,
                                       body_b->angle};
    for (int i = 0; i < PAIR_INPUTS; i++) inputs[i] = values[i];
}

void pair_changes(const ContactProblem *problem, const ContactSolution *solution, int first, int count,
                  float changes[PAIR_CHANGES]) {
    Vec2 impulse = vec2(0, 0);
    float turn_a = 0, turn_b = 0;
    for (int i = first; i < first + count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const ContactImpulse *found = &solution->impulses[i];
        Vec2 point_impulse = vec2_add(vec2_scale(found->normal, contact->normal),
                                      vec2_scale(found->tangent, vec2_cross_scalar(contact->normal, 1.0f)));
        impulse = vec2_add(impulse, point_impulse);
        turn_a += vec2_cross(contact->arm_a, point_impulse);
        turn_b += vec2_cross(contact->arm_b, point_impulse);
    }
    const ProblemBody *a = &problem->bodies[problem->contacts[first].a];
    const ProblemBody *b = &problem->bodies[problem->contacts[first].b];
    changes[0] = -a->inv_mass * impulse.x;
    changes[1] = -a->inv_mass * impulse.y;
    changes[2] = -a->inv_inertia * turn_a;
    changes[3] = b->inv_mass * impulse.x;
    changes[4] = b->inv_mass * impulse.y;
    changes[5] = b->inv_inertia * turn_b;
}

int pair_contact_count(const ContactProblem *problem, int first) {
    const ContactPoint *contacts = problem->contacts;
    int end = first + 1;
    while (end < problem->contact_count && contacts[end].a == contacts[first].a && contacts[end].b == contacts[first].b)
        end++;
    return end - first;
}
