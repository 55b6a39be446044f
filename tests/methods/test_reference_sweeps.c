/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference, held to sweeps: many plain ones find the same, and one more changes nothing. */
#include "reference_worlds.h"

#include "methods/sweeps.h"

enum { MANY = 200000 };

/* Plain sweeps in double, written down apart from the reference. */
typedef struct Plain {
    ReferenceVelocity velocities[8];
    ReferenceImpulse impulses[64];
} Plain;

/* Velocity of b's point as seen from a's, along x, y. */
static double slip(const Plain *plain, const ContactPoint *contact, double x, double y) {
    const ReferenceVelocity *a = &plain->velocities[contact->a], *b = &plain->velocities[contact->b];
    double along_x = b->x - b->spin * (double)contact->arm_b.y - a->x + a->spin * (double)contact->arm_a.y;
    double along_y = b->y + b->spin * (double)contact->arm_b.x - a->y - a->spin * (double)contact->arm_a.x;
    return along_x * x + along_y * y;
}

static void push(Plain *plain, const ProblemBody *bodies, int body, Vec2 arm, double x, double y) {
    ReferenceVelocity *velocity = &plain->velocities[body];
    velocity->x += (double)bodies[body].inv_mass * x;
    velocity->y += (double)bodies[body].inv_mass * y;
    velocity->spin += (double)bodies[body].inv_inertia * ((double)arm.x * y - (double)arm.y * x);
}

static void push_both(Plain *plain, const ContactProblem *problem, const ContactPoint *contact, double x, double y) {
    push(plain, problem->bodies, contact->a, contact->arm_a, -x, -y);
    push(plain, problem->bodies, contact->b, contact->arm_b, x, y);
}

static void plain_begin(Plain *plain, const ContactProblem *problem) {
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        plain->velocities[i] =
            (ReferenceVelocity){(double)body->velocity.x, (double)body->velocity.y, (double)body->angular_velocity};
    }
    for (int i = 0; i < problem->contact_count; i++) plain->impulses[i] = (ReferenceImpulse){0, 0};
}

static void plain_sweep(Plain *plain, const ContactProblem *problem) {
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        ReferenceImpulse *impulse = &plain->impulses[i];
        double x = (double)contact->normal.x, y = (double)contact->normal.y, before = impulse->normal;
        impulse->normal =
            fmax(before + (double)contact->mass_normal * ((double)contact->bias - slip(plain, contact, x, y)), 0);
        push_both(plain, problem, contact, (impulse->normal - before) * x, (impulse->normal - before) * y);
        double limit = (double)contact->friction * impulse->normal;
        before = impulse->tangent;
        impulse->tangent =
            fmax(fmin(before - (double)contact->mass_tangent * slip(plain, contact, y, -x), limit), -limit);
        push_both(plain, problem, contact, (impulse->tangent - before) * y, (impulse->tangent - before) * -x);
    }
}

TEST(many_plain_sweeps_find_the_same) {
    for (int steps = 2; steps < 26; steps += 4) {
        OWN(World) *world = make_heap(steps);
        OWN(Reference) reference = {0};
        const ContactProblem *problem = solve_next(world, &reference);
        assert_true(problem->contact_count >= 7);
        Plain plain;
        plain_begin(&plain, problem);
        for (int sweep = 0; sweep < MANY; sweep++) plain_sweep(&plain, problem);
        for (int i = 0; i < problem->body_count; i++) {
            assert_near(plain.velocities[i].x, reference.velocities[i].x, 1e-8);
            assert_near(plain.velocities[i].y, reference.velocities[i].y, 1e-8);
            assert_near(plain.velocities[i].spin, reference.velocities[i].spin, 1e-8);
        }
    }
}

/* What every solver that converges does with the reference's impulses as its warm start: nothing but move the last
   bits of a float. */
static void assert_fixed_point(const ContactSolverKind *kind, const char *text, const ContactProblem *problem,
                               const Reference *reference) {
    Error error = {0};
    ContactSolver solver = make_solver(kind, text);
    BodyVelocity velocities[8];
    ContactImpulse impulses[64];
    ContactSolution solution = {velocities, impulses, 0, {0}};
    assert_ok(kind->solve(solver.state, problem, &solution, &error), error);
    for (int i = 0; i < problem->body_count; i++) {
        assert_velocity(velocities[i], reference->velocities[i].x, reference->velocities[i].y,
                        reference->velocities[i].spin, 2e-5);
    }
    free_solver(&solver);
}

TEST(the_reference_is_a_fixed_point_of_every_convergent_solver) {
    for (int steps = 2; steps < 26; steps += 4) {
        OWN(World) *world = make_heap(steps);
        OWN(Reference) reference = {0};
        ContactProblem problem = *solve_next(world, &reference);
        ContactPoint contacts[64];
        memcpy(contacts, problem.contacts, (size_t)problem.contact_count * sizeof *contacts);
        for (int i = 0; i < problem.contact_count; i++) {
            contacts[i].warm_normal = (float)reference.impulses[i].normal;
            contacts[i].warm_tangent = (float)reference.impulses[i].tangent;
        }
        problem.contacts = contacts;
        assert_fixed_point(&solver_engine, "k=1", &problem, &reference);
        assert_fixed_point(&solver_engine, "k=10", &problem, &reference);
        assert_fixed_point(&solver_momentum, "k=10", &problem, &reference);
        assert_fixed_point(&solver_nncg, "k=10", &problem, &reference);
        assert_fixed_point(&solver_reference, "", &problem, &reference);
    }
}

/* The impulses of the engine after that many sweeps without warm start. */
static void sweep_impulses(const ContactProblem *problem, int sweeps, ContactImpulse *impulses) {
    BodyVelocity velocities[8];
    ContactSolution solution = {velocities, impulses, 0, {0}};
    sequential_impulses_solve(problem, &(SequentialOptions){.accumulate = true}, sweeps, &solution);
}

/* The residual falls with the sweeps of the engine. Begun from a solution, the first linear solve finds it again. */
TEST(the_residual_tells_how_far_impulses_are_off) {
    OWN(World) *world = make_heap(10);
    OWN(Reference) reference = {0}, again = {0};
    const ContactProblem *problem = solve_next(world, &reference);
    double last = INFINITY, residual;
    ContactImpulse impulses[64];
    for (int sweeps = 3; sweeps < 200; sweeps *= 4) {
        sweep_impulses(problem, sweeps, impulses);
        assert_ok(reference_residual(&again, problem, impulses, &residual, &error), error);
        assert_true(residual < 0.5 * last);
        if (sweeps == 3) assert_true(residual > 0.01);
        last = residual;
    }
    for (int i = 0; i < problem->contact_count; i++)
        impulses[i] = (ContactImpulse){(float)reference.impulses[i].normal, (float)reference.impulses[i].tangent};
    assert_ok(reference_solve(&again, problem, impulses, &error), error);
    assert_in_range(again.factorizations, 1, 2);
    assert_int_equal(again.attempts, 0);
    assert_true(again.residual <= tight);
}

static void push_all(Plain *plain, const ContactProblem *problem, const ContactImpulse *impulses) {
    plain_begin(plain, problem);
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const double x = (double)contact->normal.x, y = (double)contact->normal.y;
        plain->impulses[i] = (ReferenceImpulse){(double)impulses[i].normal, (double)impulses[i].tangent};
        push_both(plain, problem, contact, plain->impulses[i].normal * x + plain->impulses[i].tangent * y,
                  plain->impulses[i].normal * y - plain->impulses[i].tangent * x);
    }
}

/* The residual is the largest |change of impulse| / effective mass of one more plain sweep. */
TEST(the_residual_is_what_a_plain_sweep_changes) {
    OWN(World) *world = make_heap(10);
    OWN(Reference) reference = {0};
    const ContactProblem *problem = solve_next(world, &reference);
    ContactImpulse impulses[64];
    sweep_impulses(problem, 5, impulses);
    double residual, largest = 0;
    assert_ok(reference_residual(&reference, problem, impulses, &residual, &error), error);
    Plain plain, swept;
    push_all(&plain, problem, impulses);
    swept = plain;
    plain_sweep(&swept, problem);
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const double normal = swept.impulses[i].normal - plain.impulses[i].normal;
        const double tangent = swept.impulses[i].tangent - plain.impulses[i].tangent;
        largest = fmax(largest, fabs(normal) / (double)contact->mass_normal);
        largest = fmax(largest, fabs(tangent) / (double)contact->mass_tangent);
    }
    assert_near(residual, largest, 1e-9 * largest);
}

RUN_TESTS(NULL, NULL)
