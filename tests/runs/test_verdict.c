/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The definitions of the verdict (runs/verdict.h), each from both sides, on runs whose poses are made here: a ground,
   boxes of 1 m and 1 kg in a gravity of 10 m/s^2, steps of 1/60 s. A unit is then one second. */
#include "testing.h"

#include "runs/verdict.h"

enum { SECOND = 60, HALF = SECOND / 2 };

typedef struct Trial {
    int frame, count;
    Body bodies[8];
    VerdictRun run;
    VerdictWatch watch;
} Trial;

static Trial trial_on_ground(void) {
    return (Trial){.count = 1,
                   .bodies = {{.position = {0, -10}, .size = {100, 20}}},
                   .run = {.gravity = {0, -10}, .dt = 1.0f / SECOND, .bomb = -1, .finds_contacts = true}};
}

static Body *add_box(Trial *trial, float x, float y) {
    trial->bodies[trial->count] = (Body){.position = {x, y}, .size = {1, 1}, .inv_mass = 1, .inv_inertia = 6};
    return &trial->bodies[trial->count++];
}

/* A box at rest on the ground; it overlaps it by a millimetre. */
static Trial box_on_ground(void) {
    Trial trial = trial_on_ground();
    add_box(&trial, 0, 0.499f);
    return trial;
}

/* A shelf, which is static, whose upper face is at y = 0, far above the ground. */
static Trial trial_on_shelf(void) {
    Trial trial = trial_on_ground();
    trial.bodies[0].position.y = -15;
    trial.bodies[trial.count++] = (Body){.position = {0, -0.5f}, .size = {1, 1}};
    return trial;
}

/* So many boxes on one another. */
static Trial stack_of(int count) {
    Trial trial = trial_on_ground();
    for (int i = 0; i < count; i++) add_box(&trial, 0, 0.499f + 0.999f * (float)i);
    return trial;
}

/* Steps up to a frame, in which the bodies are where they are now; the first call begins the watch. */
static void go(Trial *trial, int frame) {
    Error error = {0};
    if (trial->watch.capacity == 0)
        assert_ok(verdict_watch_begin(&trial->watch, &trial->run, trial->bodies, trial->count, &error), error);
    while (trial->frame < frame) {
        const VerdictStep step = {.frame = ++trial->frame, .body_count = trial->count, .bodies = trial->bodies};
        assert_ok(verdict_watch_step(&trial->watch, &step, &error), error);
    }
}

static VerdictReading end(Trial *trial) {
    const VerdictReading reading = verdict_watch_end(&trial->watch);
    verdict_watch_free(&trial->watch);
    return reading;
}

#define assert_verdict(reading, expected)                                                                    \
    do {                                                                                                     \
        const VerdictReading reading_ = (reading);                                                           \
        if (reading_.verdict != (expected))                                                                  \
            fail_msg("%s (body %d, frame %d, %g %s), not %s", verdict_name(reading_.verdict), reading_.body, \
                     reading_.frame, reading_.value, reading_.unit, verdict_name(expected));                 \
    } while (0)

TEST(what_never_moves_rests_throughout) {
    Trial trial = box_on_ground();
    go(&trial, SECOND);
    const VerdictReading reading = end(&trial);
    assert_verdict(reading, VERDICT_SETTLES);
    assert_true(!reading.moving && !reading.struck && reading.since == 0 && reading.count.bodies == 1);
}

TEST(half_a_unit_tells_whether_it_rests) {
    for (int frames = HALF - 1; frames <= HALF; frames++) {
        Trial trial = box_on_ground();
        go(&trial, frames);
        const VerdictReading reading = end(&trial);
        assert_verdict(reading, frames < HALF ? VERDICT_TOO_SHORT : VERDICT_SETTLES);
        assert_true(reading.too_short == (frames < HALF));
        assert_true(verdict_sound(reading.verdict) && verdict_holds(reading.verdict) == (frames == HALF));
    }
}

/* The run in which the box has moved or turned at this frame. A corner is 0.707 m from the centre. */
static VerdictReading moved_once(float way, float turn, int frame, int last) {
    Trial trial = box_on_ground();
    go(&trial, frame - 1);
    trial.bodies[1].position.x += way;
    trial.bodies[1].angle += turn;
    go(&trial, last);
    return end(&trial);
}

TEST(a_place_is_two_percent_of_a_size_wide) {
    assert_int_equal(moved_once(0.0199f, 0, 60, 300).since, 0);
    assert_int_equal(moved_once(0.0201f, 0, 60, 300).since, 60);
    assert_int_equal(moved_once(0, 0.0282f, 60, 300).since, 0);
    assert_int_equal(moved_once(0, 0.0284f, 60, 300).since, 60);
    assert_int_equal(moved_once(0, (float)(2 * M_PI), 60, 300).since, 0); /* some engines keep angles within a turn */
}

TEST(what_took_its_place_half_a_unit_ago_rests) {
    assert_verdict(moved_once(0.1f, 0, 60, 60 + HALF), VERDICT_SETTLES);
    const VerdictReading reading = moved_once(0.1f, 0, 60, 59 + HALF);
    assert_verdict(reading, VERDICT_MOVES);
    assert_true(reading.body == 1 && reading.frame == 59 + HALF && reading.moving && !reading.too_short);
}

/* At 22 mm/s it takes a new place every 55 frames; at 5 mm/s, every 240. */
TEST(gliding_evenly_never_rests) {
    for (int i = 0; i < 2; i++) {
        Trial trial = box_on_ground();
        for (int frame = 1; frame <= 1200; frame++) {
            trial.bodies[1].position.x = (i == 0 ? 0.022f : 0.005f) * (float)frame / SECOND;
            go(&trial, frame);
        }
        assert_verdict(end(&trial), VERDICT_MOVES);
    }
}

TEST(a_body_has_fallen_when_it_is_half_a_side_lower_or_has_turned_by_30_degrees) {
    static const struct {
        float lower, degrees;
        bool fell;
    } cases[] = {{0.49f, 0, false}, {0.51f, 0, true}, {0, 29, false}, {0, 31, true}, {0, -31, true}, {0, 359, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Trial trial = trial_on_shelf();
        Body *box = add_box(&trial, 0, 0.7f); /* a gap below it, which closes: no fall */
        go(&trial, 10);
        box->position = vec2(1.2f, 0.5f - cases[i].lower); /* beside the shelf */
        box->angle += cases[i].degrees * (float)(M_PI / 180);
        go(&trial, 30);
        const VerdictReading reading = end(&trial);
        assert_int_equal(reading.count.fell, cases[i].fell);
        if (cases[i].fell) assert_true(reading.count.first == 11 && reading.count.body == 2 && reading.frame == 11);
    }
}

/* Each of five boxes sinks by 0.15 m into the one below: the top is 0.75 m lower. */
TEST(sag_is_no_fall) {
    Trial trial = stack_of(5);
    go(&trial, 10);
    for (int i = 1; i <= 5; i++) trial.bodies[i].position.y -= 0.15f * (float)i;
    go(&trial, 100);
    const VerdictReading reading = end(&trial);
    assert_int_equal(reading.count.fell, 0);
    assert_near(reading.deepest, 0.151, 1e-5);
    trial = stack_of(2); /* the lower one sags by 0.3 m, and the upper one falls beside it, 0.55 m further */
    go(&trial, 10);
    trial.bodies[1].position.y -= 0.3f;
    trial.bodies[2].position = vec2(1.2f, trial.bodies[2].position.y - 0.85f);
    go(&trial, 30);
    const VerdictCount count = end(&trial).count;
    assert_true(count.fell == 1 && count.body == 2);
}

/* A stack of three beside another box: what stands on a box that fell has fallen, what stands on another has not. */
TEST(what_stands_on_a_fallen_body_fell_with_it) {
    Trial trial = trial_on_shelf();
    for (int i = 0; i < 3; i++) add_box(&trial, 0, 0.499f + 0.999f * (float)i);
    add_box(&trial, 0, -4.501f)->position.x = 10;
    go(&trial, 10);
    for (int i = 2; i < 5; i++) trial.bodies[i].position = vec2_add(trial.bodies[i].position, vec2(1.2f, -0.9f));
    go(&trial, 100);
    assert_int_equal(end(&trial).count.fell, 3);
}

/* A box is pressed into the one below it, to the end or until it has gone through. */
TEST(what_is_pressed_in_has_not_fallen) {
    for (int i = 0; i < 2; i++) {
        Trial trial = stack_of(2);
        go(&trial, 10);
        trial.bodies[2].position.y -= i == 0 ? 0.9f : 2.1f;
        go(&trial, 100);
        assert_int_equal(end(&trial).count.fell, i);
    }
}

/* The lower face of the ground is at -20 m; nothing carries the box. */
TEST(what_is_below_all_static_bodies_has_left) {
    static const struct {
        float x, y;
        bool left, moving;
    } cases[] = {{80, -19, false, false}, {0, -20.7f, false, false}, {0, -20.72f, true, false}, {80, -30, true, true}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Trial trial = stack_of(2);
        add_box(&trial, 0, 20);
        go(&trial, 10);
        trial.bodies[3].position = vec2(cases[i].x, cases[i].y);
        go(&trial, 99);
        if (cases[i].moving) trial.bodies[3].position.y -= 1;
        go(&trial, 100);
        const VerdictReading reading = end(&trial);
        assert_int_equal(reading.count.left, cases[i].left);
        assert_int_equal(reading.count.fell, cases[i].left);
        assert_int_equal(reading.count.bodies, 3);
        assert_int_equal(reading.moving, cases[i].moving);
    }
}

TEST(moved_is_a_tenth_of_a_size_beside) {
    for (int i = 0; i < 2; i++) {
        const float way = i == 0 ? 0.099f : 0.101f;
        const VerdictReading reading = moved_once(way, 0, 10, 100);
        assert_int_equal(reading.count.moved, i);
        assert_near(reading.count.farthest, i == 0 ? 0 : way, 1e-6);
    }
}

/* Of five boxes two move, the first farther; two fall, one of them out of the scene; one stays. */
TEST(each_number_is_of_its_bodies) {
    Trial trial = trial_on_ground();
    for (int i = 0; i < 5; i++) add_box(&trial, 3 * (float)i, 0.499f);
    go(&trial, 600);
    trial.bodies[1].position.x -= 0.75f;
    trial.bodies[2].position.x += 0.25f;
    trial.bodies[3].angle = 1;
    trial.bodies[4].position.y = -25;
    go(&trial, 700);
    trial.bodies[1].position.x += 0.25f;
    go(&trial, 701);
    const VerdictReading reading = end(&trial);
    const VerdictCount *count = &reading.count;
    assert_true(count->bodies == 5 && count->fell == 2 && count->left == 1 && count->moved == 2 && count->first == 601);
    assert_near(count->farthest, 0.5, 1e-5);
    assert_near(reading.drift, 25.499, 1e-4);
}

/* Stays of 60 frames, then one of 59 in which the box goes on at some share of their pace, 2% of its size a stay; or
   goes 1.9% at once, and rests for the last unit or for a little more than the last half unit. */
TEST(what_goes_on_at_half_its_pace_moves) {
    static const struct {
        float share, at_once;
        int last;
        bool moves;
    } cases[] = {{0.45f, 0, 59, false}, {0.55f, 0, 59, true}, {0, 0.019f, 100, false}, {0, 0.019f, 35, true}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Trial trial = box_on_ground();
        for (int stay = 0; stay < 4; stay++) {
            go(&trial, 60 * (stay + 1) - 1);
            trial.bodies[1].position.x += 0.03f;
        }
        go(&trial, 240);
        trial.bodies[1].position.x += cases[i].at_once;
        for (int frame = 1; frame <= cases[i].last; frame++) {
            trial.bodies[1].position.x += cases[i].share * 0.02f / 60;
            go(&trial, 240 + frame);
        }
        assert_int_equal(end(&trial).moving, cases[i].moves);
    }
}

/* Whether a box that turns after a while had a carrier: one below the gap. It goes sideways at some m/s at the
   start. */
static bool is_carried(float gap, float speed) {
    Trial trial = trial_on_ground();
    Body *box = add_box(&trial, 0, 0.5f + gap);
    box->velocity.x = speed;
    go(&trial, 10);
    box->angle = 1;
    go(&trial, 20);
    return end(&trial).count.fell == 1;
}

/* What starts at rest would fall by 5 m in a unit, 1 s. What goes by 0.5 m in that time is not at rest. */
TEST(a_carrier_is_below_by_half_a_side_or_by_the_fall_of_a_unit) {
    assert_true(is_carried(4.99f, 0) && !is_carried(5.01f, 0));
    assert_true(is_carried(4.99f, 0.49f) && !is_carried(4.99f, 0.51f));
    assert_true(is_carried(0.49f, 3) && !is_carried(0.51f, 3));
}

/* A box that nothing carries at the start gets its carrier, and its reference, when the bomb strikes. */
TEST(what_has_no_carrier_gets_it_when_the_bomb_strikes) {
    for (int i = 0; i < 2; i++) {
        Trial trial = trial_on_ground();
        add_box(&trial, 0, 9);
        trial.run.bomb = 2;
        go(&trial, 10);
        trial.bodies[1].position.y = i == 0 ? 0.99f : 1.01f; /* 0.49 m or 0.51 m above the ground */
        trial.bodies[1].angle = 1.5708f;                     /* no fall */
        go(&trial, 40);
        add_box(&trial, -0.99f, 0.5f);
        go(&trial, 42);
        trial.bodies[1].angle = 1;
        go(&trial, 100);
        assert_int_equal(end(&trial).count.fell, i == 0);
    }
}

/* Of four boxes on the ground, which some leave in the frame after the bomb has touched one. */
static VerdictReading struck(int falling, bool touched) {
    Trial trial = trial_on_ground();
    for (int i = 0; i < 4; i++) add_box(&trial, 3 * (float)i, 0.499f);
    trial.run.bomb = 5;
    go(&trial, 10);
    add_box(&trial, touched ? -0.99f : -20, 0.499f);
    go(&trial, 11);
    for (int i = 1; i <= falling; i++) trial.bodies[i].angle = 1.5f;
    go(&trial, 100);
    return end(&trial);
}

TEST(all_dynamic_bodies_but_the_bomb_count) {
    static const Verdict expected[] = {VERDICT_STANDS, VERDICT_FALLS, VERDICT_COLLAPSES, VERDICT_COLLAPSES};
    for (int k = 0; k < 4; k++) {
        const VerdictReading reading = struck(k, true);
        assert_verdict(reading, expected[k]);
        assert_true(reading.struck && reading.count.bodies == 4 && reading.count.fell == k);
    }
    assert_verdict(struck(3, false), VERDICT_FALLS); /* by themselves */
}

TEST(some_that_start_with_a_speed_strike) {
    for (int starting = 0; starting <= 2; starting++) {
        Trial trial = trial_on_ground();
        add_box(&trial, 0, 0.499f)->velocity.x = starting > 0 ? 1 : 0;
        add_box(&trial, 5, 0.499f)->velocity.x = starting > 1 ? 1 : 0;
        go(&trial, 100);
        assert_int_equal(end(&trial).struck, starting == 1);
    }
}

TEST(deeper_than_a_quarter_for_half_a_unit_sinks) {
    static const struct {
        float depth;
        int frames;
        bool sinks;
    } cases[] = {{0.26f, HALF, false}, {0.26f, HALF + 2, true}, {0.24f, 100, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Trial trial = box_on_ground();
        go(&trial, 10);
        trial.bodies[1].position.y = 0.5f - cases[i].depth;
        go(&trial, 10 + cases[i].frames);
        trial.bodies[1].position.y = 0.499f;
        go(&trial, 200);
        const VerdictReading reading = end(&trial);
        assert_verdict(reading, cases[i].sinks ? VERDICT_SINKS : VERDICT_SETTLES);
        assert_near(reading.deepest, cases[i].depth, 1e-5);
    }
}

/* A box goes through a resting one, in steps of 0.3 m in which it is in it, by its middle or less than half of a side
   deep; and in one leap, which may rise or sink: then it counts where the two are side by side; or it stays outside. */
TEST(what_is_on_the_other_side_has_tunnelled) {
    static const struct {
        float from, step, height, rise;
        bool tunnels;
    } cases[] = {{-3, 1.5f, 0, 0, false},     {-2, 0.3f, 0, 0, true},     {-2, 0.3f, 0.45f, 0, true},
                 {-2, 0.3f, 0.55f, 0, false}, {-2, 4, 0.45f, 0, true},    {-2, 4, 0.55f, 0, false},
                 {-3.75f, 1.5f, 0, 0, true},  {-1.25f, 5, 0.2f, 1, true}, {-1.25f, 5, 1, -1.6f, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Trial trial = box_on_ground();
        trial.run.gravity.y = 0;
        Body *moving = add_box(&trial, cases[i].from, 0.499f + cases[i].height);
        moving->velocity.x = 1;
        const bool stops = i == 0;
        for (int frame = 1; frame < 30; frame++) {
            go(&trial, frame);
            const Vec2 step = vec2(cases[i].step, cases[i].rise);
            if (!stops || frame == 1) moving->position = vec2_add(moving->position, step);
        }
        const VerdictReading reading = end(&trial);
        assert_int_equal(reading.verdict == VERDICT_TUNNELS, cases[i].tunnels);
        if (cases[i].tunnels) assert_true(reading.body + reading.other == 3);
    }
}

/* Too deep is what is a quarter of the thinner body deep, a static one, too: by less than a quarter of the box. */
TEST(what_goes_through_a_thin_plate_has_tunnelled) {
    Trial trial = {.count = 1, .bodies = {{.size = {20, 0.25f}}}, .run = box_on_ground().run};
    Body *box = add_box(&trial, 0, 1);
    trial.run.gravity.y = 0;
    box->velocity.y = -12;
    for (int frame = 1; frame <= 10; frame++) {
        go(&trial, frame);
        box->position.y -= 0.2f;
    }
    assert_verdict(end(&trial), VERDICT_TUNNELS);
}

TEST(what_touches_nothing_falls_or_hangs) {
    for (int i = 0; i < 3; i++) {
        Trial trial = box_on_ground();
        Body *box = add_box(&trial, 5, i == 2 ? 0.52f : 8); /* or lies 2 cm above the ground: it touches */
        for (int frame = 1; frame <= 70; frame++) {
            const float t = (float)frame / SECOND;
            if (i == 1) box->position.y = 8 - 5 * t * t, box->velocity.y = -10 * t;
            go(&trial, frame);
        }
        const VerdictReading reading = end(&trial);
        assert_int_equal(reading.verdict == VERDICT_HANGS, i == 0);
        if (i == 0) assert_true(reading.body == 2 && reading.frame <= SECOND);
    }
}

/* Two boxes, of which the upper one has 10 m to fall: 100 J are available, 1% is 1 J. */
static VerdictReading with_energy(double joules, int frame, int bomb, double share) {
    Trial trial = box_on_ground();
    add_box(&trial, 5, 10.499f)->inv_mass = 1;
    trial.bodies[3] = (Body){.position = {5, 5}, .size = {1, 9.95f}}; /* what carries it */
    trial.count = 4;
    trial.run.bomb = bomb;
    go(&trial, frame - 1);
    const float speed = (float)sqrt(2 * joules * share);
    trial.bodies[2].velocity.x = speed;
    trial.bodies[1].velocity.x = (float)sqrt(2 * joules * (1 - share));
    go(&trial, frame + 10);
    return end(&trial);
}

TEST(a_percent_of_what_is_available_may_be_gained) {
    assert_verdict(with_energy(0.99, 10, -1, 1), VERDICT_TOO_SHORT);
    const VerdictReading reading = with_energy(1.01, 10, -1, 1);
    assert_verdict(reading, VERDICT_EXPLODES);
    assert_true(reading.frame == 10 && reading.body == 2);
    assert_near(reading.value, 1.01, 1e-5);
    assert_near(reading.excess, 1.01, 1e-5);
    assert_string_equal(reading.unit, "J");
}

TEST(what_is_allowed_is_no_gain) {
    for (int i = 0; i < 2; i++) {
        Trial trial = box_on_ground();
        trial.run.allowed = i == 0 ? 12.6 : 11; /* J */
        go(&trial, 10);
        trial.bodies[1].velocity.x = 5; /* 12.5 J; 0.1 J are free */
        go(&trial, 20);
        assert_int_equal(end(&trial).verdict == VERDICT_EXPLODES, i);
    }
}

TEST(five_times_the_liveliest_bursts_away) {
    for (int i = 0; i < 2; i++) {
        Trial trial = trial_on_ground();
        trial.bodies[0].position.y = -1000;
        trial.run.gravity.y = 0;
        trial.run.masses_unknown = false;
        Body *heavy = add_box(&trial, 0, 0), *light = add_box(&trial, 3, 0);
        heavy->inv_mass = 1e-3f, heavy->inv_inertia = 6e-3f;
        heavy->velocity.x = 1; /* 0.5 J/kg */
        go(&trial, 5);
        light->velocity.x = (float)sqrt(2 * 0.5 * (i == 0 ? 4.99 : 5.01));
        heavy->velocity.x = 0.9f;
        go(&trial, 6);
        const VerdictReading reading = end(&trial);
        assert_int_equal(reading.verdict == VERDICT_EXPLODES, i);
        if (i == 1) assert_true(reading.body == 2 && strcmp(reading.unit, "m/s") == 0);
    }
}

TEST(a_bomb_brings_its_energy_when_it_strikes) {
    for (int i = 0; i < 2; i++) {
        Trial trial = box_on_ground();
        trial.run.bomb = 2;
        go(&trial, 5);
        add_box(&trial, i == 0 ? -0.99f : -20, 0.499f)->velocity.x = 10; /* 50 J */
        go(&trial, 6);
        trial.bodies[2].velocity.x = 0;
        trial.bodies[1].velocity.x = 9; /* 40.5 J, of the bomb's or of nothing */
        go(&trial, 10);
        assert_int_equal(end(&trial).verdict == VERDICT_EXPLODES, i);
    }
}

TEST(a_state_that_is_not_finite_ends_the_run) {
    Trial trial = box_on_ground();
    trial.bodies[1].velocity.x = 3;
    go(&trial, 5);
    trial.bodies[1].angle = NAN;
    go(&trial, 8);
    assert_true(verdict_watch_is_final(&trial.watch));
    const VerdictReading reading = end(&trial);
    assert_verdict(reading, VERDICT_NON_FINITE);
    assert_true(reading.frame == 6 && reading.body == 1);
    assert_near(reading.value, 3, 1e-6);
}

TEST(drift_and_gain_begin_after_ten_units) {
    Trial trial = box_on_ground();
    go(&trial, 599);
    trial.bodies[1].position.x = 3;
    go(&trial, 600);
    trial.bodies[1].position.x = 3.25f;
    trial.bodies[1].velocity.x = 0.1f;
    go(&trial, 700);
    const VerdictReading reading = end(&trial);
    assert_near(reading.drift, 0.25, 1e-6);
    assert_near(reading.gained, 0.005, 1e-6);
    trial = box_on_ground();
    go(&trial, 600);
    assert_true(isnan(end(&trial).drift));
}

TEST(the_reason_of_an_adapter_is_kept) {
    Trial trial = box_on_ground();
    go(&trial, 5);
    error_failure(&error, FAILURE_ADAPTER, "stack", "adapter failed: no answer, in step 6");
    verdict_watch_failed(&trial.watch, 6, &error);
    const VerdictReading reading = end(&trial);
    assert_verdict(reading, VERDICT_ADAPTER_FAILED);
    assert_string_equal(reading.reason, "no answer");
    assert_int_equal(reading.frame, 6);
}

RUN_TESTS(NULL, NULL)
