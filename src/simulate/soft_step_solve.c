/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The substeps of soft-step. */
#include "simulate/soft_step.h"
#include "sweeps/contact_velocity.h"

#include <math.h>

#define PUSH_OUT_SPEED 3.0f /* m/s, the limit of correction */

static void push(SoftBody *a, SoftBody *b, const SoftPoint *point, Vec2 impulse) {
    a->velocity = vec2_sub(a->velocity, vec2_scale(a->inv_mass, impulse));
    a->spin -= a->inv_inertia * vec2_cross(point->arm_a, impulse);
    b->velocity = vec2_add(b->velocity, vec2_scale(b->inv_mass, impulse));
    b->spin += b->inv_inertia * vec2_cross(point->arm_b, impulse);
}

static Vec2 relative_velocity(const SoftBody *a, const SoftBody *b, const SoftPoint *point) {
    Vec2 of_a = vec2_add(a->velocity, scalar_cross_vec2(a->spin, point->arm_a));
    Vec2 of_b = vec2_add(b->velocity, scalar_cross_vec2(b->spin, point->arm_b));
    return vec2_sub(of_b, of_a);
}

static Vec2 turned(Vec2 turn, Vec2 v) { return vec2(turn.x * v.x - turn.y * v.y, turn.y * v.x + turn.x * v.y); }

static float separation(const SoftBody *a, const SoftBody *b, const SoftPoint *point, Vec2 normal) {
    Vec2 arms = vec2_sub(turned(b->turn, point->arm_b), turned(a->turn, point->arm_a));
    return point->base + vec2_dot(vec2_add(vec2_sub(b->moved, a->moved), arms), normal);
}

/* Gravity and warm start of a substep. */
static void apply_forces(SoftStep *stepping, Vec2 fall) {
    for (int i = 0; i < stepping->body_count; i++)
        if (stepping->bodies[i].inv_mass > 0)
            stepping->bodies[i].velocity = vec2_add(stepping->bodies[i].velocity, fall);
    for (const SoftPair *pair = stepping->pairs; pair < stepping->pairs + stepping->pair_count; pair++) {
        Vec2 tangent = vec2_cross_scalar(pair->normal, 1.0f);
        for (SoftPoint *point = &stepping->points[pair->first]; point < &stepping->points[pair->first + pair->count];
             point++) {
            const ContactImpulse *impulse = &point->impulse;
            point->total.normal += impulse->normal;
            point->total.tangent += impulse->tangent;
            push(&stepping->bodies[pair->a], &stepping->bodies[pair->b], point,
                 vec2_add(vec2_scale(impulse->normal, pair->normal), vec2_scale(impulse->tangent, tangent)));
        }
    }
}

static void solve_normal(const SoftPair *pair, SoftPoint *point, SoftBody *a, SoftBody *b, const Softness *softness,
                         float inverse_h) {
    const float gap = separation(a, b, point, pair->normal);
    float bias = gap * inverse_h, mass_share = 1, impulse_share = 0;
    if (!(gap > 0)) {
        bias = contact_clamp(softness->bias_rate * gap, -PUSH_OUT_SPEED, 0);
        mass_share = softness->mass_share;
        impulse_share = softness->impulse_share;
    }
    float velocity = vec2_dot(relative_velocity(a, b, point), pair->normal), old = point->impulse.normal;
    float sum = old - point->mass_normal * (mass_share * velocity + bias) - impulse_share * old;
    point->impulse.normal = 0.0f > sum ? 0.0f : sum;
    point->total.normal += point->impulse.normal - old;
    push(a, b, point, vec2_scale(point->impulse.normal - old, pair->normal));
}

static void solve_friction(const SoftPair *pair, SoftPoint *point, SoftBody *a, SoftBody *b) {
    const Vec2 tangent = vec2_cross_scalar(pair->normal, 1.0f);
    float velocity = vec2_dot(relative_velocity(a, b, point), tangent), old = point->impulse.tangent;
    float most = pair->friction * point->impulse.normal;
    point->impulse.tangent = contact_clamp(old - point->mass_tangent * velocity, -most, most);
    point->total.tangent += point->impulse.tangent - old;
    push(a, b, point, vec2_scale(point->impulse.tangent - old, tangent));
}

/* One visit of all contacts; relaxing: without the springs, with friction. */
static void sweep(SoftStep *stepping, bool relaxing, float inverse_h) {
    static const Softness rigid = {1, 0, 0};
    for (const SoftPair *pair = stepping->pairs; pair < stepping->pairs + stepping->pair_count; pair++) {
        SoftPoint *points = &stepping->points[pair->first];
        SoftBody a = stepping->bodies[pair->a], b = stepping->bodies[pair->b];
        const Softness *softness = relaxing ? &rigid : pair->softness;
        for (int k = 0; k < pair->count; k++) solve_normal(pair, &points[k], &a, &b, softness, inverse_h);
        for (int k = 0; relaxing && k < pair->count; k++) solve_friction(pair, &points[k], &a, &b);
        stepping->bodies[pair->a] = a;
        stepping->bodies[pair->b] = b;
    }
}

/* The rotation by its tangent, scaled to length 1, as in Box2D: a cosine for each substep would cost more than its
   contacts. */
static void integrate(SoftStep *stepping, float h) {
    for (int i = 0; i < stepping->body_count; i++) {
        SoftBody *body = &stepping->bodies[i];
        BodyPose *pose = &stepping->poses[i];
        Vec2 way = vec2_scale(h, body->velocity);
        float angle = h * body->spin;
        Vec2 turn = vec2(body->turn.x - angle * body->turn.y, body->turn.y + angle * body->turn.x);
        body->turn = vec2_scale(1.0f / sqrtf(vec2_dot(turn, turn)), turn);
        body->moved = vec2_add(body->moved, way);
        pose->position = vec2_add(pose->position, way);
        pose->angle += angle;
    }
}

void soft_step_solve(SoftStep *stepping, Vec2 gravity, float dt) {
    const float h = dt / (float)stepping->substeps, inverse_h = 1.0f / h;
    for (int i = 0; i < stepping->substeps; i++) {
        apply_forces(stepping, vec2_scale(h, gravity));
        sweep(stepping, false, inverse_h);
        integrate(stepping, h);
        sweep(stepping, true, inverse_h);
    }
}
