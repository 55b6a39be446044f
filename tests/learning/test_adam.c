/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "learning/learning.h"

#include <math.h>

/* The bias corrections cancel the decay: with equal slopes every step has the length of the rate, less epsilon over the
   slope of it: 4e-8 here. */
static void equal_slopes_make_steps_of_the_rate(void **state) {
    (void)state;
    enum { STEPS = 50 };
    const double slopes[2] = {3, -0.25}, rate = 0.01;
    Adam adam;
    Error error = {0};
    assert_ok(adam_create(&adam, 2, ADAM_SQUARE_DECAY, &error), error);
    for (int i = 1; i <= STEPS; i++) {
        adam_step(&adam, slopes, rate);
        assert_near(adam.weights[0], -rate * i, 4.1e-8 * rate * i);
        assert_near(adam.weights[1], rate * i, 4.1e-8 * rate * i);
    }
    adam_free(&adam);
}

/* f(x) = (x - 3)^2 / 2 */
static void finds_a_minimum(void **state) {
    (void)state;
    Adam adam;
    Error error = {0};
    assert_ok(adam_create(&adam, 1, 0.99, &error), error);
    for (int i = 0; i < 2000; i++) {
        const double slope = adam.weights[0] - 3;
        adam_step(&adam, &slope, 0.05 * (2000 - i) / 2000);
    }
    assert_near(adam.weights[0], 3, 1e-4);
    adam_restart(&adam);
    assert_near(adam.weights[0], 3, 1e-4);
    assert_true(adam.steps == 0 && adam.mean[0] == 0 && adam.square[0] == 0);
    adam_free(&adam);
}

/* As after a training is read from disk. */
static void continues_with_the_same_bits(void **state) {
    (void)state;
    double numbers[2][3] = {{0}};
    Adam whole = adam_over(&numbers[0][0], &numbers[0][1], &numbers[0][2], 1, 0, 0.99);
    for (int i = 0; i < 40; i++) {
        Adam part = adam_over(&numbers[1][0], &numbers[1][1], &numbers[1][2], 1, i, 0.99);
        const double slope = sqrt(i + 1.0) - 3;
        adam_step(&whole, &slope, 0.1);
        adam_step(&part, &slope, 0.1);
        assert_memory_equal(numbers[0], numbers[1], sizeof numbers[0]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_slopes_make_steps_of_the_rate),
        cmocka_unit_test(finds_a_minimum),
        cmocka_unit_test(continues_with_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
