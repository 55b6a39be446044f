/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names and colours of methods, whatever picture they are in. */
#include "testing.h"

#include "methods/methods.h"

TEST(a_name_has_no_folders) {
    static const struct {
        const char *text, *name;
    } cases[] = {{"engine", "engine"},
                 {"momentum:k=20", "momentum:k=20"},
                 {"pair-net:network=/far/away/net.npz,k=3", "pair-net:network=net.npz,k=3"},
                 {"playback:launches=a/b.csv", "playback:launches=a/b.csv"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char name[64];
        assert_int_equal(method_name(name, sizeof name, cases[i].text), strlen(cases[i].name));
        assert_string_equal(name, cases[i].name);
    }
    char small[9];
    assert_int_equal(method_name(small, sizeof small, "momentum:k=20"), 8);
    assert_string_equal(small, "momentum");
    assert_int_equal(method_name_head("momentum:k=20"), 8);
    assert_int_equal(method_name_head("engine"), 6);
}

static const MethodDescription blue = {.name = "blue", .look = {METHOD_BLUE, METHOD_CIRCLE}},
                               green = {.name = "green", .look = {METHOD_GREEN, METHOD_SQUARE}},
                               none = {.name = "none"};

static void expect_colours(const MethodDescription *const *methods, int count, const MethodColour *expected) {
    MethodColour found[METHOD_COLOURS];
    method_colours_assign(methods, count, found);
    for (int i = 0; i < count; i++) assert_int_equal(found[i], expected[i]);
}

TEST(a_method_has_its_colour_in_any_order) {
    expect_colours((const MethodDescription *[]){&green, &blue}, 2, (MethodColour[]){METHOD_GREEN, METHOD_BLUE});
    expect_colours((const MethodDescription *[]){&blue, &green}, 2, (MethodColour[]){METHOD_BLUE, METHOD_GREEN});
    /* also behind a method that has none */
    expect_colours((const MethodDescription *[]){&none, NULL, &blue}, 3,
                   (MethodColour[]){METHOD_ORANGE, METHOD_GREEN, METHOD_BLUE});
}

TEST(two_runs_of_a_method_have_different_colours) {
    expect_colours((const MethodDescription *[]){&green, &green, &green}, 3,
                   (MethodColour[]){METHOD_GREEN, METHOD_BLUE, METHOD_ORANGE});
    const MethodDescription *many[METHOD_COLOURS - 1];
    MethodColour found[METHOD_COLOURS - 1];
    for (int i = 0; i < METHOD_COLOURS - 1; i++) many[i] = &green;
    method_colours_assign(many, METHOD_COLOURS - 1, found);
    for (int i = 0; i < METHOD_COLOURS - 1; i++)
        for (int k = 0; k < i; k++) assert_int_not_equal(found[i], found[k]);
}

RUN_TESTS(NULL, NULL)
