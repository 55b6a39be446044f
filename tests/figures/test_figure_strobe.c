/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "owned.h"

#include "figures/run_figure.h"
#include "pictures/mesa.h"

/* The first box rests; the second, two metres wide, moves right by a metre per frame; no bomb. */
static Trajectory *run_rolling(void) {
    Trajectory *run = run_make("engine", 9);
    run->bomb = -1;
    for (int frame = 0; frame < 9; frame++) {
        *run_position(run, frame, SECOND_BOX) = vec2(2 + (float)frame, 0.5f);
        *run_angle(run, frame, SECOND_BOX) = 0;
        *run_position(run, frame, BOMB_BODY) = vec2(NAN, NAN);
        *run_angle(run, frame, BOMB_BODY) = NAN;
    }
    /* A known view, so that pixels can be located: 20 x 10 m with the ground's top in the middle. */
    run->camera_center = vec2(5, 0);
    run->camera_size = vec2(20, 10);
    return run;
}

static int alpha_at(const Image *image, double x, double y) {
    int column = (int)((x + 5) / 20 * image->width), row = (int)((5 - y) / 10 * image->height);
    return image->pixels[4 * (row * image->width + column) + 3];
}

TEST(earlier_is_paler) {
    Trajectory *run = run_rolling();
    FigureSpec spec = spec_of(&run, 1);
    spec.time_count = 3;
    spec.times[1] = 4 / 60.0, spec.times[2] = 8 / 60.0;
    Sketch sketch;
    draw_kind(&sketch, "strobe", &spec);
    assert_int_equal(count_marks(&sketch, MARK_IMAGE), 1);
    assert_int_equal(count_texts(&sketch, "engine, 3 moments from 0.00 to 0.13 s"), 1);
    const Image *image = nth_mark(&sketch, MARK_IMAGE, 0)->image;
    assert_near(image->width, 2.0 * image->height, 2);
    assert_int_equal(alpha_at(image, -2, 0.5), 255); /* at rest: equal in all frames */
    assert_int_equal(alpha_at(image, 10, 0.4), 255);
    assert_near(alpha_at(image, 6, 0.4), 0.5 * 255, 1);
    assert_near(alpha_at(image, 2, 0.4), 0.12 * 255, 1);
    assert_int_equal(alpha_at(image, 4, 0.4), 0);
    assert_int_equal(alpha_at(image, 4, -3), 255); /* the ground is drawn once */
    free_drawn(&sketch, &run, 1);
}

TEST(the_bombs_way_is_drawn_and_timed) {
    Trajectory *run = run_make("engine", 21);
    FigureSpec spec = spec_of(&run, 1);
    spec.time_count = 3;
    spec.times[0] = 0, spec.times[1] = 10 / 60.0, spec.times[2] = 20 / 60.0;
    Sketch sketch;
    draw_kind(&sketch, "strobe", &spec);
    /* It appears in frame 2: there is no label for frame 0. */
    assert_int_equal(count_texts(&sketch, "0.00 s"), 0);
    assert_texts(&sketch, "0.17 s", "0.33 s");
    int parts = 0;
    double left = HUGE_VAL, right = -HUGE_VAL, low = HUGE_VAL, high = -HUGE_VAL;
    for (size_t i = 0; i < sketch.mark_count; i++) {
        const SketchMark *mark = &sketch.marks[i];
        if (mark->kind != MARK_PATH || mark->closed || mark->pen.width != 1.4) continue;
        parts++;
        for (int k = 0; k < 2; k++) {
            const Point *p = &sketch.points[mark->first + (size_t)k];
            left = fmin(left, p->x), right = fmax(right, p->x), low = fmin(low, p->y), high = fmax(high, p->y);
        }
    }
    /* The window ends at 4 m + 0.75 m (cos 0.2 + sin 0.2) + 0.4 m = 5.28 m, where the bomb enters in frame 4. */
    assert_int_equal(parts, 16);
    assert_near(right, left, 1e-9);
    assert_true(high - low > 10);
    free_drawn(&sketch, &run, 1);
}

TEST(moments_are_as_many_as_asked_for) {
    OWN(Trajectory) *run = run_make("engine", 21);
    FigureSpec spec = spec_of(&run, 1);
    Sketch sketch;
    draw_kind(&sketch, "strobe", &spec);
    assert_int_equal(count_texts(&sketch, "engine, 9 moments from 0.00 to 0.33 s"), 1);
    sketch_free(&sketch);
    spec.moments = 1;
    draw_kind(&sketch, "strobe", &spec);
    assert_int_equal(count_texts(&sketch, "engine, 0.33 s"), 1);
    sketch_free(&sketch);
    spec.time_count = 1, spec.times[0] = 1;
    expect_kind_refused("strobe", &spec, "a.npz: error: has no moment at 1 s");
}

RUN_TESTS(NULL, NULL)
