/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The closed form: each contact answers once, by itself, as a damped spring that only pushes. Nothing is iterated,
   learned or carried from step to step. In the plane the dual of a friction cone has two facets. With the velocities v
   before any impulse, the separation s (negative: overlap), the target velocity b and the effective mass M of a facet,

       v+- = (J_n +- mu J_t) v,   p+- = M+- / 2 max(0, damping (b - v+-) - stiffness (v+- + s / dt)),
       normal impulse p+ + p-,   tangent impulse mu (p+ - p-),

   inside the cone whatever the numbers are. The dual of the contact problem couples all facets by a matrix; here its
   diagonal stands for it. Each of the two facets of a contact has half of its mass, so that a contact without friction
   stops if the settings add up to 1, and none overshoots. Sources: Jin, "Complementarity-Free Multi-Contact Modeling
   and Optimization for Dexterous Manipulation" (2024); Borse, Xie, Huang, Jin, "ComFree-Sim: A GPU-Parallelized
   Analytical Contact Physics Engine" (2026). The latter's stiffness 0.2 and damping 0.001, for steps of 2 ms and
   MuJoCo's impedance of 0.9, are a spring of 900/s^2 and a damper of 4.5/s, which the default settings are at 60 Hz.

   Fails wherever something rests: contacts feel weight only as overlap, so a stack of three sinks into itself;
   friction needs a slip, so boxes creep down every slope; what slides fast is lifted, and deep stacks gain energy; an
   impact reaches no further than the first box. */
#include "methods/impulses.h"
#include "methods/methods.h"

#include <stdlib.h>

typedef struct State {
    float stiffness, damping;
} State;

static const SettingSpec settings[] = {
    {"stiffness", "share of the overlap that a contact removes in a step (default: 0.25)",
     SETTING_FLOAT(State, stiffness, 0, 2)},
    {"damping", "share of the missing velocity that it adds (default: 0.075)", SETTING_FLOAT(State, damping, 0, 2)},
    {0}};

static void *create(const Settings *chosen, Error *error) {
    static const State standard = {.stiffness = 0.25f, .damping = 0.075f};
    return settings_make(chosen, settings, &standard, sizeof standard, "closed-form", error);
}

/* N s: the impulse of a facet. NaN is 0, too. */
static float push(const State *solver, const ContactProblem *problem, const ContactPoint *contact, Vec2 velocity,
                  Vec2 facet) {
    const float along = vec2_dot(velocity, facet);
    const float wanted =
        solver->damping * (contact->bias - along) - solver->stiffness * (along + contact->separation / problem->dt);
    const ProblemBody *a = &problem->bodies[contact->a], *b = &problem->bodies[contact->b];
    const float turn_a = vec2_cross(contact->arm_a, facet), turn_b = vec2_cross(contact->arm_b, facet);
    /* 1/kg: the velocity along the facet that an impulse of it makes */
    const float answers = (a->inv_mass + b->inv_mass) * vec2_dot(facet, facet) + a->inv_inertia * turn_a * turn_a +
                          b->inv_inertia * turn_b * turn_b;
    return wanted > 0 && answers > 0 ? 0.5f * wanted / answers : 0;
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    const State *solver = state;
    (void)error;
    contact_solution_begin(problem, solution);
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const ProblemBody *a = &problem->bodies[contact->a], *b = &problem->bodies[contact->b];
        const BodyVelocity of_a = {a->velocity, a->angular_velocity}, of_b = {b->velocity, b->angular_velocity};
        const Vec2 velocity = contact_relative_velocity(&of_a, &of_b, contact);
        const Vec2 slip = vec2_scale(contact->friction, vec2_cross_scalar(contact->normal, 1.0f));
        const float first = push(solver, problem, contact, velocity, vec2_add(contact->normal, slip));
        const float second = push(solver, problem, contact, velocity, vec2_sub(contact->normal, slip));
        solution->impulses[i] = (ContactImpulse){first + second, contact->friction * (first - second)};
        contact_push(solution->velocities, contact, problem->bodies, solution->impulses[i]);
    }
    return true;
}

const ContactSolverKind solver_closed_form = {
    .description = {.name = "closed-form",
                    .summary = "complementarity-free contact: each contact answers once, as a damped spring",
                    .caption = "complementarity-free contact",
                    .settings = settings,
                    .chart = METHOD_RUNS("", "stiffness=0,damping=2", "stiffness=0.5,damping=0.02",
                                         "stiffness=0.5,damping=0.2", "stiffness=0.25,damping=0.5",
                                         "stiffness=0.25,damping=2")},
    .create = create,
    .solve = solve,
    .destroy = free};
