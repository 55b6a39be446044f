/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sequential impulses (projected Gauss-Seidel), as in Box2D-Lite.

   Each sweep visits every contact in turn: first the normal impulse that brings the normal velocity to its bias,
   clamped so that the accumulated impulse is not negative; then the tangent impulse that stops the sliding, clamped so
   that the accumulated impulse stays in the friction cone |Pt| <= mu Pn:

       Pn' = max(Pn + mass_n (bias - vn), 0),   Pt' = contact_clamp(Pt - mass_t vt, -mu Pn', mu Pn')

   Accumulated impulses start from the last step's (warm start). Source: Catto, "Iterative Dynamics with Temporal
   Coherence" (2005); "Fast and Simple Physics using Sequential Impulses" (GDC 2006). Fails by slow convergence: against
   the order of visits an impulse propagates by one contact per sweep, so high stacks and heavy boxes on light ones stay
   soft.

   Bit-exact: the order of all float operations is fixed. This is the scalar reference implementation; with accumulated
   impulses the engine runs sweeps.h, which has the same bits. */
#include "sweeps/sequential_impulses.h"

#include "sweeps/contact_velocity.h"

static void warm_start(const ContactProblem *problem, bool warm, ContactSolution *solution) {
    static const ContactImpulse cold = {0, 0};
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        ContactImpulse start = warm ? (ContactImpulse){contact->warm_normal, contact->warm_tangent} : cold;
        solution->impulses[i] = start;
        contact_push(solution->velocities, contact, problem->bodies, start);
    }
}

/* One visit of a contact: the normal impulse, then friction. */
static void solve_contact(const ContactPoint *contact, const ProblemBody *bodies, BodyVelocity *velocities,
                          ContactImpulse *sum, const SequentialOptions *options) {
    const bool accumulate = options->accumulate;
    BodyVelocity *a = &velocities[contact->a], *b = &velocities[contact->b];

    float normal_velocity = vec2_dot(contact_relative_velocity(a, b, contact), contact->normal);
    float normal = options->relaxation * contact->mass_normal * (-normal_velocity + contact->bias);
    float pushed = accumulate ? sum->normal : 0.0f;
    float total = pushed + normal > 0.0f ? pushed + normal : 0.0f;
    normal = total - pushed;
    sum->normal = accumulate ? total : sum->normal + normal;
    contact_apply(a, b, contact, bodies, vec2_scale(normal, contact->normal));

    Vec2 direction = vec2_cross_scalar(contact->normal, 1.0f);
    float tangent_velocity = vec2_dot(contact_relative_velocity(a, b, contact), direction);
    float tangent = options->relaxation * contact->mass_tangent * -tangent_velocity;
    float limit = contact->friction * (accumulate ? sum->normal : normal);
    float dragged = accumulate ? sum->tangent : 0.0f;
    total = contact_clamp(dragged + tangent, -limit, limit);
    tangent = total - dragged;
    sum->tangent = accumulate ? total : sum->tangent + tangent;
    contact_apply(a, b, contact, bodies, vec2_scale(tangent, direction));
}

void sequential_impulses_begin(const ContactProblem *problem, const SequentialOptions *options,
                               ContactSolution *solution) {
    for (int i = 0; i < problem->body_count; i++)
        solution->velocities[i] = (BodyVelocity){problem->bodies[i].velocity, problem->bodies[i].angular_velocity};
    for (int i = 0; i < problem->contact_count; i++) solution->impulses[i] = (ContactImpulse){0, 0};
    if (options->accumulate) warm_start(problem, options->warm, solution);
}

void sequential_impulses_visit(const ContactProblem *problem, const SequentialOptions *options, int first, int count,
                               ContactSolution *solution) {
    for (int i = first; i < first + count; i++)
        solve_contact(&problem->contacts[i], problem->bodies, solution->velocities, &solution->impulses[i], options);
}

void sequential_impulses_sweep(const ContactProblem *problem, const SequentialOptions *options,
                               ContactSolution *solution) {
    sequential_impulses_visit(problem, options, 0, problem->contact_count, solution);
}

void sequential_impulses_solve(const ContactProblem *problem, const SequentialOptions *options, int count,
                               ContactSolution *solution) {
    sequential_impulses_begin(problem, options, solution);
    for (int sweep = 0; sweep < count; sweep++) sequential_impulses_sweep(problem, options, solution);
}
