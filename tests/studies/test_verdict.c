/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Both sides of the limits of holding, falling and sinking, on synthetic runs. */
#include "studies/trial.h"

TEST(a_resting_box_settles) {
    Trial trial;
    trial_begin(&trial);
    trial_go(&trial, TRIAL_FRAMES);
    assert_false(verdict_watch_is_final(&trial.watch));
    assert_reading(trial_end(&trial), VERDICT_SETTLES, -1, 1, 0, 0, "m/s");
}

/* A box of any mass that is moved at this speed, up or turning; the limit of a box of 1 m is sqrt(2e-4 10) = 44.72
   mm/s. */
static VerdictReading run_at_speed(double mm, bool turning, float mass) {
    Trial trial;
    trial_begin(&trial);
    trial.bodies[1].inv_mass = 1 / mass;
    trial.bodies[1].inv_inertia = 6 / mass;
    if (turning)
        trial.bodies[1].angular_velocity = (float)(mm * sqrt(6) / 1000);
    else
        trial.bodies[1].velocity.y = (float)(mm / 1000);
    trial_go(&trial, TRIAL_FRAMES);
    return trial_end(&trial);
}

TEST(settling_is_judged_by_the_fastest_body) {
    for (int i = 0; i < 4; i++) {
        const float mass = i < 2 ? 1 : 0.001f;
        assert_reading(run_at_speed(44.7, i % 2 == 1, mass), VERDICT_SETTLES, -1, 1, 0.0447, 1e-8, "m/s");
        assert_reading(run_at_speed(44.8, i % 2 == 1, mass), VERDICT_MOVES, 1, TRIAL_FRAMES, 0.0448, 1e-8, "m/s");
    }
}

/* The box has no contact in so many frames, or one with a box that is in the air itself. */
static VerdictReading run_in_the_air(int frames, bool with_another) {
    Trial trial;
    trial_begin(&trial);
    if (with_another) {
        trial.bodies[2] = trial_box;
        trial.bodies[2].position.y = 1.5f;
        trial.count = 3;
        trial.contacts[1] = (ContactPoint){.a = 1, .b = 2, .normal = {0, 1}};
        trial.contact_count = 2;
    }
    trial_go(&trial, TRIAL_FRAMES - frames);
    if (with_another) trial.contacts[0] = trial.contacts[1];
    trial.contact_count = with_another ? 1 : 0;
    trial_go(&trial, TRIAL_FRAMES);
    return trial_end(&trial);
}

/* A tenth of a fall of 60 frames is forgiven. */
TEST(what_hangs_in_the_air_does_not_rest) {
    for (int i = 0; i < 2; i++) {
        assert_verdict(run_in_the_air(6, i == 1), VERDICT_SETTLES);
        assert_reading(run_in_the_air(7, i == 1), VERDICT_MOVES, 1, TRIAL_FRAMES, 7 / 60.0, 1e-6, "s");
    }
}

/* Moves up to this frame, then rests. */
static VerdictReading run_that_moves_until(int frame) {
    Trial trial;
    trial_begin(&trial);
    trial.bodies[1].angular_velocity = 1; /* 1 / (2 6) J */
    trial_go(&trial, frame);
    trial.bodies[1].angular_velocity = 0;
    trial_go(&trial, TRIAL_FRAMES);
    return trial_end(&trial);
}

TEST(settling_takes_half_a_fall) {
    assert_reading(run_that_moves_until(TRIAL_FRAMES - 30), VERDICT_SETTLES, -1, TRIAL_FRAMES - 29, 0, 0, "m/s");
    assert_reading(run_that_moves_until(TRIAL_FRAMES - 29), VERDICT_MOVES, 1, TRIAL_FRAMES - 29, sqrt(1.0 / 6), 1e-7,
                   "m/s");
}

/* A jump of the box in the step after `frame`. */
static VerdictReading run_with_jump(int frame, float way, bool stands, int bomb) {
    Trial trial;
    trial_begin(&trial);
    trial.run.stands = stands;
    trial.bomb = bomb;
    trial_go(&trial, frame);
    trial.bodies[1].position.x += way;
    trial_go(&trial, TRIAL_FRAMES);
    return trial_end(&trial);
}

TEST(creeping_is_five_centimetres_in_ten_seconds) {
    /* Moved at 15 s, found at 20 s: the first comparison is that of 20 s with 10 s. */
    assert_verdict(run_with_jump(900, 0.0499f, true, -1), VERDICT_SETTLES);
    assert_reading(run_with_jump(900, 0.0501f, true, -1), VERDICT_CREEPS, 1, 1200, 0.0501, 1e-6, "m");
    assert_reading(run_with_jump(3599, -0.0501f, true, -1), VERDICT_CREEPS, 1, 3600, 0.0501, 1e-6, "m");
    assert_verdict(run_with_jump(599, 1, true, -1), VERDICT_SETTLES); /* before 10 s */
}

/* Ten seconds are exactly 600 steps: 0.0501 m in 601 steps would be less than 0.05 m in 600. */
TEST(creeping_may_be_even) {
    for (int side = 0; side < 2; side++) {
        Trial trial;
        trial_begin(&trial);
        double way = side == 0 ? 0.0499 : 0.0501;
        for (int frame = 1; frame <= TRIAL_FRAMES; frame++) {
            trial.bodies[1].position.x = (float)(way * frame / 600);
            trial_go(&trial, frame);
        }
        assert_verdict(trial_end(&trial), side == 0 ? VERDICT_SETTLES : VERDICT_CREEPS);
    }
}

TEST(creeping_counts_only_at_the_end_if_nothing_must_stand) {
    assert_verdict(run_with_jump(900, 1, false, -1), VERDICT_SETTLES);
    assert_verdict(run_with_jump(2999, 1, false, -1), VERDICT_SETTLES); /* 50 s: just before the last ten */
    assert_reading(run_with_jump(3000, 1, false, -1), VERDICT_CREEPS, 1, 3600, 1, 1e-6, "m");
    assert_verdict(run_with_jump(3000, 1, false, 1), VERDICT_SETTLES); /* the bomb may roll */
    assert_verdict(run_with_jump(3000, 1, true, 1), VERDICT_CREEPS);
}

/* 3570 frames: seconds are counted back from there, and the last ten begin at 2970. */
TEST(the_last_ten_seconds_end_with_the_run) {
    for (int side = 0; side < 2; side++) {
        Trial trial;
        trial_begin(&trial);
        trial.run.frames = 3570;
        trial.run.stands = false;
        trial_go(&trial, side == 0 ? 2969 : 2970);
        trial.bodies[1].position.x = 0.06f;
        trial_go(&trial, 3570);
        assert_verdict(trial_end(&trial), side == 0 ? VERDICT_SETTLES : VERDICT_CREEPS);
    }
}

/* A box of 2 x 1 is moved in the second step, well above the ground. */
static VerdictReading run_with_pose(float lower, float degrees, bool stands) {
    Trial trial;
    trial_begin(&trial);
    trial.run.stands = stands;
    trial.bodies[0].position.y = -20;
    trial.bodies[1].size.x = 2;
    trial.bodies[1].angle = 7;
    trial_go(&trial, 1);
    trial.bodies[1].position.y -= lower;
    trial.bodies[1].angle += degrees * 3.14159265f / 180;
    trial_go(&trial, TRIAL_FRAMES);
    return trial_end(&trial);
}

TEST(falling_is_half_a_side_or_thirty_degrees) {
    assert_verdict(run_with_pose(0.499f, 0, true), VERDICT_SETTLES);
    assert_reading(run_with_pose(0.501f, 0, true), VERDICT_FALLS, 1, 2, 0.501, 1e-6, "m");
    assert_verdict(run_with_pose(0, 29.9f, true), VERDICT_SETTLES);
    assert_reading(run_with_pose(0, 30.1f, true), VERDICT_FALLS, 1, 2, 30.1, 1e-4, "deg");
    assert_reading(run_with_pose(0, -30.1f, true), VERDICT_FALLS, 1, 2, 30.1, 1e-4, "deg");
    assert_verdict(run_with_pose(0, 30.1f, false), VERDICT_SETTLES); /* not meant to stand */
    assert_verdict(run_with_pose(-3, 0, true), VERDICT_SETTLES);     /* higher */
}

/* A pile of 60 boxes in which each contact gives way by this much within a second; another part of it is not from
   contacts. Bodies are listed from above or from below. The uppermost ones lose their contacts in frame 10. */
static VerdictReading run_with_sag(float depth, float lower, bool from_above, int in_air) {
    enum { PILE = 60, FRAMES = 120 };
    Body bodies[PILE + 1] = {trial_ground};
    ContactPoint contacts[2 * PILE];
    const VerdictRun run = {.gravity = {0, -10}, .dt = 1.0f / 60, .frames = FRAMES, .stands = true};
    VerdictWatch watch = {0};
    Error error = {0};
    for (int frame = 0; frame <= FRAMES; frame++) {
        const float part = frame < 60 ? (float)frame / 60 : 1;
        for (int row = 1; row <= PILE; row++) {
            const int i = from_above ? PILE + 1 - row : row, below = row == 1 ? 0 : from_above ? i + 1 : i - 1;
            bodies[i] = trial_box;
            bodies[i].position.y = (float)row - 0.5f - part * (float)row * (depth + lower);
            for (int end = 0; end < 2; end++) /* one is deeper: the mean counts */
                contacts[2 * row - 2 + end] = (ContactPoint){.a = i < below ? i : below,
                                                             .b = i < below ? below : i,
                                                             .normal = {0, i < below ? -1.0f : 1.0f},
                                                             .separation = -part * depth * (end == 0 ? 1.5f : 0.5f)};
        }
        const int touching = frame < 10 ? PILE : PILE - in_air;
        const VerdictStep step = {frame, PILE + 1, 2 * touching, -1, bodies, contacts};
        assert_ok(frame == 0 ? verdict_watch_begin(&watch, &run, bodies, PILE + 1, &error)
                             : verdict_watch_step(&watch, &step, &error),
                  error);
    }
    const VerdictReading reading = verdict_watch_end(&watch);
    verdict_watch_free(&watch);
    return reading;
}

/* 60 contacts of 9 mm: the uppermost box is 0.54 m lower. The rest that sag leaves is what falls. */
TEST(a_pile_that_sags_stands) {
    for (int from_above = 0; from_above < 2; from_above++) {
        assert_verdict(run_with_sag(0.009f, 0, from_above, 0), VERDICT_SETTLES);
        assert_verdict(run_with_sag(0, 0.009f, from_above, 0), VERDICT_FALLS);
        assert_verdict(run_with_sag(0.009f, 0.008f, from_above, 0), VERDICT_SETTLES); /* 0.48 m */
        assert_verdict(run_with_sag(0.009f, 0.0085f, from_above, 0), VERDICT_FALLS);  /* 0.51 m */
    }
}

/* What is in the air above it comes down with it. */
TEST(a_body_in_the_air_has_the_sag_of_the_pile_below) {
    for (int from_above = 0; from_above < 2; from_above++) {
        assert_verdict(run_with_sag(0.009f, 0, from_above, 3), VERDICT_MOVES);
        assert_verdict(run_with_sag(0, 0.009f, from_above, 3), VERDICT_FALLS);
    }
}

/* A box beside the pile, deep in it, carries nothing. */
TEST(a_contact_at_the_side_is_no_sag) {
    for (int side = 0; side < 2; side++) {
        Trial trial;
        trial_begin(&trial);
        trial.contacts[0].normal = side == 0 ? vec2(0, 1) : vec2(1, 0);
        trial_go(&trial, 1);
        trial.contacts[0].separation = -0.6f; /* of one point: 0.3 m */
        trial.bodies[1].position.y -= 0.6f;
        trial_go(&trial, 50);
        assert_verdict(trial_end(&trial), side == 0 ? VERDICT_SETTLES : VERDICT_FALLS);
    }
}

/* The box drops by so much, lands turned by a radian, and turns on after it has come to rest or before. */
static VerdictReading run_that_drops(float drop, bool rests) {
    Trial trial;
    trial_begin(&trial);
    trial.contact_count = 0;
    trial.bodies[1].position.y += drop;
    trial_go(&trial, 10);
    trial.bodies[1].position.y -= drop;
    trial_go(&trial, 11);
    trial.contact_count = 1;
    trial.bodies[1].angular_velocity = rests ? 0 : 1;
    trial_go(&trial, 30);
    trial.bodies[1].angle = 1;
    trial_go(&trial, 31);
    trial.bodies[1].angular_velocity = 0;
    trial_go(&trial, 200);
    return trial_end(&trial);
}

/* What drops from above stands where it comes to rest; a gap of less than half a side only closes. */
TEST(what_drops_into_place_stands_where_it_rests) {
    assert_verdict(run_that_drops(0.6f, false), VERDICT_SETTLES);
    assert_verdict(run_that_drops(0.6f, true), VERDICT_FALLS);
    assert_verdict(run_that_drops(0.4f, false), VERDICT_FALLS);
}

/* Down is the direction of gravity. */
TEST(falling_goes_along_gravity) {
    for (int side = 0; side < 2; side++) {
        Trial trial;
        trial_begin(&trial);
        trial.run.gravity = vec2(-3, 0);
        trial_go(&trial, 1);
        trial.bodies[1].position.x += side == 0 ? 1.0f : -1.0f;
        trial_go(&trial, 60);
        assert_verdict(trial_end(&trial), side == 0 ? VERDICT_SETTLES : VERDICT_FALLS);
    }
}

/* It drops 3 m before its first contact, then 0.1 m per step. */
TEST(gaps_may_close_before_a_body_falls) {
    Trial trial;
    trial_begin(&trial);
    trial.bodies[0].position.y = -20;
    trial.bodies[1].position.y = -1;
    trial.contact_count = 0;
    trial_go(&trial, 1);
    trial.bodies[1].position.y = -4;
    trial_go(&trial, 2);
    trial.contact_count = 1;
    trial_go(&trial, 30);
    for (int i = 1; i <= 5; i++) {
        assert_true(trial.watch.worst.verdict < VERDICT_FALLS);
        trial.bodies[1].position.y = -4.05f - 0.1f * (float)i;
        trial_go(&trial, 30 + i);
    }
    assert_reading(trial_end(&trial), VERDICT_FALLS, 1, 35, 0.55, 1e-6, "m");
}

/* A contact of this depth for so many steps, with a box of this size. */
static VerdictReading run_with_depth(float depth, int steps, Vec2 size) {
    Trial trial;
    trial_begin(&trial);
    trial.bodies[1].size = size;
    trial.contact_count = 2;
    trial.contacts[1] = trial.contacts[0];
    trial.contacts[1].separation = -depth;
    trial_go(&trial, steps);
    trial.contact_count = 1;
    trial_go(&trial, steps + 1);
    trial.contact_count = 2;
    trial_go(&trial, steps + 1 + 59);
    trial.contact_count = 1;
    trial_go(&trial, TRIAL_FRAMES);
    return trial_end(&trial);
}

/* A fall is 60 frames, but of boxes twice as large sqrt(2) times as many: 85. */
TEST(sinking_is_a_fall_deeper_than_a_share_of_the_size) {
    assert_verdict(run_with_depth(0.1499f, 2000, vec2(1, 1)), VERDICT_SETTLES);
    assert_reading(run_with_depth(0.1501f, 60, vec2(1, 1)), VERDICT_SINKS, 1, 60, 0.1501, 1e-6, "m");
    assert_verdict(run_with_depth(0.1501f, 59, vec2(1, 1)), VERDICT_SETTLES);
    assert_verdict(run_with_depth(0.2999f, 2000, vec2(4, 1)), VERDICT_SETTLES);
    assert_verdict(run_with_depth(0.3001f, 85, vec2(4, 1)), VERDICT_SINKS);
    assert_verdict(run_with_depth(0.3001f, 84, vec2(4, 1)), VERDICT_SETTLES);
    /* Thin: half its side. */
    assert_verdict(run_with_depth(0.0499f, 60, vec2(10, 0.1f)), VERDICT_SETTLES);
    assert_verdict(run_with_depth(0.0501f, 60, vec2(10, 0.1f)), VERDICT_SINKS);
}

/* The deepest relative to its size: 0.16 m of 1 m, not 0.31 m of 2 m. Of a dynamic and a static body the dynamic
   one. */
TEST(sinking_names_the_body) {
    Trial trial;
    trial_begin(&trial);
    trial.count = 4;
    trial.bodies[2] = trial.bodies[3] = trial_box;
    trial.bodies[2].size = trial.bodies[3].size = vec2(2, 2);
    trial.bodies[2].inv_mass = trial.bodies[2].inv_inertia = 0;
    trial.bodies[2].position = vec2(1.5f, 1);
    trial.bodies[3].position = vec2(9, 2);
    trial.contact_count = 2;
    trial.contacts[0] = (ContactPoint){.a = 1, .b = 2, .separation = -0.16f};
    trial.contacts[1] = (ContactPoint){.a = 0, .b = 3, .separation = -0.31f};
    trial_go(&trial, 80);
    assert_reading(trial_end(&trial), VERDICT_SINKS, 1, 73, 0.16, 1e-6, "m");
}

/* dt = 1/20 s: 20 steps are a second, 200 are ten. */
TEST(seconds_are_steps_of_the_scene) {
    Trial trial;
    trial_begin(&trial);
    trial.run.dt = 1.0f / 20.0f;
    trial.run.frames = 1200;
    trial_go(&trial, 300);
    trial.bodies[1].position.x = 0.06f;
    trial_go(&trial, 1000);
    trial.contacts[0].separation = -0.16f;
    assert_int_equal(trial.watch.worst.frame, 400);
    trial_go(&trial, 1100);
    assert_reading(trial_end(&trial), VERDICT_SINKS, 1, 1020, 0.16, 1e-6, "m");
}

/* The last body is removed at the end of a step that has a contact of it; another one replaces it, far away. */
TEST(bodies_may_be_removed_and_added) {
    Trial trial;
    trial_begin(&trial);
    trial.count = 3;
    trial.bodies[2] = trial_box;
    trial.bodies[2].position = vec2(0, 1.5f);
    trial.contact_count = 2;
    trial.contacts[1] = (ContactPoint){.a = 1, .b = 2, .separation = -0.3f};
    trial_go(&trial, 59);
    trial.count = 2;
    trial_go(&trial, 60);
    trial.contact_count = 1;
    trial_go(&trial, 700);
    trial.count = 4;
    trial.bodies[2].position = vec2(20, 0.5f);
    trial.bodies[3] = trial.bodies[2];
    trial.bodies[3].position = vec2(-20, 0.5f);
    trial.contacts[trial.contact_count++] = (ContactPoint){.a = 0, .b = 2};
    trial.contacts[trial.contact_count++] = (ContactPoint){.a = 0, .b = 3};
    trial_go(&trial, TRIAL_FRAMES);
    assert_verdict(trial_end(&trial), VERDICT_SETTLES);
}

/* 0.5 m up in the first ten seconds, then 0.03 m sideways and 0.04 m up: a drift of 0.05 m, and 1 kg 10 m/s^2 0.04
   m. */
TEST(drift_is_counted_after_ten_seconds) {
    Trial trial;
    trial_begin(&trial);
    trial_go(&trial, 300);
    trial.bodies[1].position.y = 1;
    trial_go(&trial, 600);
    const VerdictReading before = verdict_watch_end(&trial.watch);
    assert_true(isnan(before.drift) && isnan(before.gained));
    trial.bodies[1].position = vec2(0.03f, 1.04f);
    trial_go(&trial, TRIAL_FRAMES);
    const VerdictReading after = trial_end(&trial);
    assert_near(after.drift, 0.05, 1e-6);
    assert_near(after.gained, 0.4, 1e-5);
}

RUN_TESTS(NULL, NULL)
