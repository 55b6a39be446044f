/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Looks of verdicts: distinguishable in grey too. */
#include "testing.h"

#include "studies/stability.h"
#include "studies/stability_internal.h"

/* CIE 1931 luminance from sRGB, as in a grey print. */
static double luminance(uint32_t rgb) {
    double sum = 0;
    static const double weights[] = {0.2126, 0.7152, 0.0722};
    for (int i = 0; i < 3; i++) {
        double value = (rgb >> (16 - 8 * i) & 255u) / 255.0;
        sum += weights[i] * (value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4));
    }
    return sum;
}

/* CIE 1976 L*, 0 to 100. */
static double lightness(uint32_t colour) { return 116 * cbrt(luminance(colour)) - 16; }

TEST(the_worse_the_darker) {
    /* Of scenes at rest, and struck ones; a program that failed says nothing of the physics. */
    static const Verdict orders[2][9] = {{VERDICT_SETTLES, VERDICT_MOVES, VERDICT_FALLS, VERDICT_SINKS, VERDICT_TUNNELS,
                                          VERDICT_EXPLODES, VERDICT_NON_FINITE},
                                         {VERDICT_STANDS, VERDICT_FALLS, VERDICT_COLLAPSES, VERDICT_SINKS}};
    for (int order = 0; order < 2; order++)
        for (int i = 1; orders[order][i] != 0; i++) {
            const VerdictLook *better = &verdict_looks[orders[order][i - 1]], *worse = &verdict_looks[orders[order][i]];
            const double step = lightness(better->fill) - lightness(worse->fill);
            if (step < 6) fail_msg("%s is darker than %s by %g only", worse->name, better->name, step);
        }
    assert_true(lightness(verdict_looks[VERDICT_MOVES].fill) > 75);
    assert_true(lightness(verdict_looks[VERDICT_FALLS].fill) < 72);
}

/* WCAG 2.1 requires a contrast of 3:1 for graphics. The dot of "settles" is meant to be faint. */
TEST(symbols_stand_out_and_differ) {
    for (int look = VERDICT_STANDS; look < VERDICTS; look++) {
        double fill = luminance(verdict_looks[look].fill) + 0.05, ink = luminance(verdict_looks[look].ink) + 0.05;
        if (fmax(fill, ink) / fmin(fill, ink) < 3) fail_msg("%s: too little contrast", verdict_looks[look].name);
        for (int other = 0; other < look; other++)
            assert_true(verdict_looks[other].symbol != verdict_looks[look].symbol ||
                        verdict_looks[other].open != verdict_looks[look].open ||
                        verdict_looks[look].size > 2 * verdict_looks[other].size);
    }
}

TEST(looks_are_those_of_the_verdicts) {
    for (int verdict = 0; verdict < VERDICTS; verdict++) {
        assert_string_equal(verdict_looks[verdict].name, verdict_name((Verdict)verdict));
        assert_string_equal(verdict_words[verdict], verdict_name((Verdict)verdict));
    }
    assert_string_equal(verdict_words[CELL_NOT_APPLICABLE], verdict_looks[CELL_NOT_APPLICABLE].name);
    assert_null(verdict_words[CELL_MISSING]);
}

RUN_TESTS(NULL, NULL)
