/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The angle of a sine and a cosine is that of the maths library, after as many whole turns as before. */
#include "testing.h"

#include "nets/kinds.h"

TEST(all_directions_have_their_angle) {
    for (int i = -3000; i <= 3000; i++) {
        const double angle = i * 1e-3;
        const float length = 0.3f + 0.001f * (float)(i + 3000);
        assert_near(turn_angle(length * (float)sin(angle), length * (float)cos(angle), 0), angle, 3e-6);
    }
}

TEST(whole_turns_are_those_of_before) {
    for (int i = -400; i <= 400; i++) {
        const double before = i * 0.1, angle = before + 3 * sin(i * 0.7);
        assert_near(turn_angle((float)sin(angle), (float)cos(angle), (float)before), angle, 2e-5);
    }
}

TEST(a_quarter_is_exact) {
    assert_near(turn_angle(0, 1, 0), 0, 0);
    assert_near(turn_angle(1, 0, 0), (double)1.57079633f, 0);
    assert_near(turn_angle(-1, 0, 0), (double)-1.57079633f, 0);
}

TEST(what_has_no_direction_stays) {
    assert_near(turn_angle(0, 0, 1.25f), 1.25, 0);
    assert_near(turn_angle(NAN, NAN, 1.25f), 1.25, 0);
}

RUN_TESTS(NULL, NULL)
