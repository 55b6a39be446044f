/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Round numbers are 1, 2 or 5 times a power of ten, the nearest on either side, and themselves. */
#include "testing.h"

#include "base/numbers.h"

TEST(round_numbers_are_the_nearest) {
    static const double digits[] = {1, 2, 5, 10};
    for (int exponent = -9; exponent < 9; exponent++)
        for (int i = 0; i < 3; i++) {
            const double low = digits[i] * pow(10, exponent), high = digits[i + 1] * pow(10, exponent);
            for (double share = 0.01; share < 1; share += 0.07) {
                const double between = low + share * (high - low);
                assert_near(round_down(between) / low, 1, 1e-15);
                assert_near(round_up(between) / high, 1, 1e-15);
            }
        }
    for (int exponent = 0; exponent < 9; exponent++)
        for (int i = 0; i < 3; i++) {
            const double round = digits[i] * pow(10, exponent);
            assert_true(round_down(round) == round && round_up(round) == round);
        }
}

RUN_TESTS(NULL, NULL)
