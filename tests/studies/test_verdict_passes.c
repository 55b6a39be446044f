/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Moving bodies that pass through each other, from their poses alone. */
#include "studies/trial.h"

typedef struct Pose {
    float x, y, angle;
} Pose;

/* Two boxes far above the ground: the first stays at the origin, the second takes these poses. Whether it tunnels. */
static bool passes(Vec2 first, float first_angle, Vec2 second, const Pose *poses, int count) {
    Trial trial;
    trial_begin(&trial);
    trial.run.stands = false;
    trial.contact_count = 0;
    trial.count = 3;
    trial.bodies[0].position.y = -100;
    trial.bodies[1] = trial.bodies[2] = trial_box;
    trial.bodies[1].position = vec2(0, 0);
    trial.bodies[1].size = first;
    trial.bodies[1].angle = first_angle;
    trial.bodies[2].size = second;
    for (int i = 0; i < count; i++) {
        trial.bodies[2].position = vec2(poses[i].x, poses[i].y);
        trial.bodies[2].angle = poses[i].angle;
        trial_go(&trial, i + 1);
        if (i == 0) assert_int_equal(trial.watch.worst.verdict, VERDICT_SETTLES);
    }
    const VerdictReading reading = trial_end(&trial);
    if (reading.verdict != VERDICT_TUNNELS) return false;
    assert_true(reading.body == 2 && reading.other == 1);
    assert_string_equal(reading.unit, "m/s");
    return true;
}

#define WAY(...) (const Pose[]){__VA_ARGS__}, (int)(sizeof((const Pose[]){__VA_ARGS__}) / sizeof(Pose))

static const Vec2 unit = {1, 1}, small = {0.2f, 0.2f};

TEST(a_fast_box_passes_through_another) {
    assert_true(passes(unit, 0, unit, WAY({-3, 0, 0}, {3, 0, 0})));
    assert_true(passes(unit, 0, unit, WAY({-30, 0.4f, 0}, {3000, 0.4f, 0})));
    assert_true(passes(unit, 0, small, WAY({-3, 0, 0}, {3, 0, 0})));
    assert_true(passes(unit, 0.8f, small, WAY({-3, 0.2f, 0.3f}, {3, 0.2f, 2})));
    /* Past it: the boxes overlap by less than half of the smaller side on the way. */
    assert_false(passes(unit, 0, unit, WAY({-3, 0.51f, 0}, {3, 0.51f, 0})));
    assert_false(passes(unit, 0, small, WAY({-3, 0.51f, 0}, {3, 0.51f, 0})));
    assert_true(passes(unit, 0, small, WAY({-3, 0.49f, 0}, {3, 0.49f, 0})));
    /* Up to it, and back. */
    assert_false(passes(unit, 0, unit, WAY({-3, 0, 0}, {-0.9f, 0, 0}, {-3, 0, 0})));
}

/* Plates of 2 m x 3 cm that sink through each other, frame by frame, also if only their ends lie on each other. */
TEST(plates_change_places) {
    const Vec2 plate = {2, 0.03f};
    assert_true(passes(plate, 0, plate,
                       WAY({0, 0.03f, 0}, {0, 0.02f, 0}, {0, 0.01f, 0}, {0, 0, 0}, {0, -0.01f, 0}, {0, -0.02f, 0})));
    assert_true(
        passes(plate, 0, plate, WAY({1.5f, 0.03f, 0}, {1.5f, 0.012f, 0}, {1.5f, -0.012f, 0}, {1.5f, -0.03f, 0})));
    /* Deep in each other for some frames, then apart as before. */
    assert_false(passes(plate, 0, plate, WAY({0, 0.03f, 0}, {0, 0.012f, 0}, {0, -0.012f, 0}, {0, 0.03f, 0})));
    /* Slop. */
    assert_false(passes(plate, 0, plate, WAY({0, 0.03f, 0}, {0, 0.02f, 0}, {0, 0.03f, 0})));
}

/* A box that slides over another and drops beside it, and a plank that turns over an edge, pass through nothing. */
TEST(what_goes_around_does_not_pass) {
    Pose around[60], over[60];
    for (int i = 0; i < 60; i++) {
        const float angle = 3.14159265f * (float)i / 59;
        around[i] = (Pose){-1.5f * cosf(angle), 1.5f * sinf(angle), angle};
        over[i] = (Pose){0.5f * (1 + cosf(angle)), 0.5f + 0.5f * sinf(angle) + 0.06f, angle};
    }
    assert_false(passes(unit, 0, unit, around, 60));
    assert_false(passes(unit, 0, vec2(2, 0.1f), over, 60));
}

RUN_TESTS(NULL, NULL)
