/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The iterations on a tape: the kernels' answers, and derivatives against finite differences. */
#include "testing.h"

#include "interior_training/random_scene.h"
#include "interior_training/recording.h"
#include "interior_training/unrolled_interior.h"
#include "reference/solution_error.h"
#include "solvers/interior_net.h"
#include "solvers/momentum.h"
#include "solvers/solvers.h"

#include <math.h>

static ImpactProblems problems;
static UnrolledInterior unrolled;

static bool by_momentum(void *context, int number, ContactSolver *solver, Error *error) {
    (void)context, (void)number;
    const Settings none = {0};
    void *state = solver_momentum.create(&none, error);
    *solver = (ContactSolver){&solver_momentum, state};
    return state != NULL;
}

static int record(void **state) {
    (void)state;
    Error error = {0};
    const Recording recording = {.seed = 5, .scenes = 14, .make_solver = by_momentum};
    assert_ok(recording_run(&recording, &problems, NULL, &error), error);
    return problems.count > 50 ? 0 : -1;
}

static int forget(void **state) {
    (void)state;
    impact_problems_free(&problems);
    unrolled_interior_free(&unrolled);
    return 0;
}

static void any_weights(InteriorNet *net, double size) {
    uint32_t seed = 9;
    for (int i = 0; i < INTERIOR_NET_WEIGHTS; i++) {
        seed = seed * 1664525 + 1013904223;
        net->weights[i] = (double)(float)(size * ((double)(seed >> 8) * 0x1p-23 - 1));
    }
}

/* The error of the kernels' answer after some iterations; infinite if they broke down. */
static double error_of(const ImpactProblem *item, const InteriorNet *net, int iterations) {
    float factors[INTERIOR_IMPACT_SWEEPS];
    Sweeps sweeps = {0};
    Interior interior = {.net = net};
    BodyVelocity velocities[RANDOM_SCENE_BODIES + 1];
    ContactSolution solution = {
        velocities, calloc((size_t)item->problem.contact_count + 1, sizeof(ContactImpulse)), 0, {0}};
    assert_true(sweeps_begin_coloured(&sweeps, sweeps_best_kernel(), &item->problem));
    for (int s = 0; s < INTERIOR_IMPACT_SWEEPS; s++) factors[s] = momentum_factor_tuned(s, INTERIOR_IMPACT_SWEEPS);
    assert_true(sweeps_run_momentum(&sweeps, factors, INTERIOR_IMPACT_SWEEPS));
    assert_true(interior_load(&interior, interior_best(), &sweeps, &item->problem));
    interior_iterate(&interior, interior_best(), &interior_quick, INTERIOR_IMPACT_SCALE, 1e6, 0, iterations);
    const bool finite = interior_end(&interior, &sweeps, &item->problem, &solution);
    const double found = finite && isfinite(interior.residual)
                             ? solution_error(&item->problem, velocities, item->reference).rms
                             : INFINITY;
    free(solution.impulses);
    interior_free(&interior);
    sweeps_free(&sweeps);
    return found;
}

/* Three iterations, before rounding is amplified. Errors round to float velocities. */
static void the_tape_has_the_answers_of_the_kernels(void **state) {
    (void)state;
    enum { ITERATIONS = 3 };
    const InteriorTask task = {.first = 1, .last = ITERATIONS, .floor = 1};
    int different = 0, compared = 0, broken = 0;
    InteriorNet nets[2] = {{.command = ""}, {.command = ""}};
    any_weights(&nets[1], 0.4);
    for (size_t i = 0; i < problems.count; i++) {
        double loss;
        const ImpactProblem *item = &problems.items[i];
        const InteriorNet *net = &nets[i % 2];
        assert_true(
            unrolled_interior_loss(&unrolled, &item->problem, item->reference, net->weights, &task, &loss, NULL));
        for (int k = 0; k < ITERATIONS; k++) {
            const double found = unrolled.errors[k], expected = error_of(item, net, k + 1);
            broken += !isfinite(expected);
            if (!isfinite(expected)) continue;
            compared++;
            different += !(fabs(found - expected) <= 1e-5 + 1e-4 * expected);
        }
    }
    /* Kernels stop where the residual is exactly 0. */
    if (different > compared / 100) fail_msg("%d of %d answers differ", different, compared);
    assert_true(broken < compared / 20);
}

/* Central differences, where those to both sides agree: at a kink there is no derivative. */
static void derivatives_are_those_of_finite_differences(void **state) {
    (void)state;
    const InteriorTask task = {.first = 2, .last = 4, .floor = 0.01, .tail = 0.3};
    const double step = 1e-6;
    InteriorNet net = {.command = ""};
    int kinks = 0, compared = 0;
    any_weights(&net, 0.4);
    for (size_t i = 0; i < problems.count; i += 5) {
        const ImpactProblem *item = &problems.items[i];
        double slopes[INTERIOR_NET_WEIGHTS] = {0}, here, there, before;
        assert_true(
            unrolled_interior_loss(&unrolled, &item->problem, item->reference, net.weights, &task, &here, slopes));
        for (int k = 0; k < INTERIOR_NET_WEIGHTS; k++) {
            const double kept = net.weights[k];
            net.weights[k] = kept + step;
            unrolled_interior_loss(&unrolled, &item->problem, item->reference, net.weights, &task, &there, NULL);
            net.weights[k] = kept - step;
            unrolled_interior_loss(&unrolled, &item->problem, item->reference, net.weights, &task, &before, NULL);
            net.weights[k] = kept;
            const double right = (there - here) / step, left = (here - before) / step;
            const double tolerance = 1e-4 + 1e-2 * fabs(right);
            compared++;
            if (!(fabs(right - left) <= tolerance))
                kinks++;
            else if (!(fabs(slopes[k] - (right + left) / 2) <= tolerance))
                fail_msg("problem %zu, weight %d: %g, not %g", i, k, slopes[k], (right + left) / 2);
        }
    }
    if (kinks > compared / 10) fail_msg("%d of %d at a kink", kinks, compared);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_tape_has_the_answers_of_the_kernels),
                                       cmocka_unit_test(derivatives_are_those_of_finite_differences)};
    return cmocka_run_group_tests(tests, record, forget);
}
