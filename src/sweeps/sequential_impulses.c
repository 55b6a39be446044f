/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sequential impulses (projected Gauss-Seidel), as in Box2D-Lite.

   For each contact in turn, `iterations` times over: the normal impulse that would bring the normal velocity to
   its bias, clamped so that the sum over the step only pushes; then the tangent impulse that would stop the
   sliding, clamped so that its sum stays in the friction cone |Pt| <= mu Pn:

       Pn' = max(Pn + mass_n (bias - vn), 0),   Pt' = contact_clamp(Pt - mass_t vt, -mu Pn', mu Pn')

   The sums start from the last step's (warm start). Source: Catto, "Iterative Dynamics with Temporal Coherence"
   (2005); "Fast and Simple Physics using Sequential Impulses" (GDC 2006). Fails slowly: an impulse travels one
   contact a sweep against the order, so high stacks and heavy boxes on light ones stay soft.

   Bit-exact: the order of every float operation is fixed. This is the plain text; with accumulation the engine runs
   its fast equal, sweeps.h. */
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

/* One contact, once: the normal impulse, then friction against what it left. */
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
