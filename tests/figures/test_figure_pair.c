/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "owned.h"

#include "figures/figure.h"
#include "figures/run_figure.h"

static void add(Trajectory *run, int step, int a, int b) {
    Error error = {0};
    const TrajectoryContact contact = {a, b, 0, vec2(0, 0), vec2(1, 0), 1, 0};
    assert_ok(trajectory_add_contact(run, step, &contact, &error), error);
}

/* From frame 3 on, the second box, 2 x 1 m, is 20 mm deep in the right side of the first, 1 x 1 m; the bomb is far
   away. */
static Trajectory *run_touching(void) {
    Trajectory *run = run_make("engine", 8);
    run->bomb = -1;
    for (int frame = 3; frame < 8; frame++) {
        *run_position(run, frame, FIRST_BOX) = vec2(-2, 0.5f);
        *run_position(run, frame, SECOND_BOX) = vec2(-0.52f, 0.5f);
        *run_angle(run, frame, SECOND_BOX) = 0;
    }
    for (int step = 1; step < 8; step++) {
        add(run, step, GROUND_BODY, FIRST_BOX);
        if (step > 3) add(run, step, FIRST_BOX, SECOND_BOX), add(run, step, FIRST_BOX, SECOND_BOX);
    }
    trajectory_end_contacts(run);
    return run;
}

TEST(the_pairs_own_numbers_are_written) {
    OWN(Trajectory) *run = run_touching();
    FigureSpec spec = spec_of(&run, 1);
    for (int column = 0; column < 2; column++) {
        if (column) spec.width = FIGURE_COLUMN_WIDTH;
        Sketch sketch;
        draw_kind(&sketch, "narrow-phase", &spec);
        assert_int_equal(count_texts(&sketch, "engine, 0.050 s, bodies 1 and 2"), 1);
        assert_int_equal(count_texts(&sketch, "normal (1.000, 0.000)"),
                         1); /* in world coordinates, although the picture is rotated */
        assert_int_equal(count_texts(&sketch, "\xE2\x88\x92"
                                              "20 mm"),
                         2);
        assert_int_equal(count_texts(&sketch, "box 1 x: 20 mm") + count_texts(&sketch, "box 2 x: 20 mm"), 2);
        assert_int_equal(count_texts(&sketch, "box 1 y: 1000 mm"), 1);
        assert_int_equal(count_texts(&sketch, "down"), 1);
        assert_near(sketch.width, spec.width, 0);
        sketch_free(&sketch);
    }
}

/* Typical pairs of runs, with any normal: after the rotation the normal points up out of the reference box, and
   depths and distances are unchanged. */
TEST(turning_changes_no_length) {
    int turned = 0;
    for (int i = 0; i < 200; i++) {
        const float angle = 0.11f * (float)i, way = 0.37f * (float)i;
        Collision c = {
            .boxes = {box_make(vec2(3, -2), vec2(1, 1), angle),
                      box_make(vec2(3 + 0.9f * cosf(way), -2 + 0.9f * sinf(way)), vec2(1.5f, 0.8f), -angle)}};
        if (!collision_find(&c)) continue;
        turned++;
        const Collision before = c;
        const Vec2 down = collision_turn_up(&c);
        const float side = c.overlaps[c.least].box == 0 ? 1.0f : -1.0f;
        assert_near(side * c.manifold.normal.y, 1, 1e-5);
        assert_near(c.manifold.normal.x, 0, 1e-5);
        assert_near(hypotf(down.x, down.y), 1, 1e-5);
        /* The angle between down and the normal is unchanged. */
        assert_near(vec2_dot(down, c.manifold.normal), -before.normal.y, 1e-5);
        assert_memory_equal(&c.normal, &before.normal, sizeof c.normal);
        Vec2 from = vec2_sub(c.boxes[1].position, c.boxes[0].position);
        Vec2 once = vec2_sub(before.boxes[1].position, before.boxes[0].position);
        assert_near(hypotf(from.x, from.y), hypotf(once.x, once.y), 1e-5);
        /* Projections of the rotated boxes on the rotated axes are unchanged. */
        for (int k = 0; k < SEPARATING_AXES; k++)
            for (int box = 0; box < 2; box++) {
                const AxisOverlap *overlap = &c.overlaps[k];
                double middle = (double)vec2_dot(c.boxes[box].position, overlap->axis);
                assert_near(middle, (overlap->low[box] + overlap->high[box]) / 2, 1e-4);
            }
    }
    assert_true(turned > 150);
}

TEST(what_cannot_be_shown_is_refused) {
    OWN(Trajectory) *run = run_touching(), *without = run_make("engine", 3);
    FigureSpec spec = spec_of(&without, 1);
    expect_kind_refused("narrow-phase", &spec, "a.npz: error: no two dynamic bodies touch");
    spec = spec_of(&run, 1);
    spec.body_count = 2, spec.bodies[0] = 2, spec.bodies[1] = 3;
    expect_kind_refused("narrow-phase", &spec, "a.npz: error: bodies 2 and 3 do not touch");
    spec.bodies[1] = 44;
    expect_kind_refused("narrow-phase", &spec, "there is no body 44; the run has 4");
    spec.bodies[0] = 0, spec.bodies[1] = 1;
    expect_kind_refused("narrow-phase", &spec, "bodies 0 and 1 have sides from 1 to 100 m");
    spec.bodies[0] = 1, spec.bodies[1] = 2;
    spec.time_count = 1, spec.times[0] = 0;
    expect_kind_refused("narrow-phase", &spec, "bodies 1 and 2 do not touch in that step");
    spec.times[0] = 3 / 60.0;
    *run_position(run, 3, SECOND_BOX) = vec2(9, 9);
    expect_kind_refused("narrow-phase", &spec, "touch in the step after 0.05 s, but not at the poses");
}

RUN_TESTS(NULL, NULL)
