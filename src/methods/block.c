/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Block solver: sequential impulses that solve both normal impulses x of a pair with two points together.

   They solve the linear complementarity problem

       v = K x + q >= 0,   x >= 0,   v . x = 0

   (v: normal velocities less their bias, q: those without x) by trying its four cases: both points push, only the
   first, only the second, none. A box on a face comes to rest in one sweep; solved separately, its two points would
   tilt it back and forth. Friction is solved first, point by point, bounded by the normal impulse so far: after few
   sweeps it may exceed the friction cone by the later change of the normal impulse. Source: Catto, "Modeling and
   Solving Constraints" (GDC 2009), and the contact solver of Box2D 2.4. Points of pairs with one point, or with two
   that nearly coincide, are solved separately (Box2D drops one of the two). Fails as sequential impulses do: between
   pairs an impulse propagates no faster, so high stacks and heavy boxes on light ones stay soft.

   Bit-exact: the order of all float operations is fixed. This is the scalar reference implementation; block_lanes.h
   vectorises it. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/solvers.h"
#include "methods/sweeps.h"

/* Box2D's limit for the condition number of K. */
static const float max_condition = 1000.0f;

Block block_make(const ContactPoint *first, const ContactPoint *second, const ProblemBody *bodies) {
    const ProblemBody *a = &bodies[first->a], *b = &bodies[first->b];
    float first_a = vec2_cross(first->arm_a, first->normal), first_b = vec2_cross(first->arm_b, first->normal);
    float second_a = vec2_cross(second->arm_a, second->normal), second_b = vec2_cross(second->arm_b, second->normal);
    float mass = a->inv_mass + b->inv_mass;
    Block block = {.k11 = mass + a->inv_inertia * first_a * first_a + b->inv_inertia * first_b * first_b,
                   .k12 = mass + a->inv_inertia * first_a * second_a + b->inv_inertia * first_b * second_b,
                   .k22 = mass + a->inv_inertia * second_a * second_a + b->inv_inertia * second_b * second_b};
    float determinant = block.k11 * block.k22 - block.k12 * block.k12;
    bool well = block.k11 * block.k11 < max_condition * determinant;
    block.inverse_determinant = well ? 1.0f / determinant : 0.0f;
    return block;
}

static float normal_velocity(const ContactPoint *contact, const BodyVelocity *velocities) {
    Vec2 velocity = contact_relative_velocity(&velocities[contact->a], &velocities[contact->b], contact);
    return vec2_dot(velocity, contact->normal);
}

static void push(const ContactPoint *contact, const ProblemBody *bodies, BodyVelocity *velocities, float impulse) {
    contact_apply(&velocities[contact->a], &velocities[contact->b], contact, bodies,
                  vec2_scale(impulse, contact->normal));
}

static void solve_friction(const ContactPoint *contact, const ProblemBody *bodies, BodyVelocity *velocities,
                           ContactImpulse *sum) {
    BodyVelocity *a = &velocities[contact->a], *b = &velocities[contact->b];
    Vec2 direction = vec2_cross_scalar(contact->normal, 1.0f);
    float velocity = vec2_dot(contact_relative_velocity(a, b, contact), direction);
    float limit = contact->friction * sum->normal;
    float total = contact_clamp(sum->tangent - contact->mass_tangent * velocity, -limit, limit);
    float impulse = total - sum->tangent;
    sum->tangent = total;
    contact_apply(a, b, contact, bodies, vec2_scale(impulse, direction));
}

static void solve_normal(const ContactPoint *contact, const ProblemBody *bodies, BodyVelocity *velocities,
                         ContactImpulse *sum) {
    float total = sum->normal + contact->mass_normal * (contact->bias - normal_velocity(contact, velocities));
    total = total > 0.0f ? total : 0.0f;
    push(contact, bodies, velocities, total - sum->normal);
    sum->normal = total;
}

/* The first of the four cases that holds; x unchanged if rounding leaves none. */
static Vec2 solve_cases(const Block *block, float mass1, float mass2, Vec2 x, Vec2 q) {
    Vec2 both = {block->inverse_determinant * (block->k12 * q.y - block->k22 * q.x),
                 block->inverse_determinant * (block->k12 * q.x - block->k11 * q.y)};
    if (both.x >= 0.0f && both.y >= 0.0f) return both;
    float first = 0.0f - mass1 * q.x, second = 0.0f - mass2 * q.y;
    if (first >= 0.0f && block->k12 * first + q.y >= 0.0f) return vec2(first, 0.0f);
    if (second >= 0.0f && block->k12 * second + q.x >= 0.0f) return vec2(0.0f, second);
    if (q.x >= 0.0f && q.y >= 0.0f) return vec2(0.0f, 0.0f);
    return x;
}

/* Solves both normal impulses together. */
static void solve_normals(const ContactPoint contacts[2], const Block *block, const ProblemBody *bodies,
                          BodyVelocity *velocities, ContactImpulse sums[2]) {
    Vec2 x = vec2(sums[0].normal, sums[1].normal);
    Vec2 q = vec2(normal_velocity(&contacts[0], velocities) - contacts[0].bias - block->k11 * x.x - block->k12 * x.y,
                  normal_velocity(&contacts[1], velocities) - contacts[1].bias - block->k12 * x.x - block->k22 * x.y);
    Vec2 found = solve_cases(block, contacts[0].mass_normal, contacts[1].mass_normal, x, q);
    push(&contacts[0], bodies, velocities, found.x - x.x);
    push(&contacts[1], bodies, velocities, found.y - x.y);
    sums[0].normal = found.x;
    sums[1].normal = found.y;
}

static bool same_pair(const ContactPoint *first, const ContactPoint *second) {
    return first->a == second->a && first->b == second->b;
}

/* One sweep over all contacts. */
static void block_sweep(const ContactProblem *problem, ContactSolution *solution) {
    const ProblemBody *bodies = problem->bodies;
    BodyVelocity *velocities = solution->velocities;
    for (int i = 0, count; i < problem->contact_count; i += count) {
        const ContactPoint *contacts = &problem->contacts[i];
        ContactImpulse *sums = &solution->impulses[i];
        count = i + 1 < problem->contact_count && same_pair(&contacts[0], &contacts[1]) ? 2 : 1;
        for (int k = 0; k < count; k++) solve_friction(&contacts[k], bodies, velocities, &sums[k]);
        Block block = count == 2 ? block_make(&contacts[0], &contacts[1], bodies) : (Block){0};
        if (block.inverse_determinant > 0.0f)
            solve_normals(contacts, &block, bodies, velocities, sums);
        else
            for (int k = 0; k < count; k++) solve_normal(&contacts[k], bodies, velocities, &sums[k]);
    }
}

void block_solve(const ContactProblem *problem, int count, ContactSolution *solution) {
    const SequentialOptions options = {.accumulate = true, .warm = true, .relaxation = 1.0f};
    sequential_impulses_begin(problem, &options, solution);
    for (int i = 0; i < count; i++) block_sweep(problem, solution);
}

static const SettingSpec settings[] = {SWEEPS_SETTING, STOPPING_SETTINGS, {0}};

static void *create(const Settings *chosen, Error *error) {
    static const SweepState standard = {.rule.k = 10};
    return stopping_make(chosen, settings, &standard, sizeof standard, "block", error);
}

static void solve_scalar(const SweepState *solver, const ContactProblem *problem, ContactSolution *solution) {
    block_solve(problem, solver->rule.k, solution);
    for (int done = 0; stopping_needs_more_scalar(&solver->rule, done, problem, solution); done += STOPPING_BLOCK)
        for (int i = 0; i < STOPPING_BLOCK; i++) block_sweep(problem, solution);
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    SweepState *solver = state;
    if (sweeps_can(SWEEP_AVX2)) {
        if (!sweeps_begin_blocks(&solver->sweeps, problem) ||
            !stopping_run(&solver->rule, &solver->sweeps, problem, sweeps_run_blocks))
            return error_memory(error, "block");
        if (sweeps_end(&solver->sweeps, solution)) return true;
    }
    solve_scalar(solver, problem, solution);
    return true;
}

const ContactSolverKind solver_block = {
    .description = {.name = "block",
                    .summary = "sequential impulses that solve both normal impulses of a pair together",
                    .caption = "both impulses of a pair at once",
                    .look = {METHOD_SKY, METHOD_PENTAGON},
                    .settings = settings,
                    .chart = METHOD_RUNS("k=5", "k=10", "k=20", "k=50", "k=100"),
                    .chart_quick = METHOD_RUNS("k=10"),
                    .stability = METHOD_NO_RUNS},
    .create = create,
    .solve = solve,
    .destroy = sweep_state_destroy};
