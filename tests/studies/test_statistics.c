/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Curves of error over time, in closed form. */
#include "testing.h"

#include "studies/statistics.h"

enum { POINTS = 4 };

/* error = 3 us^-1.7: a straight line in logarithms. */
static double power_law(double us) { return 3 * pow(us, -1.7); }

TEST(points_on_a_power_law_give_it_exactly) {
    CurvePoint points[POINTS] = {{40, 0}, {2, 0}, {7, 0}, {100, 0}};
    for (int i = 0; i < POINTS; i++) points[i].error = power_law(points[i].us);
    assert_int_equal(error_curve_front(points, POINTS), POINTS);
    for (double us = 2; us <= 100; us *= 1.01) {
        CurveReach reach;
        const double found = error_curve_at(points, POINTS, us, &reach);
        assert_near(found / power_law(us), 1, 1e-13);
        assert_int_equal(reach, CURVE_WITHIN);
    }
}

TEST(a_curve_has_no_error_before_its_quickest_setting_and_keeps_its_last) {
    const CurvePoint points[] = {{2, 0.5}, {8, 0.125}};
    CurveReach reach;
    assert_true(isnan(error_curve_at(points, 2, 1.999, &reach)));
    assert_int_equal(reach, CURVE_BEFORE);
    assert_near(error_curve_at(points, 2, 2, &reach), 0.5, 0);
    assert_int_equal(reach, CURVE_WITHIN);
    assert_near(error_curve_at(points, 2, 4, &reach), 0.25, 1e-15); /* the geometric mean of both */
    assert_near(error_curve_at(points, 2, 8, &reach), 0.125, 0);
    assert_int_equal(reach, CURVE_WITHIN);
    assert_near(error_curve_at(points, 2, 1000, &reach), 0.125, 0);
    assert_int_equal(reach, CURVE_BEYOND);
}

TEST(settings_that_another_beats_are_no_corners) {
    CurvePoint points[] = {{9, 0.3}, {3, 0.2}, {1, 0.5}, {3, 0.4}, {4, 0.2}, {8, 0.1}};
    const CurvePoint expected[] = {{1, 0.5}, {3, 0.2}, {8, 0.1}};
    assert_int_equal(error_curve_front(points, 6), 3);
    for (int i = 0; i < 3; i++) assert_true(points[i].us == expected[i].us && points[i].error == expected[i].error);
}

RUN_TESTS(NULL, NULL)
