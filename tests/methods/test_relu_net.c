/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The network of rectifiers is the engine: visit by visit, branch by branch. On the scenes' frames:
   tests/runs/test_relu_net.c. */
#include "consistent.h"
#include "kernels.h"
#include "random_problem.h"

/* Where a visit may end: the contact pulls and is let go, or it pushes and rubs at the lower end of the cone, within, or
   at the upper end. */
enum { LET_GO, LOWER, INSIDE, UPPER, BRANCHES };

/* Solves one contact by one visit. Without a limit the engine's tangent impulse is the w of the identity. At the lower
   end -m + 0 - 0 is exact. Elsewhere w + m, the sum of -m and it, w - m and the difference are each rounded by at most
   2^-24 of themselves: together by no more than 4 max(|w|, m) 2^-24. Returns where the visit ended. */
static int check_visit(RandomProblem *random) {
    ContactProblem *problem = &random->problem;
    ContactSolution net = make_solution(problem), engine = make_solution(problem), free_to_rub = make_solution(problem);
    solve_with(&solver_relu_net, "k=1", problem, &net);
    solve_with(&solver_engine, "k=1", problem, &engine);
    const float friction = random->contacts[0].friction;
    random->contacts[0].friction = 1e30f;
    solve_with(&solver_engine, "k=1", problem, &free_to_rub);
    const ContactImpulse is = net.impulses[0], expected = engine.impulses[0];
    const float w = free_to_rub.impulses[0].tangent, limit = friction * expected.normal;
    const double most = (double)fmaxf(fabsf(w), limit);
    int branch = expected.normal <= 0 ? LET_GO : w <= -limit ? LOWER : w >= limit ? UPPER : INSIDE;
    assert_near(is.normal, expected.normal, 0);
    assert_near(is.tangent, expected.tangent, branch <= LOWER ? 0 : ldexp(4 * most, -24));
    free_solution(&net);
    free_solution(&engine);
    free_solution(&free_to_rub);
    return branch;
}

TEST(a_visit_takes_the_engines_branch) {
    uint32_t seed = 1;
    int met[BRANCHES] = {0};
    RandomProblem random;
    for (int run = 0; run < 5000; run++) {
        make_random(&random, &seed, 2, 1, 1);
        random.problem.contact_count = 1;
        met[check_visit(&random)]++;
    }
    for (int branch = 0; branch < BRANCHES; branch++) assert_true(met[branch] > 100);
}

TEST(momentum_is_kept) {
    uint32_t seed = 3;
    for (int run = 0; run < 50; run++) {
        RandomProblem random;
        double before[2], after[2];
        make_random(&random, &seed, 20, 0.1f, 1);
        for (int i = 0; i < random.problem.body_count; i++)
            random.bodies[i].inv_mass = fmaxf(random.bodies[i].inv_mass, 0.1f);
        ContactSolution found = make_solution(&random.problem);
        BodyVelocity start[BODIES_MAX];
        for (int i = 0; i < random.problem.body_count; i++)
            start[i] = (BodyVelocity){random.bodies[i].velocity, random.bodies[i].angular_velocity};
        linear_momentum(&random.problem, NULL, before);
        solve_with(&solver_relu_net, "", &random.problem, &found);
        linear_momentum(&random.problem, found.velocities, after);
        for (int i = 0; i < 2; i++) assert_near(before[i], after[i], 1e-3);
        assert_memory_not_equal(start, found.velocities, sizeof *start * (size_t)random.problem.body_count);
        free_solution(&found);
    }
}

RUN_TESTS(NULL, NULL)
