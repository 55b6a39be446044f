/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Synthetic runs: a ground, a box on it, and the changes that a test makes. */
#pragma once
#include "testing.h"

#include "runs/verdict.h"

enum { TRIAL_FRAMES = 3600, TRIAL_SECOND = 60 };

typedef struct Trial {
    int frame, count, contact_count, bomb;
    Body bodies[4];
    ContactPoint contacts[4];
    VerdictRun run;
    EnergyLog converged;
    double energy[TRIAL_FRAMES + 1]; /* the converged run's */
    VerdictWatch watch;
} Trial;

static const Body trial_ground = {.position = {0, -10}, .size = {100, 20}};
static const Body trial_box = {.position = {0, 0.5f}, .size = {1, 1}, .inv_mass = 1, .inv_inertia = 6};

/* 60 s of a box of 1 kg that is meant to stand, with 100 J available; the converged run has so much energy that nothing
   explodes. */
static inline void trial_begin(Trial *trial) {
    memset(trial, 0, sizeof *trial);
    trial->bomb = -1;
    trial->count = 2;
    trial->bodies[0] = trial_ground;
    trial->bodies[1] = trial_box;
    trial->contact_count = 1;
    trial->contacts[0] = (ContactPoint){.a = 0, .b = 1, .separation = -0.01f};
    for (int i = 0; i <= TRIAL_FRAMES; i++) trial->energy[i] = 1e12;
    trial->converged = (EnergyLog){.frames = TRIAL_FRAMES, .energy = trial->energy, .balance = {.available = 100}};
    trial->run = (VerdictRun){.gravity = {0, -10},
                              .dt = 1.0f / 60.0f,
                              .frames = TRIAL_FRAMES,
                              .stands = true,
                              .converged = &trial->converged};
}

/* Steps up to a frame without moving the bodies; the first call begins the watch. */
static inline void trial_go(Trial *trial, int frame) {
    Error error = {0};
    if (trial->watch.capacity == 0)
        assert_ok(verdict_watch_begin(&trial->watch, &trial->run, trial->bodies, trial->count, &error), error);
    while (trial->frame < frame) {
        const VerdictStep step = {.frame = ++trial->frame,
                                  .body_count = trial->count,
                                  .contact_count = trial->contact_count,
                                  .bomb = trial->bomb,
                                  .bodies = trial->bodies,
                                  .contacts = trial->contacts};
        assert_ok(verdict_watch_step(&trial->watch, &step, &error), error);
    }
}

static inline VerdictReading trial_end(Trial *trial) {
    VerdictReading reading = verdict_watch_end(&trial->watch);
    verdict_watch_free(&trial->watch);
    return reading;
}

/* The run of a scene beside its converged run (or NULL). */
static inline VerdictRun beside(const Scene *scene, bool stands, const EnergyLog *converged) {
    VerdictRun run = verdict_run_of(scene);
    run.stands = stands;
    run.until_bomb = false;
    run.converged = converged;
    return run;
}

#define assert_verdict(reading, expected)                                                                    \
    do {                                                                                                     \
        const VerdictReading reading_ = (reading);                                                           \
        if (reading_.verdict != (expected))                                                                  \
            fail_msg("%s (body %d, frame %d, %g %s), not %s", verdict_name(reading_.verdict), reading_.body, \
                     reading_.frame, reading_.value, reading_.unit, verdict_name(expected));                 \
    } while (0)

#define assert_reading(reading, expected, expected_body, expected_frame, expected_value, tolerance, expected_unit) \
    do {                                                                                                           \
        const VerdictReading found_ = (reading);                                                                   \
        assert_verdict(found_, expected);                                                                          \
        assert_int_equal(found_.body, expected_body);                                                              \
        assert_int_equal(found_.frame, expected_frame);                                                            \
        assert_near(found_.value, expected_value, tolerance);                                                      \
        assert_string_equal(found_.unit, expected_unit);                                                           \
    } while (0)
