/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference has the same bits on all instruction sets, on problems that no scene would give. */
#include "reference_kernels.h"

#include "random_problem.h"
#include "sanitized.h"

/* Fixed bodies do not move and nothing is pushed apart, so that all at rest is what every contact allows. */
static void make_solvable(RandomProblem *random) {
    for (int i = 0; i < random->problem.body_count; i++)
        if (random->bodies[i].inv_mass == 0)
            random->bodies[i].velocity = vec2(0, 0), random->bodies[i].angular_velocity = 0;
    for (int i = 0; i < random->problem.contact_count; i++)
        random->contacts[i].bias = fminf(random->contacts[i].bias, 0);
}

/* Most of the problems have no solution as they are: every attempt is made, which takes long. So few remain so. */
TEST(random_problems_have_the_bits_of_scalar_code) {
    static RandomProblem random;
    ReferenceKernels kernels = {.plain = {.scalar = true}};
    uint32_t seed = 3;
    for (int i = 0, count = 0; i < 600; i += 3 * sampled(7), count++) {
        const bool solvable = count % 25 != 7;
        int bodies = 2 + i % (BODIES_MAX - 1);
        const float densities[] = {0.5f, 4.0f / (float)bodies, 0.7f / (float)bodies};
        make_random(&random, &seed, bodies, densities[count % 3], 2.0f);
        if (i % 5 == 0) calm_down(&random, &seed);
        if (solvable) make_solvable(&random);
        assert_reference_kernels_agree(&kernels, &random.problem);
        assert_true(!solvable || kernels.plain.residual <= REFERENCE_TOLERANCE);
    }
    reference_kernels_free(&kernels);
}

TEST(a_body_with_very_many_contacts_has_the_bits_of_scalar_code) {
    static RandomProblem random;
    ReferenceKernels kernels = {.plain = {.scalar = true}};
    uint32_t seed = 5;
    make_random(&random, &seed, BODIES_MAX, 0, 1);
    for (int i = 0; i < BODIES_MAX; i++) random.bodies[i].inv_mass = random.bodies[i].inv_inertia = 1;
    for (int i = 1; i < BODIES_MAX; i++) random.contacts[i - 1] = random_point(&seed, 0, i, vec2(0, 1), 0.5f);
    random.problem.contact_count = BODIES_MAX - 1;
    assert_reference_kernels_agree(&kernels, &random.problem);
    reference_kernels_free(&kernels);
}

RUN_TESTS(NULL, NULL)
