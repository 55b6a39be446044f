/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sequential impulses (projected Gauss-Seidel), as in Box2D-Lite.

   For each contact in turn, `iterations` times over: the normal impulse that would bring the normal velocity to
   its bias, clamped so that the sum over the step only pushes; then the tangent impulse that would stop the
   sliding, clamped so that its sum stays in the friction cone |Pt| <= mu Pn:

       Pn' = max(Pn + mass_n (bias - vn), 0),   Pt' = clamp(Pt - mass_t vt, -mu Pn', mu Pn')

   The sums start from the last step's (warm start). Source: Catto, "Iterative Dynamics with Temporal Coherence"
   (2005); "Fast and Simple Physics using Sequential Impulses" (GDC 2006). Fails slowly: an impulse travels one
   contact a sweep against the order, so high stacks and heavy boxes on light ones stay soft.

   Bit-exact: the order of every float operation is fixed. This is the plain text; with accumulation the engine runs
   its fast equal, sweeps.h. */
#include "solvers/sequential_impulses.h"

#include "solvers/solvers.h"
#include "solvers/sweeps.h"

#include <stdlib.h>

typedef struct SequentialImpulses {
    int iterations;
    bool accumulate;
    SweepKernel kernel;
    Sweeps sweeps;
} SequentialImpulses;

static const SettingSpec settings[] = {{"k", "sweeps over all contacts a step (the scene's own: 10)"},
                                       {"accumulate", "on|off: clamp the sum of impulses, not each one"},
                                       {NULL, NULL}};

static void *create(const Settings *chosen, Error *error) {
    SequentialImpulses options = {.iterations = 10, .accumulate = true};
    options.kernel = sweeps_can(SWEEP_AVX2) ? SWEEP_AVX2 : SWEEP_ONE_BY_ONE;
    if (!settings_int(chosen, "k", 1, 1000000, &options.iterations, error) ||
        !settings_bool(chosen, "accumulate", &options.accumulate, error))
        return NULL;
    SequentialImpulses *solver = malloc(sizeof *solver);
    if (solver == NULL)
        error_memory(error, "engine");
    else
        *solver = options;
    return solver;
}

/* Adds impulse to b and takes it from a. */
static void apply(BodyVelocity *a, BodyVelocity *b, const ContactPoint *contact, const ProblemBody *bodies,
                  Vec2 impulse) {
    const ProblemBody *body_a = &bodies[contact->a], *body_b = &bodies[contact->b];
    a->linear = vec2_sub(a->linear, vec2_scale(body_a->inv_mass, impulse));
    a->angular -= body_a->inv_inertia * vec2_cross(contact->arm_a, impulse);
    b->linear = vec2_add(b->linear, vec2_scale(body_b->inv_mass, impulse));
    b->angular += body_b->inv_inertia * vec2_cross(contact->arm_b, impulse);
}

/* Velocity of b's point as seen from a's. */
static Vec2 relative_velocity(const BodyVelocity *a, const BodyVelocity *b, const ContactPoint *contact) {
    Vec2 of_b = vec2_add(b->linear, scalar_cross_vec2(b->angular, contact->arm_b));
    return vec2_sub(vec2_sub(of_b, a->linear), scalar_cross_vec2(a->angular, contact->arm_a));
}

static float clamp(float value, float low, float high) {
    float capped = value < high ? value : high;
    return low > capped ? low : capped;
}

static void warm_start(const ContactProblem *problem, ContactSolution *solution) {
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        solution->impulses[i] = (ContactImpulse){contact->warm_normal, contact->warm_tangent};
        Vec2 tangent = vec2_cross_scalar(contact->normal, 1.0f);
        Vec2 impulse =
            vec2_add(vec2_scale(contact->warm_normal, contact->normal), vec2_scale(contact->warm_tangent, tangent));
        apply(&solution->velocities[contact->a], &solution->velocities[contact->b], contact, problem->bodies, impulse);
    }
}

/* One contact, once: the normal impulse, then friction against what it left. */
static void solve_contact(const ContactPoint *contact, const ProblemBody *bodies, BodyVelocity *velocities,
                          ContactImpulse *sum, bool accumulate) {
    BodyVelocity *a = &velocities[contact->a], *b = &velocities[contact->b];

    float normal_velocity = vec2_dot(relative_velocity(a, b, contact), contact->normal);
    float normal = contact->mass_normal * (-normal_velocity + contact->bias);
    float pushed = accumulate ? sum->normal : 0.0f;
    float total = pushed + normal > 0.0f ? pushed + normal : 0.0f;
    normal = total - pushed;
    sum->normal = accumulate ? total : sum->normal + normal;
    apply(a, b, contact, bodies, vec2_scale(normal, contact->normal));

    Vec2 direction = vec2_cross_scalar(contact->normal, 1.0f);
    float tangent_velocity = vec2_dot(relative_velocity(a, b, contact), direction);
    float tangent = contact->mass_tangent * -tangent_velocity;
    float limit = contact->friction * (accumulate ? sum->normal : normal);
    float dragged = accumulate ? sum->tangent : 0.0f;
    total = clamp(dragged + tangent, -limit, limit);
    tangent = total - dragged;
    sum->tangent = accumulate ? total : sum->tangent + tangent;
    apply(a, b, contact, bodies, vec2_scale(tangent, direction));
}

void sequential_impulses_solve(const ContactProblem *problem, int iterations, bool accumulate,
                               ContactSolution *solution) {
    for (int i = 0; i < problem->body_count; i++)
        solution->velocities[i] = (BodyVelocity){problem->bodies[i].velocity, problem->bodies[i].angular_velocity};
    for (int i = 0; i < problem->contact_count; i++) solution->impulses[i] = (ContactImpulse){0, 0};
    if (accumulate) warm_start(problem, solution);
    for (int sweep = 0; sweep < iterations; sweep++)
        for (int i = 0; i < problem->contact_count; i++)
            solve_contact(&problem->contacts[i], problem->bodies, solution->velocities, &solution->impulses[i],
                          accumulate);
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    SequentialImpulses *solver = state;
    if (solver->accumulate) {
        if (!sweeps_begin(&solver->sweeps, solver->kernel, problem) || !sweeps_run(&solver->sweeps, solver->iterations))
            return error_memory(error, "engine");
        if (sweeps_end(&solver->sweeps, solution)) return true;
    }
    sequential_impulses_solve(problem, solver->iterations, solver->accumulate, solution);
    return true;
}

static void destroy(void *state) {
    SequentialImpulses *solver = state;
    if (solver == NULL) return;
    sweeps_free(&solver->sweeps);
    free(solver);
}

const ContactSolverKind solver_sequential_impulses = {
    "engine", "sequential impulses with warm starting: the physics engine", settings, create, solve, destroy};
