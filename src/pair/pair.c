/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pair/pair.h"

#include <string.h>

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

static float *put_point(float *to, const ContactProblem *problem, const PairMoment *now, int i, float inverse_mass) {
    const ContactPoint *contact = &problem->contacts[i];
    const ContactImpulse so_far = now->impulses[i];
    to = put(to, pair_point_velocity(contact, &now->velocities[contact->a], &now->velocities[contact->b]));
    *to++ = contact->bias;
    to = put(to, vec2_scale(inverse_mass, vec2(so_far.normal, so_far.tangent)));
    to = put(to, in_contact_frame(contact, contact->arm_a));
    return put(to, in_contact_frame(contact, contact->arm_b));
}

static float *contact_inputs(const ContactProblem *problem, const PairMoment *now, int first, float *inputs) {
    enum { EACH = 9 };
    const int count = pair_contact_count(problem, first);
    const float inverse_mass = pair_inverse_mass(problem, first);
    for (int i = 0; i < PAIR_POINTS; i++) {
        if (i < count)
            inputs = put_point(inputs, problem, now, first + i, inverse_mass);
        else
            for (int k = 0; k < EACH; k++) *inputs++ = 0;
    }
    *inputs++ = problem->bodies[problem->contacts[first].a].inv_mass / inverse_mass;
    *inputs++ = count > 1 ? 1.0f : 0.0f;
    return inputs;
}

static float *put_velocity(float *to, const ContactPoint *contact, BodyVelocity velocity) {
    to = put(to, in_contact_frame(contact, velocity.linear));
    *to++ = velocity.angular;
    return to;
}

static float *neighbour_inputs(const ContactProblem *problem, const PairMoment *now, int first, float *inputs) {
    const ContactPoint *contact = &problem->contacts[first];
    const int bodies[2] = {contact->a, contact->b};
    for (int k = 0; k < 2; k++)
        inputs = put_velocity(inputs, contact, pair_moment_others(now, problem, first, bodies[k]));
    for (int k = 0; k < 2; k++) {
        const ProblemBody *before = &problem->bodies[bodies[k]];
        const BodyVelocity *after = &now->velocities[bodies[k]];
        BodyVelocity done = {vec2_sub(after->linear, before->velocity), after->angular - before->angular_velocity};
        inputs = put_velocity(inputs, contact, done);
    }
    return inputs;
}

void pair_inputs(const ContactProblem *problem, const PairMoment *now, int first, PairView view, float *inputs) {
    if (pair_views[view].by_contact) {
        inputs = contact_inputs(problem, now, first, inputs);
        if (view == PAIR_NEIGHBOURS) neighbour_inputs(problem, now, first, inputs);
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
