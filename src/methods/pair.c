/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a network sees of a pair (methods/pair.h). */
#include "methods/pair.h"

#include "base/base.h"
#include "engine/engine.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

void pair_moment_free(PairMoment *moment) {
    free(moment->arrays.memory);
    *moment = (PairMoment){0};
}

bool pair_moment_reserve(PairMoment *moment, const ContactProblem *problem) {
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count + 1;
    return ARRAY_BLOCK_RESERVE(&moment->arrays, ARRAY_PART(moment->velocities, bodies),
                               ARRAY_PART(moment->impulses, contacts), ARRAY_PART(moment->alone, contacts),
                               ARRAY_PART(moment->pushes, bodies));
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

void pair_moment_jacobi(PairMoment *moment, const ContactProblem *problem) {
    memset(moment->pushes, 0, (size_t)problem->body_count * sizeof *moment->pushes);
    for (int i = 0; i < problem->contact_count; i++) {
        /* The impulses of one visit of this contact, less those so far. */
        const ContactPoint *contact = &problem->contacts[i];
        const ContactImpulse so_far = moment->impulses[i];
        const Vec2 velocity =
            pair_point_velocity(contact, &moment->velocities[contact->a], &moment->velocities[contact->b]);
        float normal = so_far.normal - contact->mass_normal * (velocity.x - contact->bias);
        normal = normal > 0 ? normal : 0;
        const float most = contact->friction * normal, wanted = so_far.tangent - contact->mass_tangent * velocity.y;
        const float tangent = wanted < -most ? -most : wanted > most ? most : wanted;
        const ContactImpulse push = {normal - so_far.normal, tangent - so_far.tangent};
        moment->alone[i] = push;
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

const PairViewInfo pair_views[PAIR_VIEWS] = {
    [PAIR_RELATIVE] = {"relative", 10, false, "dx dy vxa vya vxb vyb wa wb angle_a angle_b"},
    [PAIR_RAW] = {"raw", 12, false, "xa ya xb yb vxa vya vxb vyb wa wb angle_a angle_b"},
    [PAIR_RAW_UNTURNED] = {"raw-unturned", 10, false, "xa ya xb yb vxa vya vxb vyb wa wb"},
    [PAIR_CONTACT] = {"contact", 20, true,
                      "vn1 vt1 bias1 pn1 pt1 arm_an1 arm_at1 arm_bn1 arm_bt1 "
                      "vn2 vt2 bias2 pn2 pt2 arm_an2 arm_at2 arm_bn2 arm_bt2 share_a second"},
    [PAIR_NEIGHBOURS] = {"neighbours", 32, true,
                         "vn1 vt1 bias1 pn1 pt1 arm_an1 arm_at1 arm_bn1 arm_bt1 "
                         "vn2 vt2 bias2 pn2 pt2 arm_an2 arm_at2 arm_bn2 arm_bt2 share_a second "
                         "next_an next_at next_aw next_bn next_bt next_bw "
                         "done_an done_at done_aw done_bn done_bt done_bw"}};

bool pair_view_of_inputs(const char *inputs, PairView *view) {
    for (PairView v = 0; v < PAIR_VIEWS; v++) {
        if (strcmp(pair_views[v].inputs, inputs) != 0) continue;
        *view = v;
        return true;
    }
    return false;
}

static Vec2 in_contact_frame(const ContactPoint *contact, Vec2 v) {
    return vec2(vec2_dot(v, contact->normal), vec2_dot(v, vec2_cross_scalar(contact->normal, 1.0f)));
}

static float *put(float *to, Vec2 v) {
    *to++ = v.x;
    *to++ = v.y;
    return to;
}

static BodyVelocity velocity_now(const ContactProblem *problem, const PairMoment *now, int body) {
    if (now != NULL) return now->velocities[body];
    return (BodyVelocity){problem->bodies[body].velocity, problem->bodies[body].angular_velocity};
}

float pair_inverse_mass(const ContactProblem *problem, int first) {
    const ContactPoint *contact = &problem->contacts[first];
    return problem->bodies[contact->a].inv_mass + problem->bodies[contact->b].inv_mass;
}

Vec2 pair_point_velocity(const ContactPoint *contact, const BodyVelocity *a, const BodyVelocity *b) {
    Vec2 of_b = vec2_add(b->linear, scalar_cross_vec2(b->angular, contact->arm_b));
    Vec2 of_a = vec2_add(a->linear, scalar_cross_vec2(a->angular, contact->arm_a));
    return in_contact_frame(contact, vec2_sub(of_b, of_a));
}

static float *put_contact_inputs(float *to, const ContactProblem *problem, const PairMoment *now, int first) {
    enum { EACH = 9 };
    const int count = pair_contact_count(problem, first);
    const float inverse_mass = pair_inverse_mass(problem, first);
    for (int i = first; i < first + PAIR_POINTS; i++) {
        if (i >= first + count) {
            for (int k = 0; k < EACH; k++) *to++ = 0;
            continue;
        }
        const ContactPoint *contact = &problem->contacts[i];
        const ContactImpulse so_far = now->impulses[i];
        to = put(to, pair_point_velocity(contact, &now->velocities[contact->a], &now->velocities[contact->b]));
        *to++ = contact->bias;
        to = put(to, vec2_scale(inverse_mass, vec2(so_far.normal, so_far.tangent)));
        to = put(to, in_contact_frame(contact, contact->arm_a));
        to = put(to, in_contact_frame(contact, contact->arm_b));
    }
    *to++ = problem->bodies[problem->contacts[first].a].inv_mass / inverse_mass;
    *to++ = count > 1 ? 1.0f : 0.0f;
    return to;
}

static float *put_velocity(float *to, const ContactPoint *contact, BodyVelocity velocity) {
    to = put(to, in_contact_frame(contact, velocity.linear));
    *to++ = velocity.angular;
    return to;
}

void pair_inputs(const ContactProblem *problem, const PairMoment *now, int first, PairView view, float *inputs) {
    if (pair_views[view].by_contact) {
        inputs = put_contact_inputs(inputs, problem, now, first);
        const ContactPoint *contact = &problem->contacts[first];
        const int bodies[2] = {contact->a, contact->b};
        for (int k = 0; k < 2 && view == PAIR_NEIGHBOURS; k++)
            inputs = put_velocity(inputs, contact, pair_moment_others(now, problem, first, bodies[k]));
        for (int k = 0; k < 2 && view == PAIR_NEIGHBOURS; k++) {
            const ProblemBody *before = &problem->bodies[bodies[k]];
            const BodyVelocity *after = &now->velocities[bodies[k]];
            const BodyVelocity done = {vec2_sub(after->linear, before->velocity),
                                       after->angular - before->angular_velocity};
            inputs = put_velocity(inputs, contact, done);
        }
        return;
    }
    const int a = problem->contacts[first].a, b = problem->contacts[first].b;
    const ProblemBody *body_a = &problem->bodies[a], *body_b = &problem->bodies[b];
    const BodyVelocity of_a = velocity_now(problem, now, a), of_b = velocity_now(problem, now, b);
    if (view == PAIR_RELATIVE)
        inputs = put(inputs, vec2_sub(body_b->position, body_a->position));
    else
        inputs = put(put(inputs, body_a->position), body_b->position);
    inputs = put(put(inputs, of_a.linear), of_b.linear);
    inputs = put(inputs, vec2(of_a.angular, of_b.angular));
    if (view != PAIR_RAW_UNTURNED) put(inputs, vec2(body_a->angle, body_b->angle));
}

int pair_contact_count(const ContactProblem *problem, int first) {
    const ContactPoint *contacts = problem->contacts;
    int end = first + 1;
    while (end < problem->contact_count && contacts[end].a == contacts[first].a && contacts[end].b == contacts[first].b)
        end++;
    return end - first;
}

const char *const pair_target_names[PAIR_TARGETS + 1] = {"pair", "net", "impulse", "points"};

int pair_change_count(PairTarget target) { return target == TARGET_POINTS ? PAIR_POINT_CHANGES : PAIR_CHANGES; }

const char *pair_output_names(PairView view, PairTarget target, int outputs) {
    bool by_contact = pair_views[view].by_contact;
    if (target == TARGET_POINTS) return by_contact && outputs == PAIR_POINT_CHANGES ? "dpn1 dpt1 dpn2 dpt2" : NULL;
    if (outputs == 2) return by_contact ? "dvn dvt" : "dvx dvy";
    if (outputs == PAIR_CHANGES) return by_contact ? "dvna dvta dwa dvnb dvtb dwb" : "dvxa dvya dwa dvxb dvyb dwb";
    return NULL;
}

static Vec2 in_world(const ContactPoint *contact, Vec2 v) {
    return vec2_add(vec2_scale(v.x, contact->normal), vec2_scale(v.y, vec2_cross_scalar(contact->normal, 1.0f)));
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

void pair_step_changes(const ContactProblem *problem, const ContactSolution *solution, int first, PairView view,
                       PairTarget target, float changes[PAIR_CHANGES]) {
    const ContactPoint *contact = &problem->contacts[first];
    if (target == TARGET_POINTS) {
        pair_point_changes(problem, solution->impulses, first, changes);
        return;
    }
    if (target == TARGET_NET) {
        for (int k = 0; k < 2; k++) {
            const int body = k == 0 ? contact->a : contact->b;
            const ProblemBody *before = &problem->bodies[body];
            const BodyVelocity *after = &solution->velocities[body];
            float *change = put(changes + 3 * k, vec2_sub(after->linear, before->velocity));
            *change = after->angular - before->angular_velocity;
        }
    } else {
        pair_changes(problem, solution, first, pair_contact_count(problem, first), changes);
    }
    if (pair_views[view].by_contact) pair_to_contact_frame(contact, changes);
}

void pair_context(const ContactProblem *problem, int first, float context[PAIR_CONTEXT]) {
    const ContactPoint *contact = &problem->contacts[first];
    const ProblemBody *a = &problem->bodies[contact->a], *b = &problem->bodies[contact->b];
    const int count = pair_contact_count(problem, first);
    Vec2 arm_a = vec2(0, 0), arm_b = vec2(0, 0);
    for (int i = 0; i < count; i++) {
        arm_a = vec2_add(arm_a, contact[i].arm_a);
        arm_b = vec2_add(arm_b, contact[i].arm_b);
    }
    context[CONTEXT_INV_MASS_A] = a->inv_mass;
    context[CONTEXT_INV_INERTIA_A] = a->inv_inertia;
    context[CONTEXT_INV_MASS_B] = b->inv_mass;
    context[CONTEXT_INV_INERTIA_B] = b->inv_inertia;
    put(context + CONTEXT_NORMAL, contact->normal);
    context[CONTEXT_FRICTION] = contact->friction;
    put(context + CONTEXT_ARM_A, vec2_scale(1.0f / (float)count, arm_a));
    put(context + CONTEXT_ARM_B, vec2_scale(1.0f / (float)count, arm_b));
    *put(context + CONTEXT_VELOCITIES, a->velocity) = a->angular_velocity;
    *put(context + CONTEXT_VELOCITIES + 3, b->velocity) = b->angular_velocity;
}

const char *pair_context_fault(const float context[PAIR_CONTEXT]) {
    static const float unit_tolerance = 1e-3f; /* of a normal's squared length */
    const Vec2 normal = vec2(context[CONTEXT_NORMAL], context[CONTEXT_NORMAL + 1]);
    for (int i = CONTEXT_INV_MASS_A; i <= CONTEXT_INV_INERTIA_B; i++)
        if (context[i] < 0) return "an inverse mass or inertia below 0";
    if (context[CONTEXT_INV_MASS_A] == 0 && context[CONTEXT_INV_MASS_B] == 0) return "two static bodies";
    if (!(fabsf(vec2_dot(normal, normal) - 1) <= unit_tolerance)) return "a normal whose length is not 1";
    if (context[CONTEXT_FRICTION] < 0) return "friction below 0";
    return NULL;
}
