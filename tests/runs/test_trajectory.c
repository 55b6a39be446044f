/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The trajectory in memory: existing bodies, contacts by step, the hash of a frame. */
#include "made.h"

#include "example.h"

TEST(too_large_a_trajectory_is_refused) {
    static const int cases[][2] = {{INT32_MAX, INT32_MAX}, {1000001, 10000}, {INT32_MAX, 1}, {1, INT32_MAX}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_refused(trajectory_create(cases[i][0], cases[i][1], &error), "bodies take more than 2 GiB");
    }
}

TEST(a_body_is_there_where_its_position_is_finite) {
    OWN(Trajectory) *t = example_trajectory();
    assert_false(trajectory_has(t, 1, 2));
    assert_true(trajectory_has(t, 2, 2));
    t->position[2 * EXAMPLE_BODIES + 2].y = INFINITY;
    assert_false(trajectory_has(t, 2, 2));
}

/* Steps with 2, 0, 1, 0, ... contacts: every step finds its own. */
TEST(contacts_are_found_by_step) {
    enum { FRAMES = 50 };
    OWN(Trajectory) *t = run_sized(FRAMES, 2);
    for (int step = 1; step < FRAMES - 5; step++) {
        for (int i = 0; i < step % 3; i++) {
            TrajectoryContact contact = {.a = step, .b = i};
            add_contact(t, step, contact);
        }
    }
    trajectory_end_contacts(t);
    assert_int_equal(t->contact_start[0], 0);
    for (int step = 0; step < FRAMES; step++) {
        int64_t first = t->contact_start[step], count = t->contact_start[step + 1] - first;
        assert_int_equal(count, step < FRAMES - 5 ? step % 3 : 0);
        for (int i = 0; i < count; i++) {
            assert_int_equal(t->contacts[first + i].a, step);
            assert_int_equal(t->contacts[first + i].b, i);
        }
    }
}

/* The definition, byte by byte: body 1 and, once it is there, body 2; never the floor. */
static uint64_t hash_by_hand(const float *numbers, int count) {
    uint64_t hash = 1469598103934665603U;
    for (int i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &numbers[i], sizeof bits);
        for (int byte = 0; byte < 4; byte++) hash = (hash ^ (bits >> (8 * byte) & 0xff)) * 1099511628211U;
    }
    return hash;
}

TEST(the_hash_is_fnv_of_dynamic_bodies_that_are_there) {
    OWN(Trajectory) *t = example_trajectory();
    float without[] = {0.1F, 0.25F, -0.0F, 1, -0.5F, 3e-30F};
    float with[] = {0.1F * 2, 0.25F, -0.0F, 2, -0.5F, 3e-30F, -3, 15, 1.5F, 7.5F, -22.5F, -1};
    assert_true(trajectory_frame_hash(t, 1) == hash_by_hand(without, 6));
    assert_true(trajectory_frame_hash(t, 2) == hash_by_hand(with, 12));
    t->fixed[1] = t->fixed[2] = 1;
    assert_true(trajectory_frame_hash(t, 2) == 1469598103934665603U);
}

RUN_TESTS(NULL, NULL)
