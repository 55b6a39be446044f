/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/solution_error.h"

#include <math.h>
#include <stdbool.h>

/* |u - v|^2 with a weight for the spin's square. */
static double squared_distance(const ReferenceVelocity *u, const ReferenceVelocity *v, double spin_weight) {
    double x = u->x - v->x, y = u->y - v->y, spin = u->spin - v->spin;
    return x * x + y * y + spin_weight * (spin * spin);
}

static double larger(double x, double y) { return x > y ? x : y; }

static bool is_right(const ReferenceVelocity *found, const ReferenceVelocity *reference,
                     const ReferenceVelocity *freely) {
    const double least = 0.05 * 0.05, part = 0.05 * 0.05, half_spin = 0.25;
    double allowed = larger(least, part * squared_distance(reference, freely, half_spin));
    return squared_distance(found, reference, half_spin) <= allowed;
}

SolutionError solution_error(const ContactProblem *problem, const BodyVelocity *velocities,
                             const ReferenceVelocity *reference) {
    SolutionError error = {.worst = -1};
    double sum = 0, most = -1;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        if (body->inv_mass == 0.0f) continue;
        ReferenceVelocity freely = {(double)body->velocity.x, (double)body->velocity.y, (double)body->angular_velocity};
        ReferenceVelocity found = {(double)velocities[i].linear.x, (double)velocities[i].linear.y,
                                   (double)velocities[i].angular};
        const double square = squared_distance(&found, &reference[i], 1.0 / 6.0);
        sum += square;
        if (!(square <= most)) { /* NaN is worst */
            most = square;
            error.worst = i;
        }
        error.right += is_right(&found, &reference[i], &freely);
        error.counted++;
    }
    if (error.counted > 0) error.rms = isnan(sum) ? INFINITY : sqrt(sum / error.counted);
    return error;
}
