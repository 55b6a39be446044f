/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "owned.h"

#include "figures/run_figure.h"
#include "pictures/mesa.h"
#include "figures/labels.h"
#include "figures/sketch.h"
#include "pixels/type.h"

static void add(Trajectory *run, int step, int a, int b, Vec2 point, float normal, float tangent) {
    const TrajectoryContact contact = {a, b, 0, point, vec2(0, 1), normal, tangent};
    add_contact(run, step, contact);
}

/* Both boxes rest on the ground from step 1 on; the bomb touches the second in step 5. */
static Trajectory *run_with_contacts(void) {
    Trajectory *run = run_make("engine", 11);
    for (int step = 1; step <= 10; step++) {
        add(run, step, GROUND_BODY, FIRST_BOX, vec2(-2.5f, 0), 1, 0);
        add(run, step, GROUND_BODY, SECOND_BOX, vec2(2, 0), 10, step == 5 ? -2.5f : 0);
        if (step >= 5) add(run, step, SECOND_BOX, BOMB_BODY, vec2(1.5f, 1), 5, 0);
    }
    trajectory_end_contacts(run);
    return run;
}

/* Arrows are lines in the arrow layer, one each. */
static int gather_arrows(const Sketch *sketch, Point vectors[8], Point tails[8]) {
    int count = 0;
    for (size_t i = 0; i < sketch->mark_count; i++) {
        const SketchMark *mark = &sketch->marks[i];
        if (mark->layer != LAYER_ARROWS || mark->closed) continue;
        assert_true(count < 8);
        /* The head continues to the tip. */
        const Point from = sketch->points[mark->first], tip = sketch->points[sketch->marks[i + 1].first];
        tails[count] = from;
        vectors[count++] = (Point){tip.x - from.x, tip.y - from.y};
    }
    return count;
}

TEST(arrows_are_the_impulses_of_the_step_that_follows) {
    Trajectory *run = run_with_contacts();
    FigureSpec spec = spec_of(&run, 1);
    Sketch sketch;
    Point vectors[8], tails[8];
    draw_kind(&sketch, "annotated", &spec);
    assert_int_equal(count_texts(&sketch, "engine, 0.067 s"), 1); /* frame 4, the start of step 5 */
    assert_int_equal(count_texts(&sketch, "3 contacts, impulses in N s"), 1);
    assert_int_equal(count_texts(&sketch, "1.00"), 1);
    assert_int_equal(count_texts(&sketch, "5.00"), 1);
    assert_int_equal(count_texts(&sketch, "10.3"), 1); /* sqrt(10^2 + 2.5^2) */
    assert_int_equal(count_texts(&sketch, "10 N s on the body with the higher number"), 1);
    /* Ascending by size; the last is the legend's 10 N s. */
    assert_int_equal(gather_arrows(&sketch, vectors, tails), 4);
    double unit = vectors[3].x / 10;
    assert_near(vectors[3].y, 0, 1e-9);
    const Vec2 expected[3] = {vec2(0, 1), vec2(0, 5), vec2(-2.5f, 10)};
    for (int i = 0; i < 3; i++) {
        assert_near(vectors[i].x, unit * (double)expected[i].x, 1e-6);
        assert_near(vectors[i].y, unit * (double)expected[i].y, 1e-6);
    }
    /* They start at their points, which are 4.5 m, 4 m and 1 m apart. */
    double scale = (tails[2].x - tails[0].x) / 4.5;
    assert_near(tails[1].x - tails[0].x, scale * 4, 1e-6);
    assert_near(tails[1].y - tails[0].y, scale * 1, 1e-6);
    assert_near(tails[2].y - tails[0].y, 0, 1e-6);
    free_drawn(&sketch, &run, 1);
}

TEST(a_moment_without_impulses_has_points) {
    Trajectory *run = run_make("engine", 3);
    add(run, 2, GROUND_BODY, FIRST_BOX, vec2(-2.5f, 0), 0, 0);
    add(run, 2, GROUND_BODY, FIRST_BOX, vec2(-2.5f, 0), NAN, 0);
    trajectory_end_contacts(run);
    FigureSpec spec = spec_of(&run, 1);
    Sketch sketch;
    Point vectors[8], tails[8];
    draw_kind(&sketch, "annotated", &spec);
    assert_int_equal(gather_arrows(&sketch, vectors, tails), 0);
    assert_texts(&sketch, "all impulses are 0", "0");
    free_drawn(&sketch, &run, 1);
}

/* The middle of the i-th ring: they are drawn in the order of their impulses, the smallest first. */
static Point ring_at(const Sketch *sketch, int n) {
    for (size_t i = 0; i < sketch->mark_count; i++) {
        const SketchMark *mark = &sketch->marks[i];
        if (mark->kind != MARK_PATH || mark->count != 36 || n-- > 0) continue;
        const Point a = sketch->points[mark->first], b = sketch->points[mark->first + 18];
        return (Point){(a.x + b.x) / 2, (a.y + b.y) / 2};
    }
    fail_msg("no such ring");
    return (Point){0, 0};
}

static PageBox number_box(const Sketch *sketch, const char *words) {
    for (size_t i = 0; i < sketch->mark_count; i++) {
        const SketchMark *mark = &sketch->marks[i];
        if (mark->kind != MARK_TEXT || strcmp(sketch->texts + mark->text, words) != 0) continue;
        const double half = type_width(words, mark->style.points) / 2, up = 0.36 * mark->style.points * MM_PER_POINT;
        return (PageBox){mark->at.x - half, mark->at.y - up, mark->at.x + half, mark->at.y + up};
    }
    fail_msg("no number %s", words);
    return (PageBox){0};
}

static double distance_to_box(Point p, const PageBox *box) {
    return hypot(fmax(fmax(box->left - p.x, p.x - box->right), 0), fmax(fmax(box->bottom - p.y, p.y - box->top), 0));
}

/* A thin line leads from this point's ring to the box, and may go on below it. */
static bool is_led(const Sketch *sketch, Point point, const PageBox *box) {
    for (size_t i = 0; i < sketch->mark_count; i++) {
        const SketchMark *mark = &sketch->marks[i];
        if (mark->kind != MARK_PATH || mark->count > 3 || mark->pen.width != 0.8) continue;
        const Point from = sketch->points[mark->first], to = sketch->points[mark->first + 1];
        if (hypot(from.x - point.x, from.y - point.y) < 0.6 && distance_to_box(to, box) < 0.8) return true;
    }
    return false;
}

/* Six contacts within a few millimetres, as where a bomb strikes: every number is there, apart from all others and from
   all rings, and at the end of a line from its contact, or clearly nearest to it. */
TEST(crowded_numbers_lead_to_their_contacts) {
    enum { CONTACTS = 6 };
    OWN(Trajectory) *run = run_make("engine", 2);
    for (int i = 0; i < CONTACTS; i++)
        add(run, 1, SECOND_BOX, BOMB_BODY, vec2(1.5f + 0.08f * (float)(i * i % 5), 0.2f + 0.13f * (float)i),
            0.11f * (float)(i + 1), 0);
    add(run, 1, GROUND_BODY, FIRST_BOX, vec2(-2.5f, 0), 30, 0);
    trajectory_end_contacts(run);
    for (int column = 0; column < 2; column++) {
        FigureSpec spec = spec_of(&run, 1);
        if (column) spec.width = FIGURE_COLUMN_WIDTH;
        Sketch sketch;
        PageBox boxes[CONTACTS];
        draw_kind(&sketch, "annotated", &spec);
        for (int i = 0; i < CONTACTS; i++) {
            boxes[i] = number_box(&sketch, printed("%.2f", 0.11 * (i + 1)));
            const double own = distance_to_box(ring_at(&sketch, i), &boxes[i]);
            const bool led = is_led(&sketch, ring_at(&sketch, i), &boxes[i]);
            for (int k = 0; k < CONTACTS; k++) {
                const double other = distance_to_box(ring_at(&sketch, k), &boxes[i]);
                assert_true(other > 0.3 && (led || k == i || other > own + 1));
            }
            for (int k = 0; k < i; k++)
                assert_true(boxes[i].right <= boxes[k].left || boxes[k].right <= boxes[i].left ||
                            boxes[i].top <= boxes[k].bottom || boxes[k].top <= boxes[i].bottom);
        }
        sketch_free(&sketch);
    }
}

/* A hundred points in one place: some numbers are left out, and the title states it. */
TEST(numbers_without_room_are_left_out) {
    Trajectory *run = run_make("engine", 2);
    for (int i = 0; i < 100; i++) add(run, 1, GROUND_BODY, FIRST_BOX, vec2(-2.5f + 0.001f * (float)i, 0), 0.1f, 0);
    add(run, 1, GROUND_BODY, SECOND_BOX, vec2(2, 0), 3, 0);
    trajectory_end_contacts(run);
    FigureSpec spec = spec_of(&run, 1);
    spec.width = FIGURE_COLUMN_WIDTH;
    Sketch sketch;
    draw_kind(&sketch, "annotated", &spec);
    int written = count_texts(&sketch, "0.10") + count_texts(&sketch, "3.00");
    const char *line = printed("101 contacts, impulses in N s, %d labelled", written);
    assert_true(written > 1 && written < 40);
    assert_int_equal(count_texts(&sketch, line), 1);
    assert_int_equal(count_texts(&sketch, "3.00"), 1);
    free_drawn(&sketch, &run, 1);
}

TEST(what_cannot_be_shown_is_refused) {
    OWN(Trajectory) *without = run_make("engine", 5), *run = run_with_contacts();
    FigureSpec spec = spec_of(&without, 1);
    expect_kind_refused("annotated", &spec, "a.npz: error: the run has no contacts with an impulse");
    spec = spec_of(&run, 1);
    spec.time_count = 2, spec.times[1] = 0.1;
    expect_kind_refused("annotated", &spec, "this kind of figure shows one moment (got 2)");
    spec.time_count = 1, spec.times[0] = 10 / 60.0;
    expect_kind_refused("annotated", &spec,
                        "a.npz: error: has no moment at 0.166667 s with a step after it; its moments are 0");
    run->contact_start[1] = run->contact_start[2]; /* step 1 has them all, step 2 none */
    spec.times[0] = 1 / 60.0;
    run->contact_start[2] = run->contact_start[3];
    run->contact_start[1] = run->contact_start[2];
    expect_kind_refused("annotated", &spec,
                        "a.npz: error: has no contacts with an impulse in the step after 0.0166667 s");
}

RUN_TESTS(NULL, NULL)
