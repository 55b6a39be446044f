/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Converts impulses and velocities to the units of the reference's sweeps, and back. */
#include "reference/reference_units.h"

#include <string.h>

static void add_impulse(ReferenceVelocity *velocity, const ProblemBody *body, Vec2 arm, double x, double y) {
    velocity->x += (double)body->inv_mass * x;
    velocity->y += (double)body->inv_mass * y;
    velocity->spin += (double)body->inv_inertia * ((double)arm.x * y - (double)arm.y * x);
}

/* The velocities for given impulses, in the problem's units and order. */
static void apply_impulses(Reference *r, const ContactProblem *problem) {
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        r->velocities[i] =
            (ReferenceVelocity){(double)body->velocity.x, (double)body->velocity.y, (double)body->angular_velocity};
    }
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        double normal = r->impulses[i].normal, tangent = r->impulses[i].tangent;
        double x = (double)contact->normal.x * normal + (double)contact->normal.y * tangent;
        double y = (double)contact->normal.y * normal - (double)contact->normal.x * tangent;
        add_impulse(&r->velocities[contact->a], &problem->bodies[contact->a], contact->arm_a, -x, -y);
        add_impulse(&r->velocities[contact->b], &problem->bodies[contact->b], contact->arm_b, x, y);
    }
}

static double scaled(double velocity, float inverse) { return inverse != 0.0f ? velocity / sqrt((double)inverse) : 0; }

static void start_momenta(Reference *r, const ContactProblem *problem) {
    size_t size = ((size_t)problem->body_count + 1) * sizeof *r->momenta;
    memset(r->momenta, 0, size);
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        const ReferenceVelocity *velocity = &r->velocities[i];
        r->momenta[i].x = scaled(velocity->x, body->inv_mass);
        r->momenta[i].y = scaled(velocity->y, body->inv_mass);
        r->momenta[i].spin = scaled(velocity->spin, body->inv_inertia);
    }
    memcpy(r->momenta_before, r->momenta, size);
    memset(r->momenta_direction, 0, size);
}

/* Copies one point of a group's pairs from the impulses of the problem, or back. */
static void start_point(Reference *r, const ContactProblem *problem, int i, int k) {
    for (int lane = 0; lane < REFERENCE_LANES; lane++) {
        int contact = r->groups[i].contacts[k][lane];
        if (contact < 0) continue;
        ReferenceImpulse scale = reference_scale(&problem->contacts[contact]);
        r->sums[i].rows[2 * k][lane] = r->impulses[contact].normal / scale.normal;
        r->sums[i].rows[2 * k + 1][lane] = r->impulses[contact].tangent / scale.tangent;
    }
}

static void store_point(Reference *r, const ContactProblem *problem, int i, int k) {
    for (int lane = 0; lane < REFERENCE_LANES; lane++) {
        int contact = r->groups[i].contacts[k][lane];
        if (contact < 0) continue;
        ReferenceImpulse scale = reference_scale(&problem->contacts[contact]);
        r->impulses[contact].normal = r->sums[i].rows[2 * k][lane] * scale.normal;
        r->impulses[contact].tangent = r->sums[i].rows[2 * k + 1][lane] * scale.tangent;
    }
}

static void start_sums(Reference *r, const ContactProblem *problem) {
    size_t size = (size_t)r->group_count * sizeof *r->sums;
    memset(r->sums, 0, size);
    memset(r->steps, 0, size);
    memset(r->direction, 0, size);
    for (int i = 0; i < r->group_count; i++)
        for (int k = 0; k < REFERENCE_POINTS; k++) start_point(r, problem, i, k);
}

void reference_start(Reference *r, const ContactProblem *problem, const ContactImpulse *start) {
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        ContactImpulse impulse =
            start != NULL ? start[i] : (ContactImpulse){contact->warm_normal, contact->warm_tangent};
        r->impulses[i] = (ReferenceImpulse){(double)impulse.normal, (double)impulse.tangent};
    }
    apply_impulses(r, problem);
    start_momenta(r, problem);
    start_sums(r, problem);
    r->sweeps = 0;
}

void reference_store(Reference *r, const ContactProblem *problem) {
    for (int i = 0; i < r->group_count; i++)
        for (int k = 0; k < REFERENCE_POINTS; k++) store_point(r, problem, i, k);
    apply_impulses(r, problem);
}
