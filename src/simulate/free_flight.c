/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "simulate/free_flight.h"

#include <math.h>
#include <string.h>

float free_flight_momentum(const ContactProblem *problem, const ContactSolution *solution, bool *touched) {
    float sum = 0;
    memset(touched, 0, (size_t)problem->body_count * sizeof *touched);
    for (int i = 0; i < problem->contact_count; i++)
        touched[problem->contacts[i].a] = touched[problem->contacts[i].b] = true;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        if (touched[i] || body->inv_mass == 0) continue;
        const Vec2 change = vec2_sub(solution->velocities[i].linear, body->velocity);
        sum += sqrtf(vec2_dot(change, change)) / body->inv_mass;
    }
    return sum;
}
