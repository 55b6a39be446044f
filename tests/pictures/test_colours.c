/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Colours belong to methods: the names in a picture decide, not their order. */
#include "testing.h"

#include "methods/methods.h"
#include "pictures/picture.h"

TEST(every_method_has_a_colour) {
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++)
        if (colours_have(kind->description->name) == kind->description->external)
            fail_msg("%s has a colour, or not", kind->description->name);
}

static uint32_t fill_of(const char *const *methods, int count, const char *method) {
    RunColours colours[COLOURS_MAX];
    Error error = {0};
    assert_ok(colours_assign(methods, count, NULL, colours, &error), error);
    for (int i = 0; i < count; i++)
        if (strcmp(methods[i], method) == 0) return colours[i].light.fill;
    fail();
    return 0;
}

/* Own, further settings, a network switched off, and others, in all rotations of two orders. */
TEST(colours_follow_names_in_any_order) {
    enum { COUNT = 11 };
    static const char *const names[COUNT] = {"scene-net:net=off", "Planck",     "engine:k=50", "box2d",
                                             "scene-net",         "engine",     "interior",    "rapier",
                                             "my engine",         "engine:k=5", "chipmunk"};
    uint32_t fills[COUNT];
    for (int i = 0; i < COUNT; i++) fills[i] = fill_of(names, COUNT, names[i]);
    for (int order = 0; order < 2 * COUNT; order++) {
        const char *turned[COUNT];
        for (int i = 0; i < COUNT; i++) turned[i] = names[(order + (order < COUNT ? i : COUNT - i)) % COUNT];
        for (int i = 0; i < COUNT; i++) assert_int_equal(fill_of(turned, COUNT, names[i]), fills[i]);
    }
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < i; k++) assert_int_not_equal(fills[i], fills[k]);
}

TEST(a_method_has_its_colour_in_any_company) {
    static const char *const pair[] = {"engine:k=50", "pair-net:network=mine.npz"};
    assert_int_equal(fill_of(pair, 2, "engine:k=50"), 0x0072B2);
    assert_int_equal(fill_of(pair, 2, "pair-net:network=mine.npz"), 0xE69F00);
    static const char *const three[] = {"engine:k=50", "engine", "engine:k=5"};
    assert_int_equal(fill_of(three, 3, "engine"), 0x0072B2);
    /* Alone or beside its network, the ablation has one colour. */
    static const char *const ablation[] = {"scene-net:net=off"}, *const both[] = {"scene-net", "scene-net:net=off"};
    assert_int_equal(fill_of(ablation, 1, ablation[0]), fill_of(both, 2, ablation[0]));
    /* A program that calls itself a method is not one. */
    static const char *const program[] = {"exec:node fake.mjs,name=engine"};
    assert_int_not_equal(fill_of(program, 1, program[0]), 0x0072B2);
}

/* No shade is a method's or another shade, on either theme, nor are many settings of one method alike. */
TEST(shades_differ_from_all_colours) {
    enum { MOST = 32 * COLOUR_SHADES };
    static RunColours all[MOST];
    int count = 0;
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        if (!colours_have(kind->description->name)) continue;
        colours_family(kind->description->name, NULL, &all[count]);
        count += COLOUR_SHADES;
    }
    for (int i = 0; i < count; i++)
        for (int k = 0; k < i; k++) {
            assert_int_not_equal(all[i].light.fill, all[k].light.fill);
            assert_int_not_equal(all[i].dark.fill, all[k].dark.fill);
        }
    const char *names[COLOURS_MAX];
    char texts[COLOURS_MAX][32];
    RunColours colours[COLOURS_MAX];
    for (int i = 0; i < COLOURS_MAX; i++) {
        snprintf(texts[i], sizeof texts[i], "interior:k=%d", i + 1);
        names[i] = texts[i];
    }
    assert_ok(colours_assign(names, COLOURS_MAX, NULL, colours, &error), error);
    for (int i = 0; i < COLOURS_MAX; i++)
        for (int k = 0; k < i; k++) assert_int_not_equal(colours[i].light.fill, colours[k].light.fill);
}

static const char *const shown[] = {"engine", "Planck", "engine:k=50"};

TEST(colours_can_be_chosen) {
    const ColourChoices choices = {{"Planck=#2a9d8f", "engine=5c4033"}, 2};
    RunColours colours[3];
    assert_ok(colours_check(&choices, &error) && colours_assign(shown, 3, &choices, colours, &error), error);
    assert_int_equal(colours[1].light.fill, 0x2A9D8F);
    assert_int_equal(colours[0].light.fill, 0x5C4033);
    assert_int_not_equal(colours[2].light.fill, 0x5C4033); /* a shade of the chosen colour */
    assert_true((colours[2].light.fill >> 16 & 255) > (colours[2].light.fill & 255));
    const ColourChoices one = {{"engine:k=50=7a9a01"}, 1};
    assert_ok(colours_assign(shown, 3, &one, colours, &error), error);
    assert_int_equal(colours[0].light.fill, 0x0072B2);
    assert_int_equal(colours[2].light.fill, 0x7A9A01);
}

RUN_TESTS(NULL, NULL)
