/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Comparison of two trajectories: equal means every bit, and the first difference is the first. */
#include "made.h"

#include "example.h"

/* Two examples, which differ in what a test then changes in the second. */
static Trajectory *a, *b;

FIXTURE(make) {
    a = example_trajectory();
    b = example_trajectory();
}

FIXTURE(destroy) {
    trajectory_destroy(a);
    trajectory_destroy(b);
}

static TrajectoryDifference compared(void) {
    TrajectoryDifference d, mirrored;
    trajectory_compare(a, b, &d);
    trajectory_compare(b, a, &mirrored);
    assert_int_equal(d.equal, mirrored.equal);
    assert_true(d.frame == mirrored.frame && d.body == mirrored.body && d.distance == mirrored.distance);
    assert_true(d.max_frame == mirrored.max_frame && d.max_distance == mirrored.max_distance);
    return d;
}

TEST_WITH(same_is_equal, make, destroy) {
    TrajectoryDifference d = compared();
    assert_true(d.equal);
    assert_string_equal(d.what, "");
    assert_true(d.frame == -1 && d.body == -1 && d.max_frame == -1 && d.max_body == -1 && d.max_distance == 0);
}

TEST_WITH(names_and_contacts_do_not_count, make, destroy) {
    strcpy(b->scene, "other");
    strcpy(b->method, "momentum");
    b->scene_hash = 1;
    b->contacts[0].normal_impulse = 7;
    /* A NaN of other bits is as absent as any. */
    b->position[2] = vec2(-NAN, NAN);
    assert_true(compared().equal);
}

TEST_WITH(the_first_and_the_largest_are_found, make, destroy) {
    int first = 2 * EXAMPLE_BODIES + 1, last = 3 * EXAMPLE_BODIES + 2;
    b->position[first] = vec2(a->position[first].x + 3, a->position[first].y - 4);
    b->angle[first] = a->angle[first] - 0.5F;
    b->velocity[first] = vec2(a->velocity[first].x - 6, a->velocity[first].y + 8);
    b->position[last].x += 12;
    TrajectoryDifference d = compared();
    assert_false(d.equal);
    assert_string_equal(d.what, "");
    assert_true(d.frame == 2 && d.body == 1);
    assert_true(fabs(d.distance - 5) < 1e-6 && d.angle == 0.5 && d.speed == 10);
    assert_true(d.max_frame == 3 && d.max_body == 2 && d.max_distance == 12);
    /* Of the box in four frames and the bomb in two. */
    assert_near(d.rollout_mse, (25 + 144) / 12.0, 1e-5);
}

/* One bit in any of the six numbers, down to the sign of a zero. */
TEST_WITH(one_bit_is_a_difference, make, destroy) {
    int i = 1 * EXAMPLE_BODIES + 1;
    float *const numbers[] = {&b->position[i].x, &b->position[i].y, &b->angle[i],
                              &b->velocity[i].x, &b->velocity[i].y, &b->angular_velocity[i]};
    for (int k = 0; k < 6; k++) {
        float kept = *numbers[k];
        *numbers[k] = kept == 0 ? -kept : nextafterf(kept, 100);
        TrajectoryDifference d = compared();
        assert_false(d.equal);
        assert_true(d.frame == 1 && d.body == 1);
        *numbers[k] = kept;
    }
    assert_true(compared().equal);
}

TEST_WITH(a_body_in_one_only, make, destroy) {
    example_pose(b, 1, 2, (float[]){0, 0, 0, 0, 0, 0});
    TrajectoryDifference d = compared();
    assert_false(d.equal);
    assert_true(d.frame == 1 && d.body == 2 && d.distance == 0 && d.max_distance == 0);
    assert_string_equal(d.what, "body 2 exists in frame 1 of the second only");
}

TEST_WITH(other_worlds_are_told_apart, make, destroy) {
    b->dt = 0.01F;
    TrajectoryDifference d;
    trajectory_compare(a, b, &d);
    assert_string_equal(d.what, "dt: 0.0166666675 and 0.00999999978 s");
    b->fixed[1] = 1;
    trajectory_compare(a, b, &d);
    assert_string_equal(d.what, "body 1: dynamic and static");
    b->size[1].y = 2;
    trajectory_compare(a, b, &d);
    assert_string_equal(d.what, "size of body 1: 1 x 0.5 and 1 x 2 m");
    b->bodies = 2;
    trajectory_compare(a, b, &d);
    assert_string_equal(d.what, "bodies: 3 and 2");
    assert_true(!d.equal && d.frame == -1 && d.body == -1 && d.max_frame == -1);
}

TEST_WITH(a_shorter_run_is_compared_as_far_as_it_goes, make, destroy) {
    b->frames = 3;
    TrajectoryDifference d;
    trajectory_compare(a, b, &d);
    assert_string_equal(d.what, "frames: 4 and 3");
    assert_true(!d.equal && d.frame == -1 && d.body == -1);
    b->position[2 * EXAMPLE_BODIES + 1].x += 1;
    d = compared();
    assert_true(!d.equal && d.frame == 2 && d.body == 1);
    assert_string_equal(d.what, "");
}

TEST_WITH(the_distance_of_a_frame_is_the_largest_of_its_bodies, make, destroy) {
    b->position[2 * EXAMPLE_BODIES + 1].y += 3;
    b->position[2 * EXAMPLE_BODIES + 2].y -= 4;
    assert_true(fabs(trajectory_distance(a, b, 2) - 4) < 1e-6);
    assert_true(trajectory_distance(a, b, 1) == 0);
    b->position[2 * EXAMPLE_BODIES + 2].y = NAN;
    assert_true(fabs(trajectory_distance(a, b, 2) - 3) < 1e-6);
    trajectory_destroy(b);
    b = run_sized(EXAMPLE_FRAMES, 1);
    assert_true(trajectory_distance(a, b, 2) == 0);
    example_pose(b, 2, 0, (float[]){30, 30, 0, 0, 0, 0});
    assert_true(trajectory_distance(a, b, 2) == 50);
    assert_true(trajectory_distance(b, a, 2) == 50);
}

RUN_TESTS(NULL, NULL)
