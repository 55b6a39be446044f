/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The laws of contact, each by itself (methods/criteria.h). */
#include "methods/criteria.h"
#include "engine/engine.h"

#include <math.h>

/* Along normal and tangent of a contact: impulses in N s, velocities in m/s. */
typedef struct Along {
    double normal, tangent;
} Along;

typedef struct Motion {
    double x, y, spin; /* m/s, rad/s */
} Motion;

static Motion motion_of(const BodyVelocity *velocity) {
    return (Motion){(double)velocity->linear.x, (double)velocity->linear.y, (double)velocity->angular};
}

static Along velocity_at(const ContactPoint *contact, const BodyVelocity *velocities) {
    const Motion a = motion_of(&velocities[contact->a]), b = motion_of(&velocities[contact->b]);
    const double x = b.x - b.spin * (double)contact->arm_b.y - (a.x - a.spin * (double)contact->arm_a.y);
    const double y = b.y + b.spin * (double)contact->arm_b.x - (a.y + a.spin * (double)contact->arm_a.x);
    const double normal_x = (double)contact->normal.x, normal_y = (double)contact->normal.y;
    return (Along){normal_x * x + normal_y * y, normal_y * x - normal_x * y};
}

/* The point of the cone that is nearest may be on its side or, for an impulse that pulls, its tip. */
static double outside_cone(Along impulse, double friction) {
    const double sideways = fabs(impulse.tangent);
    if (sideways <= friction * impulse.normal) return 0;
    if (impulse.normal <= -friction * sideways) return hypot(impulse.normal, sideways);
    return (sideways - friction * impulse.normal) / sqrt(1 + friction * friction);
}

static double larger(double x, double y) { return y > x ? y : x; }

/* Adds a contact to the largest of all. False if a number is NaN or infinite. */
static bool add_contact(ContactCriteria *criteria, const ContactPoint *contact, const ContactSolution *solution, int i,
                        bool push_out, float dt) {
    const ContactImpulse given = solution->impulses[i];
    const Along p = {(double)given.normal, (double)given.tangent}, u = velocity_at(contact, solution->velocities);
    const double bias = !push_out && contact->bias > 0 ? 0 : (double)contact->bias;
    const double friction = (double)contact->friction, held = friction * larger(p.normal, 0);
    criteria->signorini = larger(criteria->signorini, fabs((u.normal - bias) * p.normal));
    criteria->cone = larger(criteria->cone, outside_cone(p, friction));
    criteria->dissipation = larger(criteria->dissipation, fabs(held * fabs(u.tangent) + p.tangent * u.tangent));
    criteria->penetration = larger(criteria->penetration, -((double)contact->separation + (double)dt * u.normal));
    return isfinite(p.normal) && isfinite(p.tangent) && isfinite(u.normal) && isfinite(u.tangent);
}

static double kinetic(const ProblemBody *body, Motion motion) {
    double twice = 0;
    if (body->inv_mass > 0) twice += (motion.x * motion.x + motion.y * motion.y) / (double)body->inv_mass;
    if (body->inv_inertia > 0) twice += motion.spin * motion.spin / (double)body->inv_inertia;
    return twice / 2;
}

ContactCriteria contact_criteria(const ContactProblem *problem, const ContactSolution *solution, bool push_out) {
    ContactCriteria criteria = {0};
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        const BodyVelocity freely = {body->velocity, body->angular_velocity};
        criteria.energy += kinetic(body, motion_of(&solution->velocities[i])) - kinetic(body, motion_of(&freely));
    }
    bool finite = isfinite(criteria.energy);
    for (int i = 0; i < problem->contact_count; i++)
        finite &= add_contact(&criteria, &problem->contacts[i], solution, i, push_out, problem->dt);
    if (!finite) return (ContactCriteria){INFINITY, INFINITY, INFINITY, INFINITY, INFINITY};
    bool lacks_impulses = problem->contact_count > 0;
    for (int i = 0; i < problem->contact_count; i++)
        lacks_impulses &= solution->impulses[i].normal == 0 && solution->impulses[i].tangent == 0;
    if (lacks_impulses) criteria.signorini = criteria.cone = criteria.dissipation = NAN;
    return criteria;
}
