/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method interior-net: without answers of its network it is interior, and its kernels agree. */
#include "kernels.h"
#include "random_problem.h"

#include "interior/interior.h"
#include "network/interior_net.h"
#include "solvers/solvers.h"

static void any_weights(InteriorNet *net, uint32_t *seed, float size) {
    for (int i = 0; i < INTERIOR_NET_WEIGHTS; i++) net->weights[i] = (double)uniform(seed, -size, size);
}

static void fill_heap(RandomProblem *random, uint32_t *seed, int run) {
    make_random(random, seed, 3 + run, 0.2f, 1);
    for (int i = 0; i < random->problem.contact_count; i++) random->contacts[i].friction *= 0.2f;
}

/* The hidden layer alone has no effect: its outputs have zero weights. */
static void a_silent_network_leaves_every_bit(void **state) {
    (void)state;
    static RandomProblem random;
    Error error = {0};
    uint32_t seed = 21;
    InteriorNet net = {.command = ""};
    for (int i = 0; i < INTERIOR_NET_OUTPUT_WEIGHTS; i++) net.weights[i] = (double)uniform(&seed, -1, 1);
    const char *path = temporary_path("silent.npz");
    assert_ok(interior_net_write(&net, path, &error), error);
    char settings[128];
    snprintf(settings, sizeof settings, "network=%s", path);
    for (int run = 0; run < 30; run++) {
        fill_heap(&random, &seed, run);
        ContactSolution silent = make_solution(&random.problem), without = make_solution(&random.problem);
        solve_with(&solver_interior_net, settings, &random.problem, &silent);
        solve_with(&solver_interior, "", &random.problem, &without);
        assert_same_bits(&random.problem, &silent, &without, "silent network");
        free_solution(&silent);
        free_solution(&without);
    }
}

static void answer(const ContactProblem *problem, const InteriorKernels *kernels, const InteriorNet *net,
                   ContactSolution *found) {
    Sweeps sweeps = {0};
    Interior interior = {.net = net};
    assert_true(sweeps_begin_coloured(&sweeps, SWEEP_ONE_BY_ONE, problem));
    assert_true(sweeps_run(&sweeps, 2));
    assert_true(interior_load(&interior, kernels, &sweeps, problem));
    interior_iterate(&interior, kernels, &interior_quick, 0.01, 1e6, 1e-4, 6);
    interior_end(&interior, &sweeps, problem, found);
    interior_free(&interior);
    sweeps_free(&sweeps);
}

static void kernels_have_the_same_bits_and_the_network_counts(void **state) {
    (void)state;
    static RandomProblem random;
    uint32_t seed = 4;
    int changed = 0;
    for (int run = 0; run < 40; run++) {
        InteriorNet net = {.command = ""};
        any_weights(&net, &seed, 0.5f);
        fill_heap(&random, &seed, run);
        ContactSolution scalar = make_solution(&random.problem), best = make_solution(&random.problem),
                        without = make_solution(&random.problem);
        answer(&random.problem, &interior_scalar, &net, &scalar);
        answer(&random.problem, interior_best(), &net, &best);
        answer(&random.problem, interior_best(), NULL, &without);
        assert_same_bits(&random.problem, &best, &scalar, "interior-net");
        changed += memcmp(best.velocities, without.velocities,
                          (size_t)random.problem.body_count * sizeof *best.velocities) != 0;
        free_solution(&scalar);
        free_solution(&best);
        free_solution(&without);
    }
    assert_true(changed > 20);
}

static void a_file_is_needed_and_checked(void **state) {
    (void)state;
    Settings settings = {0};
    Error error = {0};
    assert_refused(solver_interior_net.create(&settings, &error), "interior-net:network=FILE");
    assert_true(settings_default(&settings, "network", "/dev/null"));
    assert_refused(solver_interior_net.create(&settings, &error), "/dev/null");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_silent_network_leaves_every_bit),
                                       cmocka_unit_test(kernels_have_the_same_bits_and_the_network_counts),
                                       cmocka_unit_test(a_file_is_needed_and_checked)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
