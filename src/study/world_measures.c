/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/world_measures.h"

double world_energy(const World *world, Vec2 gravity) {
    const Body *bodies = world_bodies(world);
    double sum = 0;
    for (int i = 0; i < world_body_count(world); i++) {
        const Body *body = &bodies[i];
        if (body->inv_mass == 0) continue;
        double x = body->velocity.x, y = body->velocity.y, spin = body->angular_velocity;
        double potential = (double)gravity.x * body->position.x + (double)gravity.y * body->position.y;
        sum += (0.5 * (x * x + y * y) - potential) / body->inv_mass + 0.5 * spin * spin / body->inv_inertia;
    }
    return sum;
}

double world_penetration(const World *world) {
    const ContactProblem *problem = world_problem(world);
    double depth = 0;
    for (int i = 0; i < problem->contact_count; i++)
        if (-problem->contacts[i].separation > depth) depth = -problem->contacts[i].separation;
    return depth;
}
