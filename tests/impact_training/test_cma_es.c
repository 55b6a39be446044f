/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "impact_training/cma_es.h"

#include <math.h>

/* The Rosenbrock function in six dimensions: 0 at (1, ..., 1) in a curved valley that needs an adapted covariance. */
static double rosenbrock(void *context, const double *x) {
    int *calls = context;
    (*calls)++;
    double sum = 0;
    for (int i = 0; i + 1 < 6; i++) sum += 100 * pow(x[i + 1] - x[i] * x[i], 2) + pow(1 - x[i], 2);
    return sum;
}

static void rosenbrock_is_minimised(void **state) {
    (void)state;
    int calls = 0;
    Error error = {0};
    double x[6] = {-0.5, 0.2, 0.8, 0, 0.3, -0.2};
    const CmaEs task = {6, 0.3, 600, 1, rosenbrock, &calls};
    assert_ok(cma_es_minimize(&task, x, NULL, &error), error);
    for (int i = 0; i < 6; i++) assert_near(x[i], 1, 1e-6);
    assert_int_equal(calls, 1 + 600 * 9);
}

static void same_seed_same_bits(void **state) {
    (void)state;
    double x[3][6] = {{0}};
    for (int i = 0; i < 3; i++) {
        int calls = 0;
        Error error = {0};
        const CmaEs task = {6, 0.3, 20, i == 2, rosenbrock, &calls};
        assert_ok(cma_es_minimize(&task, x[i], NULL, &error), error);
    }
    assert_memory_equal(x[0], x[1], sizeof x[0]);
    assert_memory_not_equal(x[0], x[2], sizeof x[0]);
}

static double one_number(void *context, const double *x) {
    (void)context;
    return (x[0] - 3) * (x[0] - 3);
}

static bool stop_at_ten(void *context, double done, double total) {
    (void)context, (void)total;
    return done < 10;
}

static void a_stopped_search_keeps_the_best(void **state) {
    (void)state;
    double x[1] = {0};
    Error error = {0};
    const CmaEs task = {1, 0.5, 100000000, 1, one_number, NULL};
    assert_ok(cma_es_minimize(&task, x, &(Progress){stop_at_ten, NULL}, &error), error);
    assert_near(x[0], 3, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(rosenbrock_is_minimised), cmocka_unit_test(same_seed_same_bits),
                                       cmocka_unit_test(a_stopped_search_keeps_the_best)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
