/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Both sides of the limits of tunnelling, exploding and non-finite runs; the order of severity. */
#include "studies/trial.h"

/* A point moves from `from` to `to` near a slab of 4 x 2 at (10, 5), rotated by the angle. */
static bool goes_through(float angle, Vec2 from, Vec2 to) {
    Trial trial;
    trial_begin(&trial);
    trial.run.stands = false;
    trial.run.gravity = vec2(0, 0); /* rising is no explosion */
    trial.contact_count = 0;
    trial.bodies[0] = (Body){.position = {10, 5}, .angle = angle, .size = {4, 2}};
    trial.bodies[1].position = from;
    trial_go(&trial, 1);
    trial.bodies[1].position = to;
    trial_go(&trial, 2);
    VerdictReading reading = trial_end(&trial);
    if (reading.verdict != VERDICT_TUNNELS) return false;
    assert_int_equal(reading.body, 1);
    assert_string_equal(reading.unit, "m/s");
    return true;
}

TEST(tunnelling_goes_through_a_static_box) {
    const float quarter = 1.57079633f, eighth = 0.785398163f;
    /* Upright: the slab is 8..12 x 4..6. */
    assert_true(goes_through(0, vec2(10, 9), vec2(10, -5)));
    assert_true(goes_through(0, vec2(11.99f, 9), vec2(11.99f, -5)));
    assert_false(goes_through(0, vec2(12.01f, 9), vec2(12.01f, -5)));
    assert_false(goes_through(0, vec2(10, 9), vec2(10, 6.01f)));
    assert_false(goes_through(0, vec2(10, 9), vec2(10, 5.99f)));   /* into it, not through */
    assert_false(goes_through(0, vec2(10, 5), vec2(10, 5)));       /* inside, at rest */
    assert_false(goes_through(0, vec2(7.99f, 5), vec2(7.99f, 5))); /* beside, at rest */
    assert_false(goes_through(0, vec2(9, 6), vec2(11, 6)));        /* along the edge */
    assert_false(goes_through(0, vec2(13, 9), vec2(13, 5)));       /* beside */
    /* A quarter turn: 9..11 x 3..7. */
    assert_true(goes_through(quarter, vec2(10.99f, 9), vec2(10.99f, -5)));
    assert_false(goes_through(quarter, vec2(11.01f, 9), vec2(11.01f, -5)));
    /* An eighth of a turn: it extends 2 along x - y = 5 and 1 along x + y = 15. Lines of slope 1 touch it at a distance
       of 1 from the centre, which is sqrt(2) along x. */
    assert_false(goes_through(eighth, vec2(5 + 1.42f, 0), vec2(15 + 1.42f, 10)));
    assert_true(goes_through(eighth, vec2(5 + 1.41f, 0), vec2(15 + 1.41f, 10)));
    assert_false(goes_through(eighth, vec2(5, 10 - 2.84f), vec2(15, -2.84f)));
    assert_true(goes_through(eighth, vec2(5, 10 - 2.82f), vec2(15, -2.82f)));
}

/* Into the slab 8..12 x 4..6 from above, some steps inside, then out to a given point. */
static bool comes_out(Vec2 at) {
    Trial trial;
    trial_begin(&trial);
    trial.run.stands = false;
    trial.contact_count = 0;
    trial.bodies[0] = (Body){.position = {10, 5}, .size = {4, 2}};
    const Vec2 way[] = {{10, 7}, {10, 5.5f}, {10.5f, 5}, {10, 4.5f}, at};
    for (int i = 0; i < 5; i++) {
        trial.bodies[1].position = way[i];
        trial_go(&trial, i + 1);
    }
    return trial_end(&trial).verdict == VERDICT_TUNNELS;
}

TEST(a_body_that_is_pushed_out_again_did_not_tunnel) {
    assert_false(comes_out(vec2(10, 6.01f)));
    assert_true(comes_out(vec2(10, 3.99f)));
    assert_true(comes_out(vec2(12.01f, 5)));
}

/* 2 m in 1/60 s. */
TEST(tunnelling_reports_the_speed) {
    Trial trial;
    trial_begin(&trial);
    trial.bodies[0].size.y = 0.25f;
    trial.bodies[0].position.y = -0.125f;
    trial_go(&trial, 5);
    trial.bodies[1].position.y = -1.5f;
    trial_go(&trial, 9);
    assert_reading(trial_end(&trial), VERDICT_TUNNELS, 1, 6, 120, 1e-4, "m/s");
}

/* For one frame after the first second, the runs' energies are so many J above 5 (the box at rest: 1 kg, 10 m/s^2,
   0.5 m). */
static VerdictReading run_of_engine(bool other, double own, double converged, double available) {
    Trial trial;
    trial_begin(&trial);
    trial.run.other_engine = other;
    trial.converged.balance.available = available;
    for (int i = 0; i <= TRIAL_FRAMES; i++) trial.energy[i] = 5;
    trial.energy[101] += converged;
    trial_go(&trial, 100);
    trial.bodies[1].velocity.x = (float)sqrt(2 * own);
    trial_go(&trial, 101);
    trial.bodies[1].velocity.x = 0;
    trial_go(&trial, TRIAL_FRAMES);
    return trial_end(&trial);
}

static VerdictReading run_with_energy(double own, double converged, double available) {
    return run_of_engine(false, own, converged, available);
}

/* 1 kg that falls for a step has 1/2 (10 / 60)^2 = 0.0139 J more. */
TEST(another_engine_may_state_velocities_half_a_step_away) {
    assert_verdict(run_of_engine(true, 0.0277, 0, 1e-6), VERDICT_SETTLES);
    assert_verdict(run_of_engine(true, 0.0279, 0, 1e-6), VERDICT_EXPLODES);
}

TEST(exploding_exceeds_the_runs_own_bound_and_the_converged_run) {
    assert_verdict(run_with_energy(0.99, 0, 100), VERDICT_SETTLES);
    assert_reading(run_with_energy(1.01, 0, 100), VERDICT_EXPLODES, 1, 101, 1.01, 1e-5, "J");
    assert_reading(run_with_energy(1.01, -3, 100), VERDICT_EXPLODES, 1, 101, 1.01, 1e-5, "J");
    assert_verdict(run_with_energy(3.99, 3, 100), VERDICT_SETTLES);
    assert_reading(run_with_energy(4.01, 3, 100), VERDICT_EXPLODES, 1, 101, 1.01, 1e-5, "J");
    /* Hardly any energy available: the limit is what gravity does in a step, 0.0139 J. */
    assert_verdict(run_with_energy(0.0138, 0, 1e-6), VERDICT_SETTLES);
    assert_verdict(run_with_energy(0.0140, 0, 1e-6), VERDICT_EXPLODES);
}

/* A box at rest has a side of 10 m^2/s^2 to lose: five times that is no impact, however much energy a converged run
   has. */
TEST(a_burst_explodes_beside_any_run) {
    for (int side = 0; side < 2; side++) {
        Trial trial;
        trial_begin(&trial);
        trial_go(&trial, 10);
        trial.bodies[1].velocity.x = sqrtf(2 * (side == 0 ? 49.9f : 50.1f));
        trial_go(&trial, 11);
        trial.bodies[1].velocity.x = 0;
        trial_go(&trial, 100);
        const VerdictReading reading = trial_end(&trial);
        if (side == 0)
            assert_verdict(reading, VERDICT_SETTLES);
        else
            assert_reading(reading, VERDICT_EXPLODES, 1, 11, 40.1, 1e-3, "J");
    }
}

/* 3 J of kinetic energy for a frame, so many frames after or before the converged run has them. */
static VerdictReading run_with_hop(int later) {
    Trial trial;
    trial_begin(&trial);
    for (int i = 0; i <= TRIAL_FRAMES; i++) trial.energy[i] = 5;
    trial.energy[500] += 3;
    trial_go(&trial, 499 + later);
    trial.bodies[1].velocity.x = sqrtf(6);
    trial_go(&trial, 500 + later);
    trial.bodies[1].velocity.x = 0;
    trial_go(&trial, TRIAL_FRAMES);
    return trial_end(&trial);
}

TEST(a_hop_may_be_a_second_late_or_early) {
    assert_verdict(run_with_hop(60), VERDICT_SETTLES);
    assert_verdict(run_with_hop(-60), VERDICT_SETTLES);
    assert_reading(run_with_hop(61), VERDICT_EXPLODES, 1, 561, 3, 1e-5, "J");
    assert_reading(run_with_hop(-61), VERDICT_EXPLODES, 1, 439, 3, 1e-5, "J");
}

/* The converged run falls and has no energy left; this one still stands. */
TEST(a_box_that_still_stands_has_gained_no_energy) {
    Trial trial;
    trial_begin(&trial);
    for (int i = 10; i <= TRIAL_FRAMES; i++) trial.energy[i] = -95;
    trial_go(&trial, TRIAL_FRAMES);
    assert_verdict(trial_end(&trial), VERDICT_SETTLES);
}

/* 50 J at first, 5 J for so many frames, then 30 J (speed along x). The converged run stays at 5 J. */
static VerdictReading run_with_dip(int frames) {
    Trial trial;
    trial_begin(&trial);
    for (int i = 0; i <= TRIAL_FRAMES; i++) trial.energy[i] = 5;
    trial.bodies[1].velocity.x = sqrtf(90);
    trial_go(&trial, 30);
    trial.bodies[1].velocity.x = 0;
    trial_go(&trial, 30 + frames);
    trial.bodies[1].velocity.x = sqrtf(50);
    trial_go(&trial, 30 + frames + 1);
    return trial_end(&trial);
}

/* Seconds end at frames 60, 120, ...: a dip of 30 + 60 frames covers a whole one. */
TEST(energy_that_returns_within_a_second_was_not_lost) {
    assert_true(run_with_dip(60).verdict < VERDICT_EXPLODES);
    assert_true(run_with_dip(89).verdict < VERDICT_EXPLODES);
    assert_reading(run_with_dip(90), VERDICT_EXPLODES, 1, 121, 25, 1e-4, "J");
}

/* The box has 5 J, and `more` J until frame 90; after frame 100 a bomb is added with 10 J. Then the bomb has 5 J left
   and the box is given some J. */
static VerdictReading run_with_bomb(double before, double given) {
    Trial trial;
    trial_begin(&trial);
    for (int i = 0; i <= TRIAL_FRAMES; i++) trial.energy[i] = 5;
    trial.bodies[1].velocity.x = (float)sqrt(2 * before);
    trial_go(&trial, 90);
    trial.bodies[1].velocity.x = 0;
    trial_go(&trial, 99);
    trial.bomb = trial.count++;
    trial.bodies[2] = trial_box;
    trial.bodies[2].position = vec2(3, 0.5f);
    trial.bodies[2].velocity.x = sqrtf(10);
    trial_go(&trial, 150);
    trial.bodies[2].velocity.x = 0;
    trial.bodies[1].velocity.x = (float)sqrt(2 * given);
    trial_go(&trial, 151);
    return trial_end(&trial);
}

/* The bomb adds 5 J of kinetic and 5 J of potential energy to the 5 or 25 J before. */
TEST(the_energy_of_a_bomb_counts) {
    assert_true(run_with_bomb(0, 5.99).verdict < VERDICT_EXPLODES);
    assert_reading(run_with_bomb(0, 6.01), VERDICT_EXPLODES, 1, 151, 1.01, 1e-4, "J");
    assert_true(run_with_bomb(20, 25.99).verdict < VERDICT_EXPLODES);
    assert_reading(run_with_bomb(20, 26.01), VERDICT_EXPLODES, 1, 151, 1.01, 1e-4, "J");
}

/* The upper one of two boxes is removed, with 15 J: the lower one must not gain them. */
TEST(a_removed_body_takes_its_energy_along) {
    for (int side = 0; side < 2; side++) {
        Trial trial;
        trial_begin(&trial);
        for (int i = 0; i <= TRIAL_FRAMES; i++) trial.energy[i] = 5;
        trial.bodies[trial.count] = trial_box;
        trial.bodies[trial.count++].position.y = 1.5f;
        trial_go(&trial, 100);
        trial.count--;
        trial_go(&trial, 101);
        trial.bodies[1].velocity.x = side == 0 ? 1.4f : 1.43f; /* 0.98, 1.02 J */
        trial_go(&trial, 102);
        assert_true((trial_end(&trial).verdict == VERDICT_EXPLODES) == (side == 1));
    }
}

TEST(nan_and_infinity_are_non_finite) {
    for (int i = 0; i < 12; i++) {
        Trial trial;
        trial_begin(&trial);
        Body *box = &trial.bodies[1];
        float *const fields[] = {&box->position.x, &box->position.y, &box->angle,
                                 &box->velocity.x, &box->velocity.y, &box->angular_velocity};
        box->velocity = vec2(3, 4);
        trial_go(&trial, 7);
        *fields[i / 2] = i % 2 == 0 ? NAN : INFINITY;
        trial_go(&trial, 9);
        assert_true(verdict_watch_is_final(&trial.watch));
        assert_reading(trial_end(&trial), VERDICT_NON_FINITE, 1, 8, 5, 1e-6, "m/s");
    }
}

TEST(a_failed_step_is_non_finite) {
    Trial trial;
    trial_begin(&trial);
    trial.bodies[1].velocity = vec2(-3, 4);
    trial_go(&trial, 7);
    Error failure = {0};
    error_failure(&failure, FAILURE_NOT_FINITE, "world", "the state of body 1 is NaN or infinite");
    verdict_watch_failed(&trial.watch, 8, &failure);
    verdict_watch_failed(&trial.watch, 9, &failure);
    assert_true(verdict_watch_is_final(&trial.watch));
    assert_reading(trial_end(&trial), VERDICT_NON_FINITE, -1, 8, 5, 1e-6, "m/s");
}

/* All verdicts from creeping on apply, one after the other; each is worse than those before. */
TEST(the_worst_verdict_counts_with_its_first_frame) {
    Trial trial;
    trial_begin(&trial);
    trial_go(&trial, 1100);
    trial.bodies[1].position.x = 1;
    trial_go(&trial, 1200);
    assert_reading(trial.watch.worst, VERDICT_CREEPS, 1, 1200, 1, 1e-6, "m");
    trial.bodies[1].angle = 1;
    trial_go(&trial, 1201);
    assert_reading(trial.watch.worst, VERDICT_FALLS, 1, 1201, 57.29578, 1e-4, "deg");
    trial.contacts[0].separation = -0.2f;
    trial_go(&trial, 1261);
    assert_reading(trial.watch.worst, VERDICT_SINKS, 1, 1261, 0.2, 1e-6, "m");
    trial.bodies[1].position.y = -20.1f;
    trial_go(&trial, 1270);
    assert_reading(trial.watch.worst, VERDICT_TUNNELS, 1, 1262, 1236, 1e-2, "m/s");
    assert_false(verdict_watch_is_final(&trial.watch));
    for (int i = 0; i <= TRIAL_FRAMES; i++) trial.energy[i] = 0;
    trial.bodies[1].position.y = 2;
    trial_go(&trial, 1280);
    assert_reading(trial.watch.worst, VERDICT_EXPLODES, -1, 1271, 15, 1e-4, "J");
    assert_true(verdict_watch_is_final(&trial.watch));
    trial.bodies[1].angle = NAN;
    trial_go(&trial, 1290);
    assert_verdict(trial_end(&trial), VERDICT_NON_FINITE);
}

TEST(verdicts_have_names) {
    const char *const names[VERDICTS] = {"settles",   "agrees",  "stands",    "moves",        "creeps",
                                         "undecided", "falls",   "collapses", "too few fall", "too many fall",
                                         "sinks",     "tunnels", "explodes",  "non-finite",   "adapter failed"};
    for (int i = 0; i < VERDICTS; i++) {
        assert_string_equal(verdict_name((Verdict)i), names[i]);
        assert_true(verdict_holds((Verdict)i) == (i < 5));
    }
}

TEST(a_converged_run_that_is_shorter_is_refused) {
    Trial trial;
    trial_begin(&trial);
    trial.converged.frames--;
    assert_refused(verdict_watch_begin(&trial.watch, &trial.run, trial.bodies, trial.count, &error),
                   "the converged run has only 3599 of 3600 frames");
    verdict_watch_free(&trial.watch);
}

RUN_TESTS(NULL, NULL)
