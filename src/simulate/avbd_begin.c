/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The start of a step of avbd: where bodies and contacts begin, with what forces and penalties. */
#include "common/array.h"
#include "simulate/avbd.h"
#include "sweeps/contact_velocity.h"

#define COLLISION_MARGIN 0.0005f /* m, overlap at rest */

static bool reserve(Avbd *avbd, const ContactProblem *problem) {
    size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    return array_reserve((void **)&avbd->bodies, &avbd->body_capacity, bodies, sizeof *avbd->bodies) &&
           array_reserve((void **)&avbd->rotations, &avbd->rotation_capacity, bodies, sizeof *avbd->rotations) &&
           array_reserve((void **)&avbd->poses, &avbd->pose_capacity, bodies, sizeof *avbd->poses) &&
           array_reserve((void **)&avbd->before, &avbd->before_capacity, bodies, sizeof *avbd->before) &&
           array_reserve((void **)&avbd->contacts, &avbd->contact_capacity, contacts, sizeof *avbd->contacts) &&
           array_reserve((void **)&avbd->last, &avbd->last_capacity, contacts, sizeof *avbd->last) &&
           array_reserve((void **)&avbd->visits, &avbd->visit_capacity, 2 * contacts, sizeof *avbd->visits);
}

/* The share of gravity that the last step's acceleration had: 0 at rest, 1 in free fall. */
static float falling(const Avbd *avbd, const Body *body, int i, Vec2 gravity, float dt) {
    float square = vec2_dot(gravity, gravity);
    if (!avbd->memory.known[i] || !(square > 0)) return 0;
    Vec2 acceleration = vec2_scale(1.0f / dt, vec2_sub(body->velocity, avbd->before[i]));
    return contact_clamp(vec2_dot(acceleration, gravity) / square, 0, 1);
}

/* A body begins where it would be if its contacts gave it the acceleration of the last step. */
static void begin_body(Avbd *avbd, const Body *body, int i, Vec2 gravity, float dt) {
    avbd->poses[i] = (BodyPose){body->position, body->angle};
    avbd->rotations[i] = mat22_rotation(body->angle);
    avbd->bodies[i] = (AvbdBody){0};
    if (!(body->inv_mass > 0)) return;
    const Vec2 way = vec2_scale(dt, body->velocity), fall = vec2_scale(dt * dt, gravity);
    const Vec2 guess = vec2_add(way, vec2_scale(falling(avbd, body, i, gravity, dt), fall));
    const float turn = dt * body->angular_velocity, inverse = 1.0f / (dt * dt);
    avbd->bodies[i] = (AvbdBody){.moved = {guess.x, guess.y, turn},
                                 .free = {way.x + fall.x, way.y + fall.y, turn},
                                 .start = body->velocity,
                                 .mass = inverse / body->inv_mass,
                                 .inertia = inverse / body->inv_inertia};
}

static AvbdRow make_row(Vec2 axis, Vec2 arm_a, Vec2 arm_b, float start) {
    return (AvbdRow){.of_a = {-axis.x, -axis.y, -vec2_cross(arm_a, axis)},
                     .of_b = {axis.x, axis.y, vec2_cross(arm_b, axis)},
                     .start = start};
}

/* A contact that was there begins with the penalty that it had; a new one with the smallest. In a step of unknown past,
   only the impulse tells which it is: then the penalty is that at which a pass moves as far as a rigid contact would. */
static float first_penalty(const Avbd *avbd, const AvbdRow *last, bool loaded, float mass, float dt) {
    float penalty = last != NULL ? avbd->gamma * last->penalty : loaded ? mass / (dt * dt) : 0;
    return contact_clamp(penalty, AVBD_PENALTY_MIN, AVBD_PENALTY_MAX);
}

/* Multipliers are the world's impulses, so that a copy of a world has them. */
static void warm_start(const Avbd *avbd, AvbdContact *contact, const ContactPoint *point, const AvbdContact *last,
                       float dt) {
    const float decay = avbd->alpha < 0 ? 1.0f : avbd->alpha * avbd->gamma;
    const bool loaded = point->warm_normal > 0;
    AvbdRow *normal = &contact->normal, *tangent = &contact->tangent;
    normal->force = decay * point->warm_normal / dt;
    tangent->force = decay * point->warm_tangent / dt;
    normal->penalty = first_penalty(avbd, last != NULL ? &last->normal : NULL, loaded, point->mass_normal, dt);
    tangent->penalty = first_penalty(avbd, last != NULL ? &last->tangent : NULL, loaded, point->mass_tangent, dt);
}

static void begin_contact(Avbd *avbd, const ContactPoint *point, int i, float dt) {
    const int before = avbd->memory.before[i];
    const AvbdContact *last = before >= 0 ? &avbd->last[before] : NULL;
    const Mat22 *of_a = &avbd->rotations[point->a], *of_b = &avbd->rotations[point->b];
    AvbdContact contact = {.a = point->a, .b = point->b, .friction = point->friction};
    if (last != NULL && last->sticks) {
        contact.point_a = last->point_a;
        contact.point_b = last->point_b;
    } else {
        Vec2 overlap = vec2_scale(point->separation, point->normal);
        contact.point_a = mat22_multiply(mat22_transpose(*of_a), point->arm_a);
        contact.point_b = mat22_multiply(mat22_transpose(*of_b), vec2_add(point->arm_b, overlap));
    }
    Vec2 arm_a = mat22_multiply(*of_a, contact.point_a), arm_b = mat22_multiply(*of_b, contact.point_b);
    Vec2 centres = vec2_sub(avbd->poses[point->b].position, avbd->poses[point->a].position);
    Vec2 gap = vec2_add(centres, vec2_sub(arm_b, arm_a)), tangent = vec2_cross_scalar(point->normal, 1.0f);
    contact.normal = make_row(point->normal, arm_a, arm_b, vec2_dot(gap, point->normal) + COLLISION_MARGIN);
    contact.tangent = make_row(tangent, arm_a, arm_b, vec2_dot(gap, tangent));
    warm_start(avbd, &contact, point, last, dt);
    avbd->contacts[i] = contact;
}

/* The contacts of each body, in their order. */
static void list_visits(Avbd *avbd) {
    for (int i = 0; i < avbd->contact_count; i++) {
        avbd->bodies[avbd->contacts[i].a].count++;
        avbd->bodies[avbd->contacts[i].b].count++;
    }
    for (int i = 0, first = 0; i < avbd->body_count; i++) {
        avbd->bodies[i].first = first;
        first += avbd->bodies[i].count;
        avbd->bodies[i].count = 0;
    }
    for (int i = 0; i < avbd->contact_count; i++) {
        AvbdBody *a = &avbd->bodies[avbd->contacts[i].a], *b = &avbd->bodies[avbd->contacts[i].b];
        avbd->visits[a->first + a->count++] = i;
        avbd->visits[b->first + b->count++] = i;
    }
}

bool avbd_begin(Avbd *avbd, const World *world, const ContactProblem *problem, const Step *step) {
    if (!step_memory_match(&avbd->memory, world, step) || !reserve(avbd, problem)) return false;
    avbd->body_count = problem->body_count;
    avbd->contact_count = problem->contact_count;
    for (int i = 0; i < avbd->body_count; i++)
        begin_body(avbd, &world_bodies(world)[i], i, step->scene->gravity, problem->dt);
    for (int i = 0; i < avbd->contact_count; i++) begin_contact(avbd, &problem->contacts[i], i, problem->dt);
    list_visits(avbd);
    return true;
}
