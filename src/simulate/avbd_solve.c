/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The passes of avbd over all bodies. */
#include "simulate/avbd.h"
#include "sweeps/contact_velocity.h"

#include <math.h>

#define STICK_DISTANCE 0.01f /* m, by which points that stick may slide */

static float dot(const Vec3 *a, const Vec3 *b) { return a->x * b->x + a->y * b->y + a->turn * b->turn; }

/* The gap, with this share of what it was at the start. */
static float gap(const Avbd *avbd, const AvbdContact *contact, const AvbdRow *row, float share) {
    return share * row->start + dot(&row->of_a, &avbd->bodies[contact->a].moved) +
           dot(&row->of_b, &avbd->bodies[contact->b].moved);
}

static float normal_force(const AvbdRow *row, float gap) {
    float force = row->force - row->penalty * gap;
    return 0.0f > force ? 0.0f : force;
}

static float tangent_force(const AvbdRow *row, float gap, float most) {
    return contact_clamp(row->force - row->penalty * gap, -most, most);
}

/* The symmetric system of a body: rows of the lower triangle and the right-hand side. */
typedef struct System {
    float xx, yx, yy, tx, ty, tt;
    Vec3 right;
} System;

static void add_row(System *system, const Vec3 *j, float penalty, float force) {
    const Vec3 scaled = {penalty * j->x, penalty * j->y, penalty * j->turn};
    system->xx += scaled.x * j->x;
    system->yx += scaled.y * j->x;
    system->yy += scaled.y * j->y;
    system->tx += scaled.turn * j->x;
    system->ty += scaled.turn * j->y;
    system->tt += scaled.turn * j->turn;
    system->right.x += force * j->x;
    system->right.y += force * j->y;
    system->right.turn += force * j->turn;
}

/* By its factors L D L^T. */
static Vec3 solved(const System *system) {
    const float d1 = system->xx, l21 = system->yx / d1, l31 = system->tx / d1;
    const float d2 = system->yy - l21 * l21 * d1, l32 = (system->ty - l21 * l31 * d1) / d2;
    const float d3 = system->tt - l31 * l31 * d1 - l32 * l32 * d2;
    const float y1 = system->right.x, y2 = system->right.y - l21 * y1, y3 = system->right.turn - l31 * y1 - l32 * y2;
    const float turn = y3 / d3, y = y2 / d2 - l32 * turn, x = y1 / d1 - l21 * y - l31 * turn;
    return (Vec3){x, y, turn};
}

static void visit_body(Avbd *avbd, int i, float share) {
    AvbdBody *body = &avbd->bodies[i];
    System system = {.xx = body->mass, .yy = body->mass, .tt = body->inertia};
    system.right = (Vec3){body->mass * (body->free.x - body->moved.x), body->mass * (body->free.y - body->moved.y),
                          body->inertia * (body->free.turn - body->moved.turn)};
    for (int v = body->first; v < body->first + body->count; v++) {
        const AvbdContact *contact = &avbd->contacts[avbd->visits[v]];
        const AvbdRow *normal = &contact->normal, *tangent = &contact->tangent;
        const bool is_a = contact->a == i;
        const float most = contact->friction * normal->force;
        add_row(&system, is_a ? &normal->of_a : &normal->of_b, normal->penalty,
                normal_force(normal, gap(avbd, contact, normal, share)));
        add_row(&system, is_a ? &tangent->of_a : &tangent->of_b, tangent->penalty,
                tangent_force(tangent, gap(avbd, contact, tangent, share), most));
    }
    const Vec3 change = solved(&system);
    body->moved = (Vec3){body->moved.x + change.x, body->moved.y + change.y, body->moved.turn + change.turn};
}

/* From the last body to the first, as the 2D program does: gravity enters a stack at its top. */
static void visit_bodies(Avbd *avbd, float share) {
    for (int i = avbd->body_count - 1; i >= 0; i--)
        if (avbd->bodies[i].mass > 0) visit_body(avbd, i, share);
}

static void raise_penalty(const Avbd *avbd, AvbdRow *row, float gap) {
    row->penalty = contact_clamp(row->penalty + avbd->beta * fabsf(gap), AVBD_PENALTY_MIN, AVBD_PENALTY_MAX);
}

/* The friction bound is that of the normal force before this update, as in the visits. */
static void update_multipliers(Avbd *avbd, float share) {
    for (int i = 0; i < avbd->contact_count; i++) {
        AvbdContact *contact = &avbd->contacts[i];
        AvbdRow *normal = &contact->normal, *tangent = &contact->tangent;
        const float most = contact->friction * normal->force;
        const float apart = gap(avbd, contact, normal, share), slid = gap(avbd, contact, tangent, share);
        normal->force = normal_force(normal, apart);
        tangent->force = tangent_force(tangent, slid, most);
        if (normal->force > 0) raise_penalty(avbd, normal, apart);
        if (fabsf(tangent->force) < most) raise_penalty(avbd, tangent, slid);
        contact->sticks =
            fabsf(tangent->force) < contact->friction * normal->force && fabsf(tangent->start) < STICK_DISTANCE;
    }
}

/* The velocities of the solution come from the displacements before the pass that only moves bodies out. */
void avbd_solve(Avbd *avbd, const Step *step, const ContactProblem *problem, ContactSolution *solution) {
    const bool correct = step->scene->position_correction, stabilize = avbd->alpha < 0 && correct;
    const float share = avbd->alpha < 0 || !correct ? 0.0f : 1.0f - avbd->alpha, inverse_dt = 1.0f / problem->dt;
    for (int k = 0; k < avbd->iterations; k++) {
        visit_bodies(avbd, share);
        update_multipliers(avbd, share);
    }
    for (int i = 0; i < avbd->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        const Vec3 *moved = &avbd->bodies[i].moved;
        solution->velocities[i] =
            (BodyVelocity){vec2_scale(inverse_dt, vec2(moved->x, moved->y)), inverse_dt * moved->turn};
        if (!(body->inv_mass > 0)) solution->velocities[i] = (BodyVelocity){body->velocity, body->angular_velocity};
    }
    if (stabilize) visit_bodies(avbd, 1);
}
