/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loops of islands: as many as edges that are left when a tree through the island is taken away. */
#include "testing.h"

#include "methods/sweeps.h"

enum { BODIES_MAX = 400, CONTACTS_MAX = 2000 };

static ProblemBody bodies[BODIES_MAX];
static ContactPoint contacts[CONTACTS_MAX];
static ContactProblem problem = {.marked = -1, .dt = 1, .bodies = bodies, .contacts = contacts};

/* Body 0 is the ground. */
static void begin(int body_count) {
    problem.body_count = body_count;
    problem.contact_count = 0;
    for (int i = 0; i < body_count; i++) bodies[i].inv_mass = i > 0 ? 1 : 0;
}

/* Two contact points. */
static void touch(int a, int b) {
    for (int k = 0; k < 2; k++) contacts[problem.contact_count++] = (ContactPoint){.a = a, .b = b};
}

static void assert_most_loops(int expected) {
    Islands islands = {0};
    assert_int_equal(islands_most_loops(&islands, &problem), expected);
    islands_free(&islands);
}

TEST(without_contacts_there_are_no_loops) {
    begin(0);
    assert_most_loops(0);
    begin(20);
    assert_most_loops(0);
}

TEST(the_ground_connects_nothing) {
    begin(101);
    for (int i = 1; i <= 100; i++) touch(0, i); /* a row of boxes */
    for (int i = 1; i < 100; i++) touch(i, i + 1);
    assert_most_loops(0);
}

TEST(an_arch_has_one_loop_where_its_ends_touch) {
    begin(31);
    for (int i = 1; i < 30; i++) touch(i, i + 1);
    assert_most_loops(0);
    touch(1, 30);
    assert_most_loops(1);
}

/* A pyramid of n rows has n (n - 1) pairs and n (n + 1) / 2 boxes. In pairs of any order. */
TEST(a_pyramid_has_its_pairs_less_its_boxes) {
    enum { ROWS = 20, UPPER = ROWS * (ROWS - 1) / 2, BOXES = UPPER + ROWS };
    for (int step = 1; step < 14; step += 6) { /* no divisor of the number of pairs */
        begin(BOXES + 1);
        for (int i = 0, at = 0; i < UPPER; i++, at = (at + step) % UPPER) {
            int row = ROWS - 1, first = 1, rest = at; /* the box below, on the left, of pair `at` */
            for (; rest >= row; rest -= row--) first += row + 1;
            touch(first + rest, first + row + 1 + rest);
            touch(first + rest + 1, first + row + 1 + rest);
        }
        assert_most_loops(2 * UPPER - BOXES + 1);
    }
}

/* The island with most loops counts, not their sum; and when two grow together, both. */
TEST(the_island_with_most_loops_counts) {
    begin(81);
    for (int ring = 0; ring < 20; ring++)
        for (int i = 0; i < 4; i++) touch(1 + 4 * ring + i, 1 + 4 * ring + (i + 1) % 4);
    assert_most_loops(1);
    touch(1, 3);
    assert_most_loops(2);
    touch(5, 1);
    assert_most_loops(3);
    touch(9, 5);
    assert_most_loops(4);
    touch(13, 17);
    assert_most_loops(4);
}

RUN_TESTS(NULL, NULL)
