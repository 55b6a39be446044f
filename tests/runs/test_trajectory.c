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
            assert_ok(trajectory_add_contact(t, step, &contact, &error), error);
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

/* In every third of 8 frames, what frame 4 saw is there in frame 6, the last but one; frame 7 is beyond. */
TEST(a_verdict_keeps_its_place) {
    const int kept[8] = {0, 1, 1, 1, 2, 2, 2, -1};
    OWN(Trajectory) *t = run_sized(8, 2);
    t->dt = 1;
    for (int frame = 0; frame < 8; frame++) {
        trajectory_judge(t, "falls", frame, 1);
        OWN(Trajectory) *third = trajectory_every(t, 3, &error);
        assert_ok(third != NULL, error);
        assert_string_equal(third->verdict, "falls");
        assert_int_equal(third->verdict_frame, kept[frame]);
        assert_int_equal(third->verdict_body, 1);
    }
    trajectory_judge(t, "", -1, -1);
    OWN(Trajectory) *third = trajectory_every(t, 3, &error);
    assert_ok(third != NULL, error);
    assert_true(third->verdict[0] == '\0' && third->verdict_frame == -1);
}

/* Of 8 frames every third: 0, 3 and 6, each with its own state and the contacts of its own step. */
TEST(every_third_frame_is_the_same_frame) {
    OWN(Trajectory) *t = run_sized(8, 2);
    strcpy(t->method, "engine");
    t->dt = 0.125F;
    t->bomb = 1;
    t->fixed[0] = 1;
    t->size[1] = vec2(2, 3);
    for (int i = 0; i < 16; i++) {
        t->position[i] = t->velocity[i] = vec2((float)i, 0);
        t->angle[i] = t->angular_velocity[i] = (float)-i;
    }
    for (int step = 1; step < 8; step++)
        for (int i = 0; i < step % 4; i++)
            assert_ok(trajectory_add_contact(t, step, &(TrajectoryContact){.a = step, .b = i}, &error), error);
    trajectory_end_contacts(t);
    OWN(Trajectory) *third = trajectory_every(t, 3, &error), *all = trajectory_every(t, 1, &error);
    assert_ok(third != NULL && all != NULL, error);
    assert_int_equal(third->frames, 3);
    assert_true(third->dt == 0.375F && third->bomb == 1 && third->fixed[0] == 1 && third->size[1].y == 3);
    for (int frame = 0; frame < 3; frame++) {
        assert_true(trajectory_frame_hash(third, frame) == trajectory_frame_hash(t, 3 * frame));
        int64_t first = third->contact_start[frame], count = third->contact_start[frame + 1] - first;
        assert_int_equal(count, 3 * frame % 4);
        for (int64_t i = 0; i < count; i++) assert_int_equal(third->contacts[first + i].a, 3 * frame);
    }
    TrajectoryDifference difference;
    trajectory_compare(t, all, &difference);
    assert_true(difference.equal && all->contact_start[8] == t->contact_start[8]);
}

RUN_TESTS(NULL, NULL)
