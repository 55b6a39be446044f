/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pair/pair_moment.h"

#include "common/array.h"
#include "pair/pair.h"

#include <stdlib.h>
#include <string.h>

void pair_moment_free(PairMoment *moment) {
    free(moment->velocities);
    free(moment->impulses);
    free(moment->alone);
    free(moment->pushes);
    *moment = (PairMoment){0};
}

bool pair_moment_reserve(PairMoment *moment, const ContactProblem *problem) {
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count + 1;
    return array_reserve((void **)&moment->velocities, &moment->velocity_capacity, bodies, sizeof(BodyVelocity)) &&
           array_reserve((void **)&moment->impulses, &moment->impulse_capacity, contacts, sizeof(ContactImpulse)) &&
           array_reserve((void **)&moment->alone, &moment->alone_capacity, contacts, sizeof(ContactImpulse)) &&
           array_reserve((void **)&moment->pushes, &moment->push_capacity, bodies, sizeof(BodyVelocity));
}

ContactSolution pair_moment_solution(const PairMoment *moment) {
    return (ContactSolution){moment->velocities, moment->impulses, 0, {0}};
}

/* Adds `sign` times the change of a body's velocity by the contact's Jacobi impulse. */
static void add_impulse(BodyVelocity *velocity, const ContactProblem *problem, const ContactPoint *contact,
                        ContactImpulse push, int body, float sign) {
    const ProblemBody *pushed = &problem->bodies[body];
    Vec2 impulse = vec2_add(vec2_scale(push.normal, contact->normal),
                            vec2_scale(push.tangent, vec2_cross_scalar(contact->normal, 1.0f)));
    impulse = vec2_scale(body == contact->a ? -sign : sign, impulse);
    velocity->linear = vec2_add(velocity->linear, vec2_scale(pushed->inv_mass, impulse));
    velocity->angular +=
        pushed->inv_inertia * vec2_cross(body == contact->a ? contact->arm_a : contact->arm_b, impulse);
}

static float clamp(float value, float low, float high) { return value < low ? low : value > high ? high : value; }

/* The impulses of one visit of this contact, less those so far. */
static ContactImpulse jacobi_impulse(const PairMoment *moment, const ContactProblem *problem, int i) {
    const ContactPoint *contact = &problem->contacts[i];
    const ContactImpulse so_far = moment->impulses[i];
    const Vec2 velocity =
        pair_point_velocity(contact, &moment->velocities[contact->a], &moment->velocities[contact->b]);
    float normal = so_far.normal - contact->mass_normal * (velocity.x - contact->bias);
    normal = normal > 0 ? normal : 0;
    const float most = contact->friction * normal;
    const float tangent = clamp(so_far.tangent - contact->mass_tangent * velocity.y, -most, most);
    return (ContactImpulse){normal - so_far.normal, tangent - so_far.tangent};
}

void pair_moment_jacobi(PairMoment *moment, const ContactProblem *problem) {
    memset(moment->pushes, 0, (size_t)problem->body_count * sizeof *moment->pushes);
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const ContactImpulse push = moment->alone[i] = jacobi_impulse(moment, problem, i);
        add_impulse(&moment->pushes[contact->a], problem, contact, push, contact->a, 1);
        add_impulse(&moment->pushes[contact->b], problem, contact, push, contact->b, 1);
    }
}

BodyVelocity pair_moment_others(const PairMoment *moment, const ContactProblem *problem, int first, int body) {
    BodyVelocity others = moment->pushes[body];
    for (int i = first, end = first + pair_contact_count(problem, first); i < end; i++)
        add_impulse(&others, problem, &problem->contacts[i], moment->alone[i], body, -1);
    return others;
}
