/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Islands: their loops, as many as edges that are left when a tree through the island and the ground is taken away; and
   each as a problem of its own. */
#include "testing.h"

#include "methods/islands.h"

enum { BODIES_MAX = 400, CONTACTS_MAX = 2000 };

static ProblemBody bodies[BODIES_MAX];
static ContactPoint contacts[CONTACTS_MAX];
static ContactProblem problem = {.bomb = -1, .dt = 1, .bodies = bodies, .contacts = contacts};

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
    int most = 0;
    assert_true(islands_find(&islands, &problem));
    for (int k = 0; k < islands.count; k++)
        if (islands.islands[k].loops > most) most = islands.islands[k].loops;
    assert_int_equal(most, expected);
    islands_free(&islands);
}

TEST(without_contacts_there_are_no_loops) {
    begin(0);
    assert_most_loops(0);
    begin(20);
    assert_most_loops(0);
}

TEST(all_that_does_not_move_is_one_body) {
    begin(101);
    for (int i = 1; i <= 100; i++) touch(0, i); /* boxes on the ground: an island each */
    assert_most_loops(0);
    for (int i = 1; i < 100; i++) touch(i, i + 1); /* a row */
    assert_most_loops(99);
    begin(12);
    for (int i = 1; i <= 10; i++) touch(i == 6 ? 0 : i - 1, i); /* two stacks of five */
    assert_most_loops(0);
    touch(5, 11), touch(10, 11); /* a beam on them */
    assert_most_loops(1);
    begin(12);
    bodies[11].inv_mass = 0;
    for (int i = 1; i <= 10; i++) touch(i - 1, i); /* a stack, on the seam of two bodies */
    touch(1, 11);
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

/* Body i has velocity i, contact i the feature i. */
static void number_all(void) {
    for (int i = 0; i < problem.body_count; i++) bodies[i].velocity.x = (float)i;
    for (int i = 0; i < problem.contact_count; i++) contacts[i].feature = (uint32_t)i;
}

/* Bodies 0, 4 and 7 do not move. Of the others 1, 3 and 6 are one island, 2 and 5 another; 8 touches nothing. */
TEST(an_island_is_a_problem_of_its_own) {
    static const int members[2][5] = {{0, 1, 3, 4, 6}, {0, 2, 4, 5, 7}},
                     touching[2][8] = {{0, 1, 4, 5, 6, 7, 10, 11}, {2, 3, 8, 9, 12, 13, 14, 15}};
    begin(9);
    bodies[4].inv_mass = bodies[7].inv_mass = 0;
    touch(0, 1), touch(0, 2), touch(1, 3), touch(1, 4), touch(2, 7), touch(3, 6), touch(4, 5), touch(2, 5);
    touch(4, 7); /* neither moves: of no island */
    number_all();
    problem.bomb = 5;
    BodyVelocity velocities[9] = {0};
    ContactImpulse impulses[18] = {0};
    ContactSolution all = {.velocities = velocities, .impulses = impulses};
    Islands islands = {0};
    assert_true(islands_find(&islands, &problem));
    assert_int_equal(islands.count, 2);
    for (int k = 1; k >= 0; k--) {
        ContactSolution room;
        const ContactProblem part = islands_take(&islands, &problem, k, &room);
        assert_true(part.body_count == 5 && part.contact_count == 8 && part.dt == problem.dt);
        assert_int_equal(part.bomb, k == 1 ? 3 : -1);
        for (int i = 0; i < 5; i++) {
            assert_int_equal((int)part.bodies[i].velocity.x, members[k][i]);
            room.velocities[i].angular = (float)(10 + members[k][i]);
        }
        for (int i = 0; i < 8; i++) {
            const ContactPoint *copy = &part.contacts[i], *from = &contacts[copy->feature];
            assert_int_equal(copy->feature, touching[k][i]);
            assert_true(members[k][copy->a] == from->a && members[k][copy->b] == from->b);
            room.impulses[i].normal = (float)(100 + touching[k][i]);
        }
        room.fallbacks.by_sweeps = 1;
        islands_put(&islands, k, &part, &room, &all);
    }
    for (int i = 0; i < 9; i++)
        assert_int_equal((int)velocities[i].angular, i == 0 || i == 4 || i == 7 || i == 8 ? 0 : 10 + i);
    for (int i = 0; i < 18; i++) assert_int_equal((int)impulses[i].normal, i < 16 ? 100 + i : 0);
    assert_int_equal(all.fallbacks.by_sweeps, 2);
    problem.bomb = -1;
    islands_free(&islands);
}

RUN_TESTS(NULL, NULL)
