/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference's path for the method interior, on a copy of the problem whose speeds are multiplied by a power of two,
   so that the fastest is 4 to 8 m/s: the reference has limits in m/s. */
#include "methods/interior_path.h"

#include "base/base.h"
#include "engine/engine.h"
#include "methods/interior_point_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void interior_path_free(InteriorPath *path) {
    reference_free(&path->reference);
    free(path->copy.memory);
}

bool interior_path_reserve(InteriorPath *path, const ContactProblem *problem) {
    if (problem->body_count <= path->room_bodies && problem->contact_count <= path->room_contacts) return true;
    if (problem->body_count > path->room_bodies) path->room_bodies = problem->body_count;
    if (problem->contact_count > path->room_contacts) path->room_contacts = problem->contact_count;
    return ARRAY_BLOCK_RESERVE(&path->copy, ARRAY_PART(path->bodies, path->room_bodies),
                               ARRAY_PART(path->contacts, path->room_contacts)) &&
           reference_reserve(&path->reference, problem);
}

static float power_for(double speed) {
    int exponent = 3;
    if (speed > 0 && speed < INFINITY) frexp(speed, &exponent);
    return ldexpf(1, 3 - exponent);
}

static ContactProblem copy_of(InteriorPath *path, const ContactProblem *problem) {
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count;
    memcpy(path->bodies, problem->bodies, bodies * sizeof *path->bodies);
    memcpy(path->contacts, problem->contacts, contacts * sizeof *path->contacts);
    for (size_t i = 0; i < bodies; i++) {
        path->bodies[i].velocity = vec2_scale(path->factor, path->bodies[i].velocity);
        path->bodies[i].angular_velocity *= path->factor;
    }
    for (size_t i = 0; i < contacts; i++) {
        path->contacts[i].bias *= path->factor;
        path->contacts[i].warm_normal *= path->factor;
        path->contacts[i].warm_tangent *= path->factor;
    }
    ContactProblem copy = *problem;
    copy.bodies = path->bodies;
    copy.contacts = path->contacts;
    return copy;
}

bool interior_path_follow(InteriorPath *path, const ContactProblem *problem, double speed, double near, int most,
                          Error *error) {
    Reference *reference = &path->reference;
    path->factor = power_for(speed);
    if (!interior_path_reserve(path, problem)) return error_memory(error, "interior");
    const double factor = (double)path->factor, held = interior_most_held(speed * factor);
    const ContactProblem copy = copy_of(path, problem);
    if (!reference_solve_to(reference, &copy, factor * near, most, error)) return false;
    path->residual = reference->residual / factor;
    for (int i = 0; i < problem->contact_count; i++)
        if (!(reference->impulses[i].normal <= held * (double)problem->contacts[i].mass_normal))
            path->residual = INFINITY;
    return true;
}

void interior_path_take(const InteriorPath *path, const ContactProblem *problem, ContactSolution *solution) {
    const float factor = path->factor;
    reference_round(&path->reference, problem, solution);
    for (int i = 0; i < problem->body_count; i++) {
        BodyVelocity *velocity = &solution->velocities[i];
        *velocity = (BodyVelocity){vec2_scale(1 / factor, velocity->linear), velocity->angular / factor};
    }
    for (int i = 0; i < problem->contact_count; i++) {
        ContactImpulse *impulse = &solution->impulses[i];
        const float limit = problem->contacts[i].friction * impulse->normal;
        impulse->tangent = contact_clamp(impulse->tangent, -limit, limit) / factor;
        impulse->normal /= factor;
    }
}
