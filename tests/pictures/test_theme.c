/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Colours differ for all readers: distances in CIELAB between colours as they are seen. Simulation of the
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

enum { SIGHTS = 4, COLOURS_MAX = METHOD_COLOURS + 2 };

/* Of each method, from METHOD_BLUE on, of the bomb, of contacts. */
static void colours_of(const Theme *theme, uint32_t colours[COLOURS_MAX]) {
    for (int i = METHOD_BLUE; i < METHOD_COLOURS; i++) colours[i] = theme->bodies[i].fill;
    colours[METHOD_COLOURS] = theme->bomb.fill;
    colours[METHOD_COLOURS + 1] = theme->impulse;
}

/* 2.3 is what a trained eye just notices; boxes are small and apart. The bomb also has a sign on it. */
TEST(colours_of_boxes_and_the_bomb_differ_for_all_readers) {
    for (int t = LOOK_LIGHT; t <= LOOK_DARK; t++)
        for (int sight = 0; sight < SIGHTS; sight++)
            for (int i = METHOD_ORANGE; i <= METHOD_COLOURS; i++)
                for (int k = METHOD_BLUE; k < i; k++) {
                    uint32_t colours[COLOURS_MAX];
                    colours_of(theme_get((LookTheme)t), colours);
                    const double d = distance(seen(colours[i], sight), seen(colours[k], sight));
                    if (d < 14.5) fail_msg("theme %d, sight %d: colours %d and %d are %.1f apart", t, sight, k, i, d);
                }
}

/* In grey any two methods differ, and the engine more from every other. */
TEST(grey_tells_methods_apart) {
    for (int t = LOOK_LIGHT; t <= LOOK_DARK; t++)
        for (int i = METHOD_ORANGE; i < METHOD_COLOURS; i++)
            for (int k = METHOD_BLUE; k < i; k++) {
                const BodyColors *bodies = theme_get((LookTheme)t)->bodies;
                const double d = fabs(seen(bodies[i].fill, 0).l - seen(bodies[k].fill, 0).l);
                if (d < (k == METHOD_BLUE ? 6 : 4)) fail_msg("theme %d: %d and %d are %.1f apart in grey", t, k, i, d);
            }
}

/* Boxes, the bomb and contacts stand out from what is behind them, for all readers and in grey; least from the ground.
   */
TEST(colours_differ_from_what_is_behind_them) {
    for (int t = LOOK_LIGHT; t <= LOOK_DARK; t++) {
        const Theme *theme = theme_get((LookTheme)t);
        const uint32_t behind[] = {theme->panel, theme->page, theme->ground};
        uint32_t colours[COLOURS_MAX];
        colours_of(theme, colours);
        for (int i = METHOD_BLUE; i < COLOURS_MAX; i++)
            for (int k = 0; k < 3; k++) {
                for (int sight = 0; sight < SIGHTS; sight++)
                    assert_true(distance(seen(colours[i], sight), seen(behind[k], sight)) > (k < 2 ? 25 : 17));
                assert_true(fabs(seen(colours[i], 0).l - seen(behind[k], 0).l) > (k < 2 ? 20 : 11));
            }
    }
}

/* A contact is a dot in a ring of the panel's colour: where a box is as dark as the dot, the ring shows it. */
TEST(contacts_stand_out_from_boxes_and_the_bomb) {
    for (int t = LOOK_LIGHT; t <= LOOK_DARK; t++)
        for (int sight = 0; sight < SIGHTS; sight++) {
            const Theme *theme = theme_get((LookTheme)t);
            const Lab dot = seen(theme->impulse, sight), ring = seen(theme->panel, sight);
            uint32_t colours[COLOURS_MAX];
            colours_of(theme, colours);
            assert_true(distance(dot, ring) > 60);
            for (int i = METHOD_BLUE; i <= METHOD_COLOURS; i++) {
                const Lab box = seen(colours[i], sight);
                assert_true(fmax(distance(box, dot), distance(box, ring)) > 40);
            }
        }
}

RUN_TESTS(NULL, NULL)
