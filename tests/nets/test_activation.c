/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "nets/nets.h"

#include <float.h>

static float from_bits(uint32_t bits) {
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* The distance of two floats near `exact` that follow each other. */
static double last_place(long double exact) {
    int exponent;
    frexpl(exact, &exponent);
    return ldexp(1, exponent - 24);
}

static void assert_close(float found, long double exact, float x) {
    double distance = (double)fabsl((long double)found - exact) / last_place(exact);
    if (!(distance <= 3)) fail_msg("%.9g at %.9g is %.3f units in the last place off", found, x, distance);
}

/* Every 997th float from the smallest to past the end of both functions, of both signs. */
TEST(float_stays_within_three_last_places) {
    for (uint32_t bits = 1; from_bits(bits) < 100; bits += 997)
        for (int sign = 0; sign < 2; sign++) {
            float x = sign ? -from_bits(bits) : from_bits(bits);
            long double exact = 1 / (1 + expl(-(long double)x));
            if (exact >= (long double)FLT_MIN) assert_close(sigmoid_float(x), exact, x);
            if (fabsf(x) >= FLT_MIN) assert_close(tanh_float(x), tanhl(x), x);
        }
}

TEST(double_is_relatively_exact) {
    for (int i = -60000; i <= 60000; i++) {
        double x = i * 0.0115 + 1e-5, y = i * 5e-4 + 1e-9;
        long double s = 1 / (1 + expl(-(long double)x)), t = tanhl(y);
        assert_true(fabsl((long double)sigmoid(x) - s) <= 4e-16L * s);
        assert_true(fabsl((long double)tangent(y) - t) <= 4e-16L * fabsl(t));
    }
}

TEST(exponential_stays_within_its_last_places) {
    double before = 0;
    for (int i = -700000; i <= 700000; i++) {
        const double y = i * 1e-3, found = exponential(y);
        const long double exact = expl((long double)y);
        int exponent;
        frexpl(exact, &exponent);
        assert_true(fabsl((long double)found - exact) <= ldexpl(1.25L, exponent - 53));
        assert_true(found > before);
        assert_near(log(found), y, 4e-16 + 3e-16 * fabs(y));
        before = found;
    }
    assert_true(exponential(0) == 1 && exponential(-0.0) == 1 && isnan(exponential(NAN)));
}

/* Double after double, where the power of two changes: odd multiples of ln 2 / 2. */
TEST(exponential_never_falls) {
    for (int k = -1999; k < 2000; k += 2) {
        double y = k * 0.34657359027997264;
        for (int i = 0; i < 500; i++) y = nextafter(y, -INFINITY);
        double before = exponential(y);
        for (int i = 0; i < 1000; i++) {
            y = nextafter(y, INFINITY);
            const double found = exponential(y);
            assert_true(found >= before);
            before = found;
        }
    }
}

TEST(limits_are_exact) {
    const float huge[] = {89, 1000, 1e7f, 1e20f, FLT_MAX, INFINITY};
    for (size_t i = 0; i < sizeof huge / sizeof huge[0]; i++) {
        float x = huge[i];
        assert_true(sigmoid_float(x) == 1 && sigmoid_float(-x) == 0);
        assert_true(tanh_float(x) == 1 && tanh_float(-x) == -1);
        assert_true(sigmoid(10 * (double)x) == 1 && sigmoid(-10 * (double)x) < 1e-300);
        assert_true(tangent((double)x) == 1 && tangent(-(double)x) == -1);
    }
    assert_true(sigmoid_float(0) == 0.5f && sigmoid_float(-0.0f) == 0.5f && sigmoid(0) == 0.5);
    assert_true(tanh_float(0) == 0 && tangent(0) == 0 && signbit(tanh_float(-0.0f)));
    assert_true(sigmoid_float(1e-30f) == 0.5f && tanh_float(1e-30f) == 1e-30f);
    assert_true(isnan(sigmoid_float(NAN)) && isnan(tanh_float(NAN)) && isnan(sigmoid(NAN)) && isnan(tangent(NAN)));
}

TEST(relu_keeps_nan_and_the_sign_of_zero) {
    assert_true(relu_float(2.5f) == 2.5f && relu_float(-2.5f) == 0 && relu(2.5) == 2.5 && relu(-2.5) == 0);
    assert_true(relu_float(INFINITY) == INFINITY && relu_float(-INFINITY) == 0);
    assert_true(isnan(relu_float(NAN)) && isnan(relu((double)NAN)));
    assert_true(signbit(relu_float(-0.0f)) && signbit(relu(-0.0)));
    assert_true(!signbit(relu_float(-FLT_MIN)) && !signbit(relu(-1e-300)));
}

RUN_TESTS(NULL, NULL)
