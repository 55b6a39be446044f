/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The block solver: its fast bits against its plain text, and the two-point problem in closed form. test_rivals.c has
   what all rivals must keep. */
#include "kernels.h"

#include "random_problem.h"
#include "methods/sweeps.h"
#include "worlds.h"

TEST(random_problems_have_the_bits_of_the_plain_text) {
    static RandomProblem random;
    uint32_t seed = 23;
    const int counts[] = {1, 2, 10, 17, 40};
    for (int c = 0; c < 5; c++) {
        char text[16];
        snprintf(text, sizeof text, "k=%d", counts[c]);
        ContactSolver block = make_solver(&solver_block, text);
        for (int i = 0; i < 100; i++) {
            int bodies = 2 + (7 * i) % (BODIES_MAX - 1);
            make_random(&random, &seed, bodies, i % 2 == 0 ? 0.5f : 4.0f / (float)bodies, i % 4 == 0 ? 30.0f : 2.0f);
            if (i % 5 == 0) calm_down(&random, &seed);
            if (i % 3 == 0)
                for (int k = 1; k < random.problem.contact_count; k += 3)
                    random.contacts[k].arm_a = random.contacts[k - 1].arm_a,
                    random.contacts[k].arm_b = random.contacts[k - 1].arm_b;
            ContactSolution plain = make_solution(&random.problem), found = make_solution(&random.problem);
            block_solve(&random.problem, counts[c], &plain);
            assert_ok(solver_block.solve(block.state, &random.problem, &found, &error), error);
            assert_same_bits(&random.problem, &found, &plain, text);
            free_solution(&plain);
            free_solution(&found);
        }
        free_solver(&block);
    }
}

/* A unit box of mass 2 on the ground, touching at its two lower corners, or at two points so far apart. */
typedef struct Landing {
    ProblemBody bodies[2];
    ContactPoint contacts[2];
    ContactProblem problem;
} Landing;

static void make_landing(Landing *landing, Vec2 velocity, float spin, float left, float right) {
    const float mass = 2, inertia = mass / 6;
    *landing = (Landing){.bodies[1] = {.inv_mass = 1 / mass, .inv_inertia = 1 / inertia, .velocity = velocity}};
    landing->bodies[1].angular_velocity = spin;
    const float xs[2] = {left, right};
    for (int k = 0; k < 2; k++) {
        float masses[2] = {1 / mass + xs[k] * xs[k] / inertia, 1 / mass + 0.25f / inertia};
        landing->contacts[k] = (ContactPoint){.a = 0,
                                              .b = 1,
                                              .normal = {0, 1},
                                              .arm_a = {xs[k], 10},
                                              .arm_b = {xs[k], -0.5f},
                                              .mass_normal = 1 / masses[0],
                                              .mass_tangent = 1 / masses[1]};
    }
    landing->problem =
        (ContactProblem){.body_count = 2, .contact_count = 2, .marked = -1, .dt = world_dt, .bodies = landing->bodies};
    landing->problem.contacts = landing->contacts;
}

static void solve_once(const ContactSolverKind *kind, const Landing *landing, ContactSolution *solution) {
    ContactSolver solver = make_solver(kind, "k=1");
    Error error = {0};
    assert_ok(kind->solve(solver.state, &landing->problem, solution, &error), error);
    free_solver(&solver);
}

/* Falling and turning a little: p1 + p2 = m v and (p2 - p1) / 2 = -I w stop it, and both push. */
TEST(a_box_on_two_points_stops_in_one_sweep) {
    Landing landing;
    make_landing(&landing, vec2(0, -3), 1.5f, -0.5f, 0.5f);
    ContactSolution found = make_solution(&landing.problem);
    solve_once(&solver_block, &landing, &found);
    assert_near(found.velocities[1].linear.y, 0, 1e-6);
    assert_near(found.velocities[1].angular, 0, 1e-6);
    assert_near(found.impulses[0].normal, 3 + 0.5, 1e-5);
    assert_near(found.impulses[1].normal, 3 - 0.5, 1e-5);
    solve_once(&solver_engine, &landing, &found);
    assert_true(fabsf(found.velocities[1].angular) > 0.1f);
    free_solution(&found);
}

/* v >= 0, x >= 0, v x = 0 at both points, whatever comes: and all four cases do come. */
TEST(one_sweep_solves_the_complementarity_problem) {
    uint32_t seed = 29;
    int cases[4] = {0};
    for (int i = 0; i < 500; i++) {
        Landing landing;
        Vec2 velocity = vec2(uniform(&seed, -3, 3), uniform(&seed, -3, 3));
        make_landing(&landing, velocity, uniform(&seed, -9, 9), uniform(&seed, -0.5f, -0.1f), uniform(&seed, 0, 0.5f));
        landing.contacts[0].bias = uniform(&seed, 0, 0.5f);
        landing.contacts[1].warm_normal = uniform(&seed, 0, 1);
        ContactSolution found = make_solution(&landing.problem);
        solve_once(&solver_block, &landing, &found);
        for (int k = 0; k < 2; k++) {
            const ContactPoint *contact = &landing.contacts[k];
            float v = found.velocities[1].linear.y + found.velocities[1].angular * contact->arm_b.x - contact->bias;
            float x = found.impulses[k].normal;
            assert_true(v >= -2e-5f && x >= 0);
            assert_near(v * x, 0, 2e-4);
        }
        cases[2 * (found.impulses[0].normal > 0) + (found.impulses[1].normal > 0)]++;
        free_solution(&found);
    }
    for (int i = 0; i < 4; i++) assert_true(cases[i] > 10);
}

/* Points that coincide have no inverse: then one by one, and the box stops all the same. */
TEST(points_that_coincide_are_solved_one_by_one) {
    Landing landing;
    make_landing(&landing, vec2(0, -3), 0, -0.5f, 0.5f);
    assert_true(block_make(&landing.contacts[0], &landing.contacts[1], landing.bodies).inverse_determinant > 0);
    make_landing(&landing, vec2(0, -3), 0, 0, 0.001f);
    assert_true(block_make(&landing.contacts[0], &landing.contacts[1], landing.bodies).inverse_determinant == 0);
    ContactSolution found = make_solution(&landing.problem);
    solve_once(&solver_block, &landing, &found);
    assert_near(found.velocities[1].linear.y, 0, 1e-3);
    assert_near(found.impulses[0].normal + found.impulses[1].normal, 2 * 3, 1e-2);
    free_solution(&found);
}

/* Where numbers overflow the order of visits shows; then the plain text decides. */
TEST(what_overflows_has_the_bits_of_the_plain_text) {
    static RandomProblem random;
    uint32_t seed = 31;
    make_random(&random, &seed, 60, 0.1f, 1);
    random.contacts[40].mass_tangent = 1e38f;
    random.contacts[40].friction = random.contacts[41].friction = 1e30f;
    ContactSolution plain = make_solution(&random.problem), found = make_solution(&random.problem);
    block_solve(&random.problem, 10, &plain);
    ContactSolver block = make_solver(&solver_block, "k=10");
    assert_ok(solver_block.solve(block.state, &random.problem, &found, &error), error);
    int lost = 0;
    for (int i = 0; i < random.problem.body_count; i++) lost += !isfinite(plain.velocities[i].linear.x);
    assert_true(lost > 0);
    assert_memory_equal(found.velocities, plain.velocities,
                        (size_t)random.problem.body_count * sizeof *plain.velocities);
    free_solver(&block);
    free_solution(&plain);
    free_solution(&found);
}

RUN_TESTS(NULL, NULL)
