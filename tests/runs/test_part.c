/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Why two trajectories part: made by hand, so that the first frame, body, contact and cause are known. */
#include "made.h"

/* A floor, two boxes on it, and a bomb (body 3) that comes in frame 3. Every step has four contacts. */
enum { FRAMES = 7, BODIES = 4, BOMB = 3, BOMB_FRAME = 3, CONTACTS = 4 };

static Trajectory *a, *b;

static size_t at(int frame, int body) { return (size_t)frame * BODIES + (size_t)body; }

static void put(Trajectory *t, int frame, int body) {
    t->position[at(frame, body)] = vec2((float)body, (float)frame);
    t->angle[at(frame, body)] = 0.25F;
    t->velocity[at(frame, body)] = vec2(1, -2);
    t->angular_velocity[at(frame, body)] = 0;
}

static void add_contacts(Trajectory *t, int step) {
    static const int32_t pairs[CONTACTS][2] = {{0, 1}, {0, 1}, {1, 2}, {0, 2}};
    static const uint32_t features[CONTACTS] = {7, 6, 5, 5};
    for (int i = 0; i < CONTACTS; i++) {
        TrajectoryContact contact = {.a = pairs[i][0], .b = pairs[i][1], .feature = features[i]};
        contact.point = vec2((float)i, (float)step);
        contact.normal = vec2(0, 1);
        contact.normal_impulse = 2;
        contact.tangent_impulse = -0.5F;
        add_contact(t, step, contact);
    }
}

static Trajectory *example(void) {
    Trajectory *t = run_sized(FRAMES, BODIES);
    t->dt = 0.5F;
    t->bomb = BOMB;
    t->fixed[0] = 1;
    for (int body = 0; body < BODIES; body++) t->size[body] = vec2(1, 1);
    for (int frame = 0; frame < FRAMES; frame++) {
        for (int body = 0; body < (frame < BOMB_FRAME ? BODIES - 1 : BODIES); body++) put(t, frame, body);
        if (frame > 0) add_contacts(t, frame);
    }
    trajectory_end_contacts(t);
    return t;
}

static TrajectoryContact *contact(Trajectory *t, int step, int i) { return &t->contacts[t->contact_start[step] + i]; }

FIXTURE(make) {
    a = example();
    b = example();
}

FIXTURE(destroy) {
    trajectory_destroy(a);
    trajectory_destroy(b);
}

/* The other way round the cause, the frames and the bodies are the same. */
static TrajectoryParting parted(double tolerance) {
    TrajectoryParting parting, mirrored;
    const PoseTolerance poses = {tolerance > 0, tolerance, INFINITY};
    Error error = {0};
    assert_ok(trajectory_part(a, b, &poses, &parting, &error), error);
    assert_ok(trajectory_part(b, a, &poses, &mirrored, &error), error);
    assert_int_equal(parting.cause, mirrored.cause);
    assert_int_equal(parting.step, mirrored.step);
    assert_int_equal(parting.first.frame, mirrored.first.frame);
    assert_int_equal(parting.first.body, mirrored.first.body);
    assert_int_equal(parting.beyond.frame, mirrored.beyond.frame);
    assert_int_equal(parting.contacts.only_a, mirrored.contacts.only_b);
    return parting;
}

static void expect_first(const TrajectoryParting *parting, int frame, int body, PartCause cause) {
    assert_int_equal(parting->first.frame, frame);
    assert_int_equal(parting->first.body, body);
    assert_int_equal(parting->cause, cause);
}

TEST_WITH(equal_runs_do_not_part, make, destroy) {
    b->position[at(1, BOMB)] = vec2(-NAN, NAN); /* as absent as any */
    TrajectoryParting parting = parted(0);
    expect_first(&parting, -1, -1, PART_NONE);
    assert_int_equal(parting.beyond.frame, -1);
    assert_int_equal(parting.step, -1);
    assert_int_equal(parting.frames, FRAMES);
}

TEST_WITH(frame_0_is_the_start, make, destroy) {
    b->velocity[at(0, 2)].y += 1;
    contact(b, 1, 0)->normal_impulse = 5;
    TrajectoryParting parting = parted(0);
    expect_first(&parting, 0, 2, PART_START);
    assert_true(parting.first.by.speed == 1 && parting.first.by.distance == 0);
}

TEST_WITH(other_impulses_are_the_solver, make, destroy) {
    b->position[at(4, 2)] = vec2(a->position[at(4, 2)].x + 3, a->position[at(4, 2)].y - 4);
    b->angle[at(4, 2)] -= 0.5F;
    b->angular_velocity[at(4, 2)] = -2;
    b->velocity[at(4, BOMB)].x += 1;
    contact(b, 4, 0)->normal_impulse = 2.5F;
    contact(b, 4, 2)->tangent_impulse = 0.25F;
    contact(b, 5, 1)->normal_impulse = 100; /* later steps do not count */
    TrajectoryParting parting = parted(0);
    expect_first(&parting, 4, 2, PART_SOLVER);
    assert_int_equal(parting.first.bodies, 2);
    assert_near(parting.first.by.distance, 5, 1e-6);
    assert_true(parting.first.by.angle == 0.5 && parting.first.by.spin == 2 && parting.first.by.speed == 0);
    const ContactDifference *contacts = &parting.contacts;
    assert_int_equal(parting.step, 4);
    assert_true(contacts->count_a == CONTACTS && contacts->changed == 2);
    assert_true(contacts->only_a + contacts->only_b + contacts->moved == 0);
    assert_true(contacts->largest_a.a == 1 && contacts->largest_a.b == 2 && contacts->largest_a.feature == 5);
    assert_true(contacts->largest_a.tangent_impulse == -0.5F && contacts->largest_b.tangent_impulse == 0.25F);
}

TEST_WITH(contacts_in_another_order_are_the_same, make, destroy) {
    b->angle[at(4, 2)] = 1;
    for (int i = 0; i < CONTACTS; i++) *contact(b, 4, i) = *contact(a, 4, CONTACTS - 1 - i);
    TrajectoryParting parting = parted(0);
    expect_first(&parting, 4, 2, PART_ELSEWHERE);
}

TEST_WITH(a_contact_of_one_run_is_collision_detection, make, destroy) {
    b->angle[at(4, 2)] = 1;
    contact(b, 4, 0)->normal_impulse = 3;
    contact(b, 4, 1)->feature = 9;
    TrajectoryParting parting = parted(0);
    expect_first(&parting, 4, 2, PART_CONTACTS);
    assert_true(parting.contacts.only_a == 1 && parting.contacts.only_b == 1 && parting.contacts.changed == 1);
    assert_true(parting.contacts.only.feature == 6 && parting.contacts.only_first_a);
}

TEST_WITH(a_contact_elsewhere_is_collision_detection, make, destroy) {
    b->angle[at(4, 2)] = 1;
    contact(b, 4, 1)->point.x += 1;
    TrajectoryParting parting = parted(0);
    expect_first(&parting, 4, 2, PART_CONTACTS);
    assert_int_equal(parting.contacts.moved, 1);
}

TEST_WITH(equal_impulses_leave_no_contact_to_blame, make, destroy) {
    b->velocity[at(4, 1)].x = -0.0F;
    TrajectoryParting parting = parted(0);
    expect_first(&parting, 4, 1, PART_ELSEWHERE);
    assert_int_equal(parting.step, -1);
}

TEST_WITH(impulses_of_an_earlier_step_are_hidden, make, destroy) {
    b->angle[at(4, 1)] = 1;
    contact(b, 2, 1)->tangent_impulse = nextafterf(-0.5F, 0);
    contact(b, 4, 1)->normal_impulse = 3;
    TrajectoryParting parting = parted(0);
    expect_first(&parting, 4, 1, PART_HIDDEN);
    assert_int_equal(parting.step, 2);
    assert_int_equal(parting.contacts.changed, 1);
    assert_int_equal(parting.contacts.largest_a.feature, 6);
}

TEST_WITH(a_bomb_that_comes_otherwise_is_the_launch, make, destroy) {
    b->position[at(BOMB_FRAME, BOMB)].x += 1;
    TrajectoryParting parting = parted(0);
    expect_first(&parting, BOMB_FRAME, BOMB, PART_LAUNCH);
    /* With a box that was there before it is more than the launch. */
    b->position[at(BOMB_FRAME, 1)].x += 1;
    parting = parted(0);
    expect_first(&parting, BOMB_FRAME, 1, PART_ELSEWHERE);
    assert_int_equal(parting.first.bodies, 2);
}

/* 1 m in frame 2, 3 m in frame 5: what is beyond is beyond, and not what is on the limit. */
TEST_WITH(the_tolerance_is_of_positions, make, destroy) {
    b->position[at(2, 1)].y += 1;
    b->angle[at(3, 1)] = 90;
    b->velocity[at(4, 1)].x = 90;
    b->position[at(5, 2)].y += 3;
    contact(b, 5, 0)->normal_impulse = 30;
    contact(b, 5, 2)->normal_impulse = 3;
    TrajectoryParting parting = parted(0.5);
    assert_true(parting.beyond.frame == 2 && parting.beyond.body == 1);
    parting = parted(1);
    expect_first(&parting, 2, 1, PART_ELSEWHERE);
    assert_true(parting.beyond.frame == 5 && parting.beyond.body == 2 && parting.beyond.by.distance == 3);
    /* Of that step the contact that touches that body. */
    assert_true(parting.beyond_contacts.count_a == 2 && parting.beyond_contacts.largest_b.normal_impulse == 3);
    parting = parted(3);
    assert_int_equal(parting.first.frame, 2);
    assert_int_equal(parting.beyond.frame, -1);
    parting = parted(0);
    assert_true(parting.beyond.frame == 2 && parting.beyond.body == 1);
}

TEST_WITH(the_tolerance_is_of_rotations_too, make, destroy) {
    const PoseTolerance exact = {true, 0, 0.01}, any = {true, 0, INFINITY};
    TrajectoryParting parting;
    b->angle[at(2, 1)] += 0.009F;
    b->angle[at(4, 1)] += 6.2831853F; /* a whole turn is none */
    b->angle[at(5, 2)] -= 0.011F;
    assert_ok(trajectory_part(a, b, &exact, &parting, &error), error);
    assert_true(parting.beyond.frame == 5 && parting.beyond.body == 2 && parting.first.frame == 2);
    assert_true(parting.equal == FRAMES - 3 && parting.within == 2);
    assert_ok(trajectory_part(a, b, &any, &parting, &error), error);
    assert_true(parting.beyond.frame == -1 && parting.equal == FRAMES - 3 && parting.within == 3);
}

/* Boxes at (body, frame) of a run that has no contacts: none touches the floor, box 2 touches box 1. */
TEST_WITH(contacts_that_are_found_have_no_impulses, make, destroy) {
    const PoseTolerance exact = {0};
    TrajectoryParting parting;
    b->position[at(4, 2)].x += 1;
    for (Trajectory **run = (Trajectory *[]){a, b, NULL}; *run != NULL; run++)
        assert_ok(trajectory_find_contacts(*run, &error), error);
    assert_ok(trajectory_part(a, b, &exact, &parting, &error), error);
    expect_first(&parting, 4, 2, PART_UNKNOWN);
    assert_true(parting.no_impulses && parting.contacts.count_a > 0 && parting.contacts.changed == 0);
    b->position[at(1, 2)].x += 100;
    b->position[at(1, 1)].x -= 100;
    a->position[at(1, 2)].x += 100;
    a->position[at(1, 1)].x -= 100;
    b->angle[at(2, 2)] += 1;
    for (Trajectory **run = (Trajectory *[]){a, b, NULL}; *run != NULL; run++)
        assert_ok(trajectory_find_contacts(*run, &error), error);
    assert_ok(trajectory_part(a, b, &exact, &parting, &error), error);
    expect_first(&parting, 2, 2, PART_ELSEWHERE);
}

TEST_WITH(a_shorter_run_is_compared_as_far_as_it_goes, make, destroy) {
    b->position[at(5, 1)].x += 1;
    b->frames = 5;
    TrajectoryParting parting = parted(0);
    expect_first(&parting, -1, -1, PART_NONE);
    assert_int_equal(parting.frames, 5);
}

RUN_TESTS(NULL, NULL)
