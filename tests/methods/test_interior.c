/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method interior: its solution against the reference, and what it must keep whatever the problem is. */
#include "consistent.h"
#include "kernels.h"
#include "random_problem.h"
#include "reference_worlds.h"

#include "methods/interior_point_internal.h"
#include "methods/reference.h"
#include "methods/sweeps.h"

static Reference reference;

static double error_of(const char *settings, const ContactProblem *problem, const ReferenceVelocity *expected) {
    OWN(ContactSolution) found = make_solution(problem);
    solve_with(&solver_interior, settings, problem, &found);
    const double error = solution_error(problem, found.velocities, expected).rms;
    return error;
}

/* A stack that a box of 10 times the mass has just hit. */
static World *make_struck_stack(int steps) {
    World *world = make_world();
    add_ground(world, 0.2f);
    for (int i = 0; i < 10; i++) add_box(world, 1, 0.2f, vec2(0, 0.49f + 0.98f * (float)i));
    add_body(world, &(BodyDef){.size = {1, 1},
                               .mass = 10,
                               .friction = 0.2f,
                               .position = {0.2f, 10.3f},
                               .angle = 0.1f,
                               .velocity = {-3, -8}});
    run_engine(world, "", steps);
    return world;
}

static World *make_struck_pyramid(int steps) {
    World *world = make_world();
    add_ground(world, 0.2f);
    for (int row = 0; row < 6; row++)
        for (int i = row; i < 6; i++) {
            const float x = 1.125f * ((float)i - 0.5f * (float)row);
            add_box(world, 10, 0.2f, vec2(x, 0.49f + 0.98f * (float)row));
        }
    add_body(world,
             &(BodyDef){.size = {1, 1}, .mass = 50, .friction = 0.2f, .position = {2.6f, 6.6f}, .velocity = {1, -15}});
    run_engine(world, "", steps);
    return world;
}

/* Root mean square over the contacts of what one visit would change, m/s. */
static double residual_of(const ContactProblem *problem, const ContactSolution *found) {
    double sum = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const Vec2 tangent = vec2_cross_scalar(contact->normal, 1.0f);
        const Vec2 v =
            contact_relative_velocity(&found->velocities[contact->a], &found->velocities[contact->b], contact);
        const double l = (double)found->impulses[i].normal, t = (double)found->impulses[i].tangent;
        const double gap = (double)(vec2_dot(v, contact->normal) - contact->bias);
        const double mass = (double)contact->mass_tangent, bound = (double)contact->friction * l;
        const double normal = fmin(l / (double)contact->mass_normal, gap);
        const double tangential = (t - fmin(fmax(t - mass * (double)vec2_dot(v, tangent), -bound), bound)) / mass;
        sum += normal * normal + tangential * tangential;
    }
    return sqrt(sum / problem->contact_count);
}

/* The error of the velocities follows `near`. */
TEST(impacts_have_the_reference_solution) {
    World *worlds[] = {make_struck_stack(2), make_struck_stack(4), make_heap(4), make_heap(9)};
    for (int i = 0; i < 4; i++) {
        const ContactProblem *problem = next_problem(worlds[i]);
        assert_ok(reference_solve(&reference, problem, NULL, &error), error);
        assert_true(reference.residual <= tight);
        assert_true(error_of("near=0.02", problem, reference.velocities) < 0.02);
        assert_true(error_of("near=1e-3", problem, reference.velocities) < 1e-3);
        assert_true(error_of("near=1e-6", problem, reference.velocities) < 1e-5);
        world_destroy(worlds[i]);
    }
}

/* Friction allows several solutions here, 0.07 m/s apart, so this is about the residual alone. Shallow contacts close
   by up to 1 mm/s. The path of two of the five impacts turns back: they take 20 iterations, more work than a step
   may. */
TEST(impacts_of_a_pyramid_are_solved_to_the_tolerance) {
    static const struct {
        const char *text;
        double most;
    } settings[] = {{"near=0.5", 0.5}, {"near=0.02", 0.02}, {"near=0.005", 0.005}};
    int fallbacks = 0;
    for (int i = 0; i < 15; i++) {
        OWN(World) *world = make_struck_pyramid(1 + i / 3);
        const ContactProblem *problem = next_problem(world);
        OWN(ContactSolution) found = make_solution(problem);
        solve_with(&solver_interior, settings[i % 3].text, problem, &found);
        fallbacks += found.fallbacks.by_sweeps;
        if (found.fallbacks.by_sweeps == 0) assert_true(residual_of(problem, &found) <= settings[i % 3].most + 1.1e-3);
    }
    assert_true(fallbacks <= 4);
}

/* Random normals, arms and masses: effective masses that fit, as the residual is in their units, and fixed bodies that
   do not move, as they would add energy. Where the friction is low, the solution is unique. */
static void fit_masses(RandomProblem *random) {
    for (int i = 0; i < random->problem.body_count; i++)
        if (random->bodies[i].inv_mass == 0)
            random->bodies[i].velocity = vec2(0, random->bodies[i].angular_velocity = 0);
    for (int i = 0; i < random->problem.contact_count; i++) {
        ContactPoint *contact = &random->contacts[i];
        const ProblemBody *a = &random->bodies[contact->a], *b = &random->bodies[contact->b];
        const float an = vec2_cross(contact->arm_a, contact->normal), bn = vec2_cross(contact->arm_b, contact->normal);
        const float at = vec2_dot(contact->arm_a, contact->normal), bt = vec2_dot(contact->arm_b, contact->normal);
        const float mass = a->inv_mass + b->inv_mass;
        const float normal = mass + a->inv_inertia * an * an + b->inv_inertia * bn * bn;
        const float tangent = mass + a->inv_inertia * at * at + b->inv_inertia * bt * bt;
        contact->mass_normal = normal > 0 ? 1 / normal : 1;
        contact->mass_tangent = tangent > 0 ? 1 / tangent : 1;
        contact->friction *= 0.2f;
        contact->bias *= 0.1f;
    }
}

/* Some random problems have no solution, or the reference does not find it; most have. */
TEST(random_problems_have_the_reference_solution) {
    static RandomProblem random;
    uint32_t seed = 3;
    int compared = 0, agree = 0;
    for (int run = 0; run < 60; run++) {
        make_random(&random, &seed, 3 + run % 12, 0.25f, 1);
        fit_masses(&random);
        assert_ok(reference_solve(&reference, &random.problem, NULL, &error), error);
        if (!(reference.residual <= tight)) continue;
        compared++;
        agree += error_of("near=1e-7", &random.problem, reference.velocities) < 1e-4;
    }
    if (compared < 40 || agree < compared * 9 / 10) fail_msg("%d of %d agree", agree, compared);
}

/* For any problem: impulses inside the cone, velocities that are those of the impulses. */
TEST(cone_and_velocities_fit) {
    static RandomProblem random;
    uint32_t seed = 11;
    for (int run = 0; run < 60; run++) {
        make_random(&random, &seed, 2 + run, 0.15f, 0);
        fit_masses(&random);
        OWN(ContactSolution) found = make_solution(&random.problem);
        solve_with(&solver_interior, run % 2 == 0 ? "" : "near=1e-4", &random.problem, &found);
        assert_in_cone(&random.problem, found.impulses);
        assert_velocities_fit(&random.problem, &found, false);
    }
}

/* The rounding of the velocities to float is all that is lost: 2^-24 of each. */
TEST(momentum_is_exact) {
    OWN(World) *world = make_struck_stack(3);
    const ContactProblem *problem = next_problem(world);
    ContactProblem free = *problem;
    ProblemBody bodies[16];
    memcpy(bodies, problem->bodies, (size_t)problem->body_count * sizeof *bodies);
    bodies[0].inv_mass = bodies[0].inv_inertia = 1e-4f; /* a heavy floating ground */
    free.bodies = bodies;
    OWN(ContactSolution) found = make_solution(&free);
    solve_with(&solver_interior, "", &free, &found);
    double before[2] = {0}, after[2] = {0}, rounding = 0;
    for (int i = 0; i < free.body_count; i++) {
        const double mass = 1 / (double)bodies[i].inv_mass;
        const Vec2 v = found.velocities[i].linear;
        before[0] += mass * (double)bodies[i].velocity.x;
        before[1] += mass * (double)bodies[i].velocity.y;
        after[0] += mass * (double)v.x;
        after[1] += mass * (double)v.y;
        rounding += mass * fmax(fabs((double)v.x), fabs((double)v.y)) * ldexp(1, -24);
    }
    for (int k = 0; k < 2; k++) assert_near(after[k], before[k], rounding);
}

static void kernels_agree(const ContactProblem *problem) {
    OWN(Sweeps) sweeps = {0};
    Interior interior[2];
    memset(interior, 0, sizeof interior);
    const InteriorKernels *const kernels[2] = {&interior_scalar, interior_best()};
    ContactSolution found[2] = {make_solution(problem), make_solution(problem)};
    assert_true(sweeps_begin_coloured(&sweeps, SWEEP_ONE_BY_ONE, problem) && sweeps_run(&sweeps, 2));
    for (int k = 0; k < 2; k++) {
        assert_true(interior_load(&interior[k], kernels[k], &sweeps, problem));
        interior_iterate(&interior[k], kernels[k], 1, 1e-3, 20);
        interior_end(&interior[k], &sweeps, problem, &found[k]);
    }
    assert_same_bits(problem, &found[1], &found[0], "interior");
    for (int k = 0; k < 2; k++) {
        interior_free(&interior[k]);
        free_solution(&found[k]);
    }
}

/* The sum of log(estimate / residual) over eight iterations. */
static double log_of_estimates(const ContactProblem *problem) {
    const InteriorKernels *kernels = interior_best();
    OWN(Sweeps) sweeps = {0};
    Interior interior = {0};
    assert_true(sweeps_begin_coloured(&sweeps, sweeps_best_kernel(), problem) && sweeps_run(&sweeps, 2));
    assert_true(interior_load(&interior, kernels, &sweeps, problem));
    interior_iterate(&interior, kernels, 10, 0, 1);
    double target = 1e-2, sum = 0;
    for (int i = 0; i < 8; i++, target *= 0.1) {
        const double estimate = kernels->iterate(&interior, target), residual = kernels->answer(&interior);
        assert_true(residual <= 2 * estimate + 1e-9);
        sum += log((estimate + 1e-9) / (residual + 1e-9));
    }
    interior_free(&interior);
    return sum;
}

/* The estimate decides when the velocities of the answer are computed. Too small it would cost time for answers that
   are refused, too large it would cost iterations. */
TEST(the_estimate_is_near_the_residual) {
    World *worlds[] = {make_struck_stack(2), make_struck_stack(4), make_struck_pyramid(1), make_struck_pyramid(4),
                       make_heap(4)};
    double sum = 0;
    for (int i = 0; i < 5; i++) {
        sum += log_of_estimates(next_problem(worlds[i]));
        world_destroy(worlds[i]);
    }
    assert_true(fabs(sum / (5 * 8)) < log(1.5));
}

TEST(kernels_have_the_bits_of_the_scalar_one) {
    static RandomProblem random;
    uint32_t seed = 21;
    for (int run = 0; run < 50; run++) {
        make_random(&random, &seed, 2 + run, 0.15f, 1);
        fit_masses(&random);
        kernels_agree(&random.problem);
    }
    OWN(World) *world = make_struck_pyramid(2);
    kernels_agree(next_problem(world));
}

/* The same problem gives the same bits whatever the solver has solved before. */
TEST(earlier_problems_leave_no_trace) {
    OWN(World) *pyramid = make_struck_pyramid(2), *stack = make_struck_stack(3);
    const ContactProblem *first = next_problem(pyramid), *second = next_problem(stack);
    OWN(ContactSolution) fresh = make_solution(second), used = make_solution(second), other = make_solution(first);
    solve_with(&solver_interior, "", second, &fresh);
    OWN(ContactSolver) solver = make_solver(&solver_interior, "");
    for (int i = 0; i < 2; i++) {
        assert_ok(solver.kind->solve(solver.state, first, &other, &error), error);
        assert_ok(solver.kind->solve(solver.state, second, &used, &error), error);
        assert_same_bits(second, &used, &fresh, "used");
    }
}

TEST(without_contacts_bodies_keep_their_velocities) {
    const ProblemBody body = {.inv_mass = 1, .inv_inertia = 6, .velocity = {1, 2}, .angular_velocity = 3};
    const ContactProblem problem = {.body_count = 1, .bomb = -1, .dt = world_dt, .bodies = &body};
    OWN(ContactSolution) found = make_solution(&problem);
    solve_with(&solver_interior, "", &problem, &found);
    const BodyVelocity expected = {{1, 2}, 3};
    assert_memory_equal(&found.velocities[0], &expected, sizeof expected);
    assert_int_equal(found.fallbacks.by_sweeps, 0);
}

/* A million to one. */
TEST(a_huge_mass_ratio_is_solved) {
    OWN(World) *world = make_heavy_on_light(1e6f, 0.495f, 1.49f);
    OWN(ContactSolver) solver = make_solver(&solver_interior, "");
    run(world, &solver, 300);
    assert_near(world_bodies(world)[1].position.y, 0.49f, 0.01f);
    assert_near(world_bodies(world)[2].position.y, 1.48f, 0.02f);
}

/* Sweeps solve a problem with a NaN, and say so: with their bits, whatever these are. */
TEST(a_nan_ends_in_the_fallback) {
    OWN(World) *world = make_struck_stack(3);
    ContactProblem problem = *next_problem(world);
    ContactPoint contacts[64];
    assert_in_range(problem.contact_count, 3, 64);
    memcpy(contacts, problem.contacts, (size_t)problem.contact_count * sizeof *contacts);
    contacts[2].bias = NAN;
    problem.contacts = contacts;
    OWN(ContactSolution) found = make_solution(&problem);
    solve_with(&solver_interior, "", &problem, &found);
    assert_int_equal(found.fallbacks.by_sweeps, 1);
}

/* `rows` rows of a pyramid, or as many boxes in stacks of ten. The last box falls at 20 m/s. */
static World *make_boxes(int rows, bool stacks) {
    World *world = make_world();
    add_ground(world, 0.5f);
    BodyDef def = {.size = {1, 1}, .mass = 10, .friction = 0.5f};
    for (int row = 0, box = 0; row < rows; row++)
        for (int i = row; i < rows; i++, box++) {
            const float x = 1.125f * ((float)(i - rows / 2) - 0.5f * (float)row);
            def.position = stacks ? vec2(2 * (float)(box / 10 - rows), 0.49f + 0.98f * (float)(box % 10))
                                  : vec2(x, 0.49f + 0.98f * (float)row);
            if (row == rows - 1) def.velocity = vec2(0, -20);
            add_body(world, &def);
        }
    return world;
}

/* The bound has room for few iterations in a pyramid of 7,260 boxes. What they leave, sweeps get: less than a tenth of
   what one sweep leaves. Without work for them it would be more than that. */
TEST(large_pyramids_end_in_sweeps_and_stacks_do_not) {
    for (int stacks = 0; stacks < 2; stacks++) {
        OWN(World) *world = make_boxes(stacks ? 40 : 120, stacks);
        const ContactProblem *problem = next_problem(world);
        OWN(ContactSolution) found = make_solution(problem), swept = make_solution(problem);
        solve_with(&solver_interior, "near=0.00005", problem, &found);
        solve_with(&solver_momentum, "k=1", problem, &swept);
        assert_int_equal(found.fallbacks.by_sweeps, !stacks);
        assert_true(residual_of(problem, &found) < residual_of(problem, &swept) / 10);
    }
}

FIXTURE(free_reference) { reference_free(&reference); }

RUN_TESTS(NULL, free_reference)
