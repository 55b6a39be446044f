/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/world_measures.h"

double body_energy(const Body *body, Vec2 gravity) {
    if (body->inv_mass == 0) return 0;
    double x = body->velocity.x, y = body->velocity.y, spin = body->angular_velocity;
    double potential = (double)gravity.x * body->position.x + (double)gravity.y * body->position.y;
    return (0.5 * (x * x + y * y) - potential) / body->inv_mass + 0.5 * spin * spin / body->inv_inertia;
}

double bodies_energy(const Body *bodies, int count, Vec2 gravity) {
    double sum = 0;
    for (int i = 0; i < count; i++) sum += body_energy(&bodies[i], gravity);
    return sum;
}

double world_energy(const World *world, Vec2 gravity) {
    return bodies_energy(world_bodies(world), world_body_count(world), gravity);
}

double world_penetration(const World *world) {
    const ContactProblem *problem = world_problem(world);
    double depth = 0;
    for (int i = 0; i < problem->contact_count; i++)
        if (-problem->contacts[i].separation > depth) depth = -problem->contacts[i].separation;
    return depth;
}
