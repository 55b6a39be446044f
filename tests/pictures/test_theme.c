/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The colours of methods differ for all readers: distances in CIELAB between colours as they are seen. Simulation of the
   three kinds of colour blindness: Machado, Oliveira, Fernandes, "A physiologically-based model for simulation of color
   vision deficiency" (2009), severity 1. */
#include "testing.h"

#include "pictures/picture.h"

#include <math.h>

static const double sights[4][3][3] = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}},
    {{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}},
    {{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}};

typedef struct Lab {
    double l, a, b;
} Lab;

static double linear(uint32_t colour, int shift) {
    const double c = (colour >> shift & 255) / 255.0;
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

static double root(double t) { return t > 0.008856 ? cbrt(t) : 7.787 * t + 16 / 116.0; }

static Lab seen(uint32_t colour, int sight) {
    const double rgb[3] = {linear(colour, 16), linear(colour, 8), linear(colour, 0)};
    double s[3];
    for (int i = 0; i < 3; i++)
        s[i] = fmin(fmax(sights[sight][i][0] * rgb[0] + sights[sight][i][1] * rgb[1] + sights[sight][i][2] * rgb[2], 0),
                    1);
    const double x = root((0.4124 * s[0] + 0.3576 * s[1] + 0.1805 * s[2]) / 0.9505);
    const double y = root(0.2126 * s[0] + 0.7152 * s[1] + 0.0722 * s[2]);
    const double z = root((0.0193 * s[0] + 0.1192 * s[1] + 0.9505 * s[2]) / 1.089);
    return (Lab){116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

static double distance(Lab a, Lab b) { return sqrt(pow(a.l - b.l, 2) + pow(a.a - b.a, 2) + pow(a.b - b.b, 2)); }

/* 2.3 is what a trained eye just notices; boxes are small and apart. */
TEST(colours_differ_for_all_readers) {
    for (int t = LOOK_LIGHT; t <= LOOK_DARK; t++) {
        const Theme *theme = theme_get((LookTheme)t);
        for (int sight = 0; sight < 4; sight++)
            for (int i = METHOD_BLUE; i < METHOD_COLOURS; i++)
                for (int k = METHOD_BLUE; k < i; k++) {
                    const double d = distance(seen(theme->bodies[i].fill, sight), seen(theme->bodies[k].fill, sight));
                    if (d < 13) fail_msg("theme %d, sight %d: colours %d and %d are %.1f apart", t, sight, k, i, d);
                }
    }
}

/* In grey the engine differs from every other method's boxes, and all boxes from their panel. */
TEST(grey_tells_boxes_from_the_engines_and_the_page) {
    for (int t = LOOK_LIGHT; t <= LOOK_DARK; t++) {
        const Theme *theme = theme_get((LookTheme)t);
        const double blue = seen(theme->bodies[METHOD_BLUE].fill, 0).l, panel = seen(theme->panel, 0).l;
        for (int i = METHOD_ORANGE; i < METHOD_COLOURS; i++) {
            const double grey = seen(theme->bodies[i].fill, 0).l;
            assert_true(fabs(grey - blue) > 6);
            assert_true(fabs(grey - panel) > 20);
        }
    }
}

/* The bomb also has a sign on it, but every method's boxes meet it. */
TEST(the_bomb_differs_from_all_boxes_and_the_page) {
    for (int t = LOOK_LIGHT; t <= LOOK_DARK; t++) {
        const Theme *theme = theme_get((LookTheme)t);
        for (int sight = 0; sight < 4; sight++) {
            const Lab bomb = seen(theme->bomb.fill, sight);
            for (int i = METHOD_BLUE; i < METHOD_COLOURS; i++) {
                const double d = distance(bomb, seen(theme->bodies[i].fill, sight));
                if (d < 15) fail_msg("theme %d, sight %d: colour %d is %.1f from the bomb's", t, sight, i, d);
            }
            assert_true(distance(bomb, seen(theme->panel, sight)) > 30);
        }
    }
}

RUN_TESTS(NULL, NULL)
