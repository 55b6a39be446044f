/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pair/pair.h"

#include <stddef.h>
#include <string.h>

const char *const pair_target_names[PAIR_TARGETS + 1] = {"pair", "net", "impulse", "points"};

int pair_change_count(PairTarget target) { return target == TARGET_POINTS ? PAIR_POINT_CHANGES : PAIR_CHANGES; }

const char *pair_output_names(PairView view, PairTarget target, int outputs) {
    bool by_contact = pair_views[view].by_contact;
    if (target == TARGET_POINTS) return by_contact && outputs == PAIR_POINT_CHANGES ? "dpn1 dpt1 dpn2 dpt2" : NULL;
    if (outputs == 2) return by_contact ? "dvn dvt" : "dvx dvy";
    if (outputs == PAIR_CHANGES) return by_contact ? "dvna dvta dwa dvnb dvtb dwb" : "dvxa dvya dwa dvxb dvyb dwb";
    return NULL;
}

/* A vector's components along a contact's normal and tangent. */
static Vec2 in_contact_frame(const ContactPoint *contact, Vec2 v) {
    return vec2(vec2_dot(v, contact->normal), vec2_dot(v, vec2_cross_scalar(contact->normal, 1.0f)));
}

static Vec2 in_world(const ContactPoint *contact, Vec2 v) {
    return vec2_add(vec2_scale(v.x, contact->normal), vec2_scale(v.y, vec2_cross_scalar(contact->normal, 1.0f)));
}

static void put(float *to, Vec2 v) {
    to[0] = v.x;
    to[1] = v.y;
}

static void put_velocities(float changes[PAIR_CHANGES], Vec2 a, Vec2 b) {
    put(changes, a);
    put(changes + 3, b);
}

void pair_to_contact_frame(const ContactPoint *contact, float changes[PAIR_CHANGES]) {
    put_velocities(changes, in_contact_frame(contact, vec2(changes[0], changes[1])),
                   in_contact_frame(contact, vec2(changes[3], changes[4])));
}

void pair_from_contact_frame(const ContactPoint *contact, float changes[PAIR_CHANGES]) {
    put_velocities(changes, in_world(contact, vec2(changes[0], changes[1])),
                   in_world(contact, vec2(changes[3], changes[4])));
}

void pair_point_changes(const ContactProblem *problem, const ContactImpulse *impulses, int first,
                        float changes[PAIR_POINT_CHANGES]) {
    const int count = pair_contact_count(problem, first);
    const float inverse_mass = pair_inverse_mass(problem, first);
    for (int i = 0; i < PAIR_POINTS; i++) {
        const ContactPoint *contact = &problem->contacts[first + i];
        Vec2 beyond = vec2(0, 0);
        if (i < count)
            beyond = vec2(impulses[first + i].normal - contact->warm_normal,
                          impulses[first + i].tangent - contact->warm_tangent);
        put(changes + 2 * i, vec2_scale(inverse_mass, beyond));
    }
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

static void net_change(const ContactProblem *problem, const ContactSolution *solution, int body, float changes[3]) {
    const ProblemBody *before = &problem->bodies[body];
    const BodyVelocity *after = &solution->velocities[body];
    put(changes, vec2_sub(after->linear, before->velocity));
    changes[2] = after->angular - before->angular_velocity;
}

void pair_step_changes(const ContactProblem *problem, const ContactSolution *solution, int first, PairView view,
                       PairTarget target, float changes[PAIR_CHANGES]) {
    const ContactPoint *contact = &problem->contacts[first];
    if (target == TARGET_POINTS) {
        pair_point_changes(problem, solution->impulses, first, changes);
        return;
    }
    if (target == TARGET_NET) {
        net_change(problem, solution, contact->a, changes);
        net_change(problem, solution, contact->b, changes + 3);
    } else {
        pair_changes(problem, solution, first, pair_contact_count(problem, first), changes);
    }
    if (pair_views[view].by_contact) pair_to_contact_frame(contact, changes);
}
