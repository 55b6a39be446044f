/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bodies that start inside one another are refused, unless the scene allows it. */
#include "scene_text.h"
#include "owned.h"

#define TWO(first, second) BASE "bodies:\n  - {mass: 1, " first "}\n  - {mass: 1, " second "}\n"
#define AT(x) "size: [1, 1], position: [" x ", 0]"
#define STACK(count, spacing) \
    "  - {pattern: stack, count: " count ", spacing: [0, " spacing "], size: [1, 1], mass: 1, position: [0, 0.5]}\n"
#define ADVICE ", more than the slop of 0.01 m; move one of them, or write 'overlaps: allowed'"
#define BOMB "size: [1, 1], mass: 50"

static const Refused overlaps[] = {
    {TWO(AT("0"), AT("1")), NULL},
    {TWO(AT("0"), AT("0.99")), NULL}, /* by the slop: what position correction leaves */
    {TWO(AT("0"), AT("0.98")), "7:5: error: body 1 starts 0.02 m inside body 0 (line 6)" ADVICE},
    {TWO(AT("0"), AT("0.98")) "overlaps: refused\n", "7:5: error: body 1 starts 0.02 m inside body 0 (line 6)" ADVICE},
    {TWO(AT("0"), AT("0.98")) "overlaps: allowed\n", NULL},
    {TWO(AT("0"), AT("0.98")) "overlaps: on\n", "8:11: error: overlaps must be refused or allowed (got on)"},
    {TWO(AT("0"), AT("0.98")) "overlaps: [allowed]\n", "8:11: error: overlaps must be refused or allowed (got a list)"},
    /* A corner in a face: half a diagonal and half a side are 1.2071 m. */
    {TWO(AT("0"), AT("1.2") ", angle: 0.785398"), NULL},
    {TWO(AT("0"), AT("1.15") ", angle: 0.785398"), "7:5: error: body 1 starts 0.0571 m inside body 0 (line 6)" ADVICE},
    {BASE GROUND STACK("5", "1"), NULL},
    {BASE GROUND STACK("5", "0.9"), "7:5: error: body 2 starts 0.1 m inside body 1 (line 7)" ADVICE},
    {BASE GROUND "  - {mass: 1, size: [1, 1], position: [3, 0.4]}\n",
     "7:5: error: body 1 starts 0.1 m inside body 0 (line 6)" ADVICE},
    /* The ground may be built from static boxes that overlap. */
    {BASE GROUND "  - {static: true, size: [100, 20], position: [20, -10]}\n", NULL},
};

static const Refused bombs[] = {
    {BASE GROUND "bomb: {x: 0, y: 0.5, " BOMB "}\n", NULL},
    {BASE GROUND "bomb: {x: 0, y: 0.2, " BOMB "}\n", "7:7: error: the bomb starts 0.3 m inside body 0 (line 6)" ADVICE},
    {BASE GROUND "bomb: {x: 0, y: 0.2, " BOMB "}\noverlaps: allowed\n", NULL},
    /* Later, the bodies are elsewhere: tests/runs/test_launch_check.c. */
    {BASE GROUND "bomb: {x: 0, y: 0.2, frame: 3, " BOMB "}\n", NULL},
};

TEST(overlapping_bodies_are_refused) { CHECK_TABLE(overlaps); }

TEST(bombs_inside_bodies_are_refused) { CHECK_TABLE(bombs); }

/* 10,000 boxes in one place: the first pair suffices, so that memory does not grow with the pairs. */
TEST(ten_thousand_in_one_place_are_refused) {
    expect_refused(
        BASE "bodies:\n  - {pattern: row, count: 10000, spacing: [0, 0], size: [1, 1], mass: 1, position: [0, 0]}\n",
        "6:5: error: body 1 starts 1 m inside body 0 (line 6)" ADVICE);
}

TEST(the_hash_of_a_scene_does_not_depend_on_it) {
    OWN(Scene) *refused = good_scene(TWO(AT("0"), AT("1"))),
               *allowed = good_scene(TWO(AT("0"), AT("1")) "overlaps: allowed\n");
    assert_true(scene_hash(refused) == scene_hash(allowed));
    assert_false(refused->overlaps_allowed);
    assert_true(allowed->overlaps_allowed);
}

RUN_TESTS(NULL, NULL)
