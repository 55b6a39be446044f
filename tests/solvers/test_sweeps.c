/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fast sweeps have the bits of the plain text, on problems that no scene would give. */
#include "kernels.h"

#include "collision/uniform.h"
#include "worlds.h"

#include <math.h>

enum { BODIES_MAX = 80, CONTACTS_MAX = 500 };

typedef struct RandomProblem {
    ProblemBody bodies[BODIES_MAX];
    ContactPoint contacts[CONTACTS_MAX];
    ContactProblem problem;
} RandomProblem;

/* A zero of either sign now and then: sums and clamps must keep them apart. */
static float any_number(uint32_t *seed, float size) {
    float kind = uniform(seed, 0, size > 0 ? 1 : 0.2f);
    if (kind < 0.1f) return 0.0f;
    if (kind < 0.2f) return -0.0f;
    return uniform(seed, -size, size);
}

static Vec2 any_vector(uint32_t *seed, float size) {
    float x = any_number(seed, size), y = any_number(seed, size);
    return vec2(x, y);
}

static ContactPoint random_point(uint32_t *seed, int a, int b, Vec2 normal, float friction) {
    return (ContactPoint){.a = a,
                          .b = b,
                          .normal = normal,
                          .arm_a = any_vector(seed, 2),
                          .arm_b = any_vector(seed, 2),
                          .mass_normal = uniform(seed, 0.01f, 0.2f),
                          .mass_tangent = uniform(seed, 0.01f, 0.2f),
                          .friction = friction,
                          .bias = any_number(seed, 1),
                          .warm_normal = fabsf(any_number(seed, 1)),
                          .warm_tangent = any_number(seed, 1)};
}

/* mass_exponent: inverse masses are spread over so many powers of ten. density: share of the pairs that touch. */
static void make_random(RandomProblem *random, uint32_t *seed, int bodies, float density, float mass_exponent) {
    for (int i = 0; i < bodies; i++) {
        bool fixed = uniform(seed, 0, 1) < 0.15f;
        float inverse = fixed ? 0.0f : powf(10, uniform(seed, -mass_exponent, 0));
        random->bodies[i] = (ProblemBody){.inv_mass = inverse,
                                          .inv_inertia = 3 * inverse,
                                          .velocity = any_vector(seed, 10),
                                          .angular_velocity = any_number(seed, 5)};
    }
    int contacts = 0;
    for (int a = 0; a < bodies; a++) {
        for (int b = a + 1; b < bodies && contacts + 3 <= CONTACTS_MAX; b++) {
            if (uniform(seed, 0, 1) > density) continue;
            float angle = uniform(seed, -3, 3), friction = fabsf(any_number(seed, 1));
            int points = 1 + (int)uniform(seed, 0, 2.99f);
            for (int k = 0; k < points; k++)
                random->contacts[contacts++] = random_point(seed, a, b, mat22_rotation(angle).column1, friction);
        }
    }
    random->problem = (ContactProblem){.body_count = bodies,
                                       .contact_count = contacts,
                                       .bomb = -1,
                                       .dt = world_dt,
                                       .bodies = random->bodies,
                                       .contacts = random->contacts};
}

/* All at rest, and nothing but zeros of either sign to compute with. */
static void calm_down(RandomProblem *random, uint32_t *seed) {
    for (int i = 0; i < random->problem.body_count; i++) {
        random->bodies[i].velocity = any_vector(seed, 0);
        random->bodies[i].angular_velocity = any_number(seed, 0);
    }
    for (int i = 0; i < random->problem.contact_count; i++) {
        random->contacts[i].bias = any_number(seed, 0);
        random->contacts[i].warm_normal = any_number(seed, 0);
        random->contacts[i].warm_tangent = any_number(seed, 0);
    }
}

static void random_problems_have_the_bits_of_the_plain_text(void **state) {
    (void)state;
    static RandomProblem random;
    Sweeps sweeps[SWEEP_KERNELS] = {{0}};
    uint32_t seed = 3;
    const int iterations[] = {1, 2, 10, 16, 17, 40};
    for (int i = 0; i < 600; i++) {
        int bodies = 2 + i % (BODIES_MAX - 1);
        const float densities[] = {0.5f, 4.0f / (float)bodies, 0.7f / (float)bodies};
        make_random(&random, &seed, bodies, densities[i % 3], i % 4 == 0 ? 30.0f : 2.0f);
        if (i % 5 == 0) calm_down(&random, &seed);
        const SequentialOptions options = {
            .accumulate = true, .warm = i % 7 != 0, .relaxation = i % 3 == 0 ? uniform(&seed, 0.1f, 1.9f) : 1.0f};
        assert_kernels_agree(sweeps, &random.problem, &options, iterations[i % 6]);
    }
    free_kernels(sweeps);
}

/* Zeros among the factors too: they leave the sign of a zero. */
static void random_problems_with_momentum_have_the_bits_of_the_plain_text(void **state) {
    (void)state;
    static RandomProblem random;
    Sweeps sweeps[SWEEP_KERNELS] = {{0}};
    uint32_t seed = 4;
    const int iterations[] = {1, 2, 10, 16, 17, 19, 33, 40};
    for (int i = 0; i < 600; i++) {
        int bodies = 2 + i % (BODIES_MAX - 1);
        const float densities[] = {0.5f, 4.0f / (float)bodies, 0.7f / (float)bodies};
        make_random(&random, &seed, bodies, densities[i % 3], 2.0f);
        if (i % 5 == 0) calm_down(&random, &seed);
        float factors[40];
        for (int k = 0; k < 40; k++) factors[k] = fabsf(any_number(&seed, 0.7f));
        assert_momentum_kernels_agree(sweeps, &random.problem, factors, iterations[i % 8]);
    }
    free_kernels(sweeps);
}

static void momentum_of_factor_zero_has_the_bits_of_the_engine(void **state) {
    (void)state;
    static RandomProblem random;
    static const float zeros[17];
    uint32_t seed = 6;
    for (int i = 0; i < 100; i++) {
        make_random(&random, &seed, 10 + i % 60, 0.1f, 2.0f);
        ContactSolution engine = make_solution(&random.problem), before = make_solution(&random.problem);
        ContactSolution momentum = make_solution(&random.problem);
        sequential_impulses_solve(&random.problem, &engine_options, 17, &engine);
        momentum_solve_plain(&random.problem, zeros, 17, &before, &momentum);
        assert_same_bits(&random.problem, &momentum, &engine, "factors 0");
        free_solution(&engine);
        free_solution(&before);
        free_solution(&momentum);
    }
}

static int find_fixed(const RandomProblem *random) {
    int body = 0;
    while (random->bodies[body].inv_mass != 0) body++;
    return body;
}

/* The same pairs again, with other numbers: the schedule of the last step is used again. Not so when a body begins to
   move. */
static void a_kept_schedule_serves_the_same_pairs(void **state) {
    (void)state;
    static RandomProblem random;
    Sweeps sweeps[SWEEP_KERNELS] = {{0}};
    uint32_t seed = 5;
    make_random(&random, &seed, 60, 0.08f, 1);
    assert_true(random.problem.contact_count > 150);
    for (int i = 0; i < 20; i++) {
        for (int k = 0; k < random.problem.contact_count; k++) random.contacts[k].bias = any_number(&seed, 1);
        assert_kernels_agree(sweeps, &random.problem, &engine_options, 10 + i / 10);
        ProblemBody *fixed = &random.bodies[find_fixed(&random)];
        if (i % 4 == 0) fixed->inv_mass = fixed->inv_inertia = 1;
    }
    free_kernels(sweeps);
}

static void no_contacts_leave_the_velocities(void **state) {
    (void)state;
    static RandomProblem random;
    Sweeps sweeps[SWEEP_KERNELS] = {{0}};
    uint32_t seed = 9;
    make_random(&random, &seed, 30, 0, 1);
    assert_int_equal(random.problem.contact_count, 0);
    assert_kernels_agree(sweeps, &random.problem, &engine_options, 10);
    free_kernels(sweeps);
}

/* Where numbers overflow the order of visits shows; then the engine falls back to the plain text. */
static void what_overflows_has_the_bits_of_the_plain_text(void **state) {
    (void)state;
    static RandomProblem random;
    Error error = {0};
    uint32_t seed = 11;
    make_random(&random, &seed, 60, 0.1f, 1);
    random.contacts[40].mass_normal = 1e38f;
    ContactSolution plain = make_solution(&random.problem), fast = make_solution(&random.problem);
    sequential_impulses_solve(&random.problem, &engine_options, 10, &plain);
    ContactSolver engine = make_engine("");
    assert_true(engine.kind->solve(engine.state, &random.problem, &fast, &error));
    int lost = 0;
    for (int i = 0; i < random.problem.body_count; i++) {
        assert_int_equal(isfinite(plain.velocities[i].linear.x), isfinite(fast.velocities[i].linear.x));
        lost += !isfinite(plain.velocities[i].linear.x);
    }
    assert_in_range(lost, 1, random.problem.body_count);
    assert_memory_equal(fast.velocities, plain.velocities,
                        (size_t)random.problem.body_count * sizeof *plain.velocities);
    free_solver(&engine);
    free_solution(&plain);
    free_solution(&fast);
}

static void one_by_one_works_everywhere(void **state) {
    (void)state;
    assert_true(sweeps_can(SWEEP_ONE_BY_ONE));
    assert_false(sweeps_can(SWEEP_KERNELS));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_problems_have_the_bits_of_the_plain_text),
        cmocka_unit_test(random_problems_with_momentum_have_the_bits_of_the_plain_text),
        cmocka_unit_test(momentum_of_factor_zero_has_the_bits_of_the_engine),
        cmocka_unit_test(a_kept_schedule_serves_the_same_pairs), cmocka_unit_test(no_contacts_leave_the_velocities),
        cmocka_unit_test(what_overflows_has_the_bits_of_the_plain_text), cmocka_unit_test(one_by_one_works_everywhere)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
