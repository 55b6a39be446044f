/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Colours differ for all readers: distances in CIELAB between colours as they are seen. Simulation of the
   three kinds of colour blindness: Machado, Oliveira, Fernandes, "A physiologically-based model for simulation of color
   vision deficiency" (2009), severity 1. */
#include "testing.h"

#include "methods/methods.h"
#include "pictures/picture.h"

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

/* Of each method with a colour of its own, the eight most compared first; of seven others, which take all spare ones;
   of the bomb; of contacts. */
enum { SIGHTS = 4, OTHERS = 7, MOST = COLOURS_MAX + 2 };

typedef struct Colours {
    int methods, bomb; /* numbers of methods and others; the bomb's place is behind, that of contacts the next */
    char names[COLOURS_MAX][32];
    uint32_t fills[MOST];
} Colours;

static Colours colours_named(void) {
    Colours all = {0};
    for (int i = 0; i < COLOUR_HUES; i++) {
        for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
            RunColours family[COLOUR_SHADES];
            if (!colours_have(kind->description->name)) continue;
            colours_family(kind->description->name, NULL, family);
            if (family[0].light.fill == colours_hue(i).light.fill)
                strcpy(all.names[all.methods++], kind->description->name);
        }
    }
    assert_int_equal(all.methods, COLOUR_HUES);
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        int i = 0;
        while (i < COLOUR_HUES && strcmp(all.names[i], kind->description->name) != 0) i++;
        if (i == COLOUR_HUES && colours_have(kind->description->name))
            strcpy(all.names[all.methods++], kind->description->name);
    }
    for (int i = 0; i < OTHERS; i++) snprintf(all.names[all.methods++], sizeof *all.names, "other %d", i);
    all.bomb = all.methods;
    return all;
}

/* choices: instead of colours of the table; NULL: none. False if they are refused. */
static bool fill_all(Colours *all, LookTheme theme, const ColourChoices *choices) {
    const char *names[COLOURS_MAX];
    RunColours colours[COLOURS_MAX];
    Error error = {0};
    for (int i = 0; i < all->methods; i++) names[i] = all->names[i];
    if (!colours_assign(names, all->methods, choices, colours, &error)) return false;
    for (int i = 0; i < all->methods; i++)
        all->fills[i] = theme == LOOK_DARK ? colours[i].dark.fill : colours[i].light.fill;
    all->fills[all->bomb] = theme_get(theme)->bomb.fill;
    all->fills[all->bomb + 1] = theme_get(theme)->impulse;
    return true;
}

static Colours colours_of(LookTheme theme) {
    Colours all = colours_named();
    assert_true(fill_all(&all, theme, NULL));
    return all;
}

static const char *name_of(LookTheme theme) { return theme == LOOK_DARK ? "dark" : "light"; }

/* How far two must be apart, i > k: 2.3 is what a trained eye just notices; boxes are small and apart. The bomb also
   has a sign on it. Those that are compared most are further apart, and so are all for normal sight. */
static double needed(const Colours *all, int i, int k, int sight) {
    const bool most = k < COLOUR_HUES && (i < COLOUR_HUES || i == all->bomb);
    return most ? 14.5 : sight == 0 ? 13 : 10;
}

static double apart(const Colours *all, int i, int k, int sight) {
    return distance(seen(all->fills[i], sight), seen(all->fills[k], sight));
}

/* For all readers and in grey; least from the ground. */
static bool stands_out(uint32_t fill, const Theme *theme) {
    const uint32_t behind[] = {theme->panel, theme->page, theme->ground};
    for (int k = 0; k < 3; k++) {
        for (int sight = 0; sight < SIGHTS; sight++)
            if (!(distance(seen(fill, sight), seen(behind[k], sight)) > (k < 2 ? 25 : 17))) return false;
        if (!(fabs(seen(fill, 0).l - seen(behind[k], 0).l) > (k < 2 ? 20 : 11))) return false;
    }
    return true;
}

/* The least distance of a method from all others and the bomb, in what is needed, if it had this fill; 0: refused. */
static double room_of(Colours *all, int own, uint32_t fill) {
    const ColourChoices choices = {{printed("%s=%06X", all->names[own], fill)}, 1};
    double least = 100;
    for (int t = LOOK_LIGHT; t <= LOOK_DARK; t++) {
        if (!fill_all(all, (LookTheme)t, &choices) || !stands_out(all->fills[own], theme_get((LookTheme)t))) return 0;
        for (int k = 0; k <= all->bomb; k++)
            for (int sight = 0; sight < SIGHTS && k != own; sight++)
                least =
                    fmin(least, apart(all, own, k, sight) / needed(all, own > k ? own : k, own > k ? k : own, sight));
    }
    return least;
}

/* For those who add a method: a fill for its row in src/pictures/colours.c. */
static const char *advice(int method) {
    enum { STEP = 12 };
    Colours all = colours_named();
    double most = 0;
    uint32_t best = 0;
    for (uint32_t r = 0; r < 256; r += STEP)
        for (uint32_t g = 0; g < 256; g += STEP)
            for (uint32_t b = 0; b < 256; b += STEP) {
                const double room = room_of(&all, method, r << 16 | g << 8 | b);
                if (room > most) most = room, best = r << 16 | g << 8 | b;
            }
    return printed("%s has most room with 0x%06X, %.2f of what it needs", all.names[method], best, most);
}

TEST(colours_of_boxes_and_the_bomb_differ_for_all_readers) {
    static const char *const sees[SIGHTS] = {"normal sight", "protanopia", "deuteranopia", "tritanopia"};
    for (int t = LOOK_LIGHT; t <= LOOK_DARK; t++)
        for (int sight = 0; sight < SIGHTS; sight++) {
            const Colours all = colours_of((LookTheme)t);
            for (int i = 1; i <= all.bomb; i++)
                for (int k = 0; k < i; k++)
                    if (apart(&all, i, k, sight) < needed(&all, i, k, sight))
                        fail_msg("%s theme, %s: %s and %s are %.1f apart, not %g (%s)", name_of((LookTheme)t),
                                 sees[sight], all.names[k], i < all.bomb ? all.names[i] : "the bomb",
                                 apart(&all, i, k, sight), needed(&all, i, k, sight),
                                 advice(i < all.methods - OTHERS ? i : k));
        }
}

/* In grey any two of those that are compared most differ, and the engine more from every other. */
TEST(grey_tells_methods_apart) {
    for (int t = LOOK_LIGHT; t <= LOOK_DARK; t++) {
        const Colours all = colours_of((LookTheme)t);
        for (int i = 1; i < COLOUR_HUES; i++)
            for (int k = 0; k < i; k++) {
                const bool engine = strcmp(all.names[i], "engine") == 0 || strcmp(all.names[k], "engine") == 0;
                const double d = fabs(seen(all.fills[i], 0).l - seen(all.fills[k], 0).l);
                if (d < (engine ? 6 : 4))
                    fail_msg("%s theme: %s and %s are %.1f apart in grey", name_of((LookTheme)t), all.names[k],
                             all.names[i], d);
            }
    }
}

/* Boxes, the bomb and contacts. */
TEST(colours_differ_from_what_is_behind_them) {
    for (int t = LOOK_LIGHT; t <= LOOK_DARK; t++) {
        const Colours all = colours_of((LookTheme)t);
        for (int i = 0; i <= all.bomb + 1; i++)
            if (!stands_out(all.fills[i], theme_get((LookTheme)t)))
                fail_msg("%s theme: %s is too near to panel, page or ground", name_of((LookTheme)t),
                         i < all.bomb    ? all.names[i]
                         : i == all.bomb ? "the bomb"
                                         : "a contact");
    }
}

/* A contact is a dot in a ring of the panel's colour: where a box is as dark as the dot, the ring shows it. */
TEST(contacts_stand_out_from_boxes_and_the_bomb) {
    for (int t = LOOK_LIGHT; t <= LOOK_DARK; t++)
        for (int sight = 0; sight < SIGHTS; sight++) {
            const Theme *theme = theme_get((LookTheme)t);
            const Lab dot = seen(theme->impulse, sight), ring = seen(theme->panel, sight);
            const Colours all = colours_of((LookTheme)t);
            assert_true(distance(dot, ring) > 60);
            for (int i = 0; i <= all.bomb; i++) {
                const Lab box = seen(all.fills[i], sight);
                assert_true(fmax(distance(box, dot), distance(box, ring)) > 40);
            }
        }
}

RUN_TESTS(NULL, NULL)
