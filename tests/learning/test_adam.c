/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Adam's laws. */
#include "testing.h"

#include "learning/learning.h"

/* The bias corrections cancel the decay: with equal slopes every step has the length of the rate, less epsilon over the
   slope of it: 4e-8 here. */
TEST(equal_slopes_make_steps_of_the_rate) {
    enum { STEPS = 50 };
    const double slopes[2] = {3, -0.25}, rate = 0.01;
    Adam adam;
    assert_ok(adam_create(&adam, 2, &error), error);
    for (int i = 1; i <= STEPS; i++) {
        adam_step(&adam, slopes, rate);
        assert_near(adam.weights[0], -rate * i, 4.1e-8 * rate * i);
        assert_near(adam.weights[1], rate * i, 4.1e-8 * rate * i);
    }
    adam_free(&adam);
}

TEST(the_rate_falls_by_half_a_cosine) {
    for (int i = 0; i <= 6; i++) assert_near(adam_cosine(i / 6.0), pow(cos(M_PI * i / 12), 2), 1e-7);
}

/* f(x) = (x - 3)^2 / 2 */
TEST(finds_a_minimum) {
    Adam adam;
    assert_ok(adam_create(&adam, 1, &error), error);
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

TEST(slopes_are_shortened_and_never_nan) {
    double fine[2] = {0.3, -0.4}, longer[2] = {3, -4}, bad[2] = {1, NAN};
    assert_true(slopes_limit(fine, 2, 1) && fine[0] == 0.3 && fine[1] == -0.4);
    assert_true(slopes_limit(longer, 2, 1));
    assert_near(longer[0], 0.6, 1e-15);
    assert_near(longer[1], -0.8, 1e-15);
    assert_true(!slopes_limit(bad, 2, 1) && bad[0] == 0 && bad[1] == 0);
}

RUN_TESTS(NULL, NULL)
