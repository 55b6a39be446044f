/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dynamics/pair.h"

#include <string.h>

const PairViewInfo pair_views[PAIR_VIEWS] = {
    [PAIR_RELATIVE] = {"relative", 10, "dx dy vxa vya vxb vyb wa wb angle_a angle_b"},
    [PAIR_RAW] = {"raw", 12, "xa ya xb yb vxa vya vxb vyb wa wb angle_a angle_b"},
    [PAIR_RAW_UNTURNED] = {"raw-unturned", 10, "xa ya xb yb vxa vya vxb vyb wa wb"}};
const char pair_change_names[] = "dvxa dvya dwa dvxb dvyb dwb";

bool pair_view_find(const char *name, PairView *view) {
    for (PairView v = 0; v < PAIR_VIEWS; v++) {
        if (strcmp(pair_views[v].name, name) != 0) continue;
        *view = v;
        return true;
    }
    return false;
}

bool pair_view_of_inputs(const char *inputs, PairView *view) {
    for (PairView v = 0; v < PAIR_VIEWS; v++) {
        if (strcmp(pair_views[v].inputs, inputs) != 0) continue;
        *view = v;
        return true;
    }
    return false;
}

void pair_inputs(const ContactProblem *problem, const BodyVelocity *velocities, int a, int b, PairView view,
                 float *inputs) {
    const ProblemBody *body_a = &problem->bodies[a], *body_b = &problem->bodies[b];
    BodyVelocity of_a = {body_a->velocity, body_a->angular_velocity};
    BodyVelocity of_b = {body_b->velocity, body_b->angular_velocity};
    if (velocities != NULL) {
        of_a = velocities[a];
        of_b = velocities[b];
    }
    if (view == PAIR_RELATIVE) {
        *inputs++ = body_b->position.x - body_a->position.x;
        *inputs++ = body_b->position.y - body_a->position.y;
    } else {
        *inputs++ = body_a->position.x;
        *inputs++ = body_a->position.y;
        *inputs++ = body_b->position.x;
        *inputs++ = body_b->position.y;
    }
    *inputs++ = of_a.linear.x;
    *inputs++ = of_a.linear.y;
    *inputs++ = of_b.linear.x;
    *inputs++ = of_b.linear.y;
    *inputs++ = of_a.angular;
    *inputs++ = of_b.angular;
    if (view == PAIR_RAW_UNTURNED) return;
    *inputs++ = body_a->angle;
    *inputs++ = body_b->angle;
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
