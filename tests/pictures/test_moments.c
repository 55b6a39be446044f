/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of a video: counts, order and fractions. */
#include "testing.h"

#include "pictures/render.h"
#include "runs.h"

enum { FRAMES = 100, IMPACT = 20, BEFORE = 9, AFTER = 36 }; /* 0.15 s and 0.6 s at 60 Hz */

static Trajectory *run;

static void touch(Trajectory *trajectory, int step, int a, int b) {
    Error error = {0};
    TrajectoryContact contact = {.a = a, .b = b, .normal = {0, 1}};
    assert_ok(trajectory_add_contact(trajectory, step, &contact, &error), error);
}

/* The bomb touches the ground, then a box, then the other. */
static Trajectory *struck(int frames, int impact) {
    Trajectory *trajectory = run_make("engine", frames);
    if (impact > 3) touch(trajectory, 2, FIRST_BOX, SECOND_BOX);
    if (impact > 3) touch(trajectory, 3, GROUND_BODY, BOMB_BODY);
    if (impact > 0) touch(trajectory, impact, FIRST_BOX, BOMB_BODY);
    if (impact > 0 && impact + 2 < frames) touch(trajectory, impact + 2, SECOND_BOX, BOMB_BODY);
    trajectory_end_contacts(trajectory);
    return trajectory;
}

static int make(void **state) {
    (void)state;
    run = struck(FRAMES, IMPACT);
    return 0;
}

static int destroy(void **state) {
    (void)state;
    trajectory_destroy(run);
    return 0;
}

static MomentPlan plan_for(RenderOptions options) {
    MomentPlan plan;
    Error error = {0};
    const Trajectory *panels[] = {run};
    assert_ok(moments_plan(&plan, panels, 1, 0, FRAMES - 1, &options, &error), error);
    return plan;
}

TEST(the_impact_is_the_bombs_first_touch_of_a_box) {
    assert_int_equal(trajectory_impact(run), IMPACT);
    Trajectory *quiet = struck(FRAMES, 0);
    assert_int_equal(trajectory_impact(quiet), -1);
    trajectory_destroy(quiet);
    run->bomb = -1;
    assert_int_equal(trajectory_impact(run), -1);
    run->bomb = SECOND_BOX; /* which the first box touches in step 2 */
    assert_int_equal(trajectory_impact(run), 2);
    run->bomb = BOMB_BODY;
}

TEST(without_options_a_picture_is_a_frame) {
    for (int slow = 0; slow <= 1; slow++) {
        MomentPlan plan = plan_for((RenderOptions){.slow = slow});
        assert_int_equal(moments_last(&plan) + 1, FRAMES);
        for (int i = 0; i < FRAMES; i++) {
            Moment moment = moments_at(&plan, i);
            assert_true(moment.kind == MOMENT_STORED && moment.frame == i && moment.part == 0 && moment.slow == 1);
        }
    }
}

/* Simulated time, in frames. */
static double time_of(Moment moment) { return moment.frame + moment_fraction(moment); }

TEST(slow_motion_adds_parts_around_the_impact) {
    for (int slow = 2; slow <= RENDER_SLOW_MAX; slow++) {
        MomentPlan plan = plan_for((RenderOptions){.slow = slow});
        int count = moments_last(&plan) + 1, stored = 0;
        assert_int_equal(count, FRAMES + (slow - 1) * (BEFORE + AFTER));
        for (int i = 0; i < count; i++) {
            Moment moment = moments_at(&plan, i);
            bool inside = moment.frame >= IMPACT - BEFORE && moment.frame < IMPACT + AFTER;
            assert_int_equal(moment.slow, inside ? slow : 1);
            assert_int_equal(moment.kind, moment.part > 0 ? MOMENT_BETWEEN : MOMENT_STORED);
            stored += moment.kind == MOMENT_STORED;
            if (i == 0) continue;
            /* The time between two moments is given by the earlier one. */
            Moment before = moments_at(&plan, i - 1);
            assert_near(time_of(moment) - time_of(before), 1.0 / before.slow, 1e-12);
        }
        assert_int_equal(stored, FRAMES);
        assert_true(time_of(moments_at(&plan, 0)) == 0);
        assert_true(time_of(moments_at(&plan, count - 1)) == FRAMES - 1);
    }
}

TEST(slow_motion_ends_where_the_run_does) {
    static const struct {
        int frames, impact, between;
    } cases[] = {{FRAMES, 2, 2 + AFTER}, {FRAMES, FRAMES - 1, BEFORE}, {10, 4, 9}, {FRAMES, 0, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Trajectory *other = struck(cases[i].frames, cases[i].impact);
        MomentPlan plan;
        Error error = {0};
        const Trajectory *panels[] = {other};
        assert_ok(moments_plan(&plan, panels, 1, 0, cases[i].frames - 1, &(RenderOptions){.slow = 4}, &error), error);
        assert_int_equal(moments_last(&plan) + 1, cases[i].frames + 3 * cases[i].between);
        assert_int_equal(moments_at(&plan, moments_last(&plan)).frame, cases[i].frames - 1);
        trajectory_destroy(other);
    }
}

TEST(the_first_impact_of_all_panels_counts) {
    Trajectory *later = struck(FRAMES + 5, IMPACT + 30);
    MomentPlan plan;
    Error error = {0};
    const Trajectory *panels[] = {later, run};
    assert_ok(moments_plan(&plan, panels, 2, 0, FRAMES + 4, &(RenderOptions){.slow = 2}, &error), error);
    assert_int_equal(plan.slow_first, IMPACT - BEFORE);
    trajectory_destroy(later);
}

static void assert_same_moment(Moment a, Moment b) {
    assert_true(a.kind == b.kind && a.frame == b.frame && moment_fraction(a) == moment_fraction(b) && a.slow == b.slow);
}

TEST(cards_and_hold_stand_around_the_run) {
    enum { CARD = 120, HOLD = 90 }; /* 2 s and 1.5 s at 60 Hz */
    MomentPlan plan = plan_for((RenderOptions){.slow = 3, .hold = 1.5, .title_card = true, .end_card = true});
    MomentPlan bare = plan_for((RenderOptions){.slow = 3});
    int run_count = moments_last(&bare) + 1, count = moments_last(&plan) + 1;
    assert_int_equal(count, CARD + run_count + HOLD + CARD);
    for (int i = 0; i < count; i++) {
        Moment moment = moments_at(&plan, i);
        if (i < CARD)
            assert_true(moment.kind == MOMENT_TITLE && moment.frame == 0);
        else if (i < CARD + run_count)
            assert_same_moment(moment, moments_at(&bare, i - CARD));
        else if (i < CARD + run_count + HOLD)
            assert_true(moment.kind == MOMENT_STORED && moment.frame == FRAMES - 1 && moment.slow == 1);
        else
            assert_true(moment.kind == MOMENT_END && moment.frame == FRAMES - 1);
    }
    MomentPlan title = plan_for((RenderOptions){.title_card = true});
    assert_int_equal(moments_last(&title) + 1, CARD + FRAMES);
    MomentPlan end = plan_for((RenderOptions){.end_card = true});
    assert_int_equal(moments_last(&end) + 1, FRAMES + CARD);
}

/* A range of frames has its own cards and hold around the run's moments; its indices begin with the first frame. */
TEST(a_range_of_frames_is_a_complete_sequence) {
    MomentPlan bare = plan_for((RenderOptions){.slow = 5});
    RenderOptions options = {.slow = 5, .hold = 0.5, .title_card = true, .end_card = true};
    const Trajectory *panels[] = {run};
    for (int first = 0; first < FRAMES; first += 11)
        for (int last = first; last < FRAMES; last += 13) {
            MomentPlan plan;
            Error error = {0};
            assert_ok(moments_plan(&plan, panels, 1, first, last, &options, &error), error);
            int whole = 0, i = first;
            while (time_of(moments_at(&bare, whole)) < first) whole++;
            for (; moments_at(&plan, i).kind == MOMENT_TITLE; i++) assert_int_equal(moments_at(&plan, i).frame, first);
            assert_int_equal(i - first, plan.title);
            for (; time_of(moments_at(&bare, whole)) < last; i++, whole++)
                assert_same_moment(moments_at(&plan, i), moments_at(&bare, whole));
            for (int held = 0; held <= plan.hold; held++, i++)
                assert_same_moment(moments_at(&plan, i), moment_stored(last));
            for (; i <= moments_last(&plan); i++)
                assert_same_moment(moments_at(&plan, i), (Moment){MOMENT_END, last, 0, 1, 1});
        }
}

TEST(what_is_out_of_range_is_refused) {
    static const struct {
        RenderOptions options;
        const char *text;
    } wrong[] = {{{.slow = -1}, "must be 0 to 16 (got -1)"},
                 {{.slow = 17}, "must be 0 to 16 (got 17)"},
                 {{.hold = -1}, "held for 0 to 60 s (got -1)"},
                 {{.hold = 61}, "held for 0 to 60 s (got 61)"},
                 {{.hold = NAN}, "held for"}};
    const Trajectory *panels[] = {run};
    MomentPlan plan;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        Error error = {0};
        assert_refused(moments_plan(&plan, panels, 1, 0, FRAMES - 1, &wrong[i].options, &error), wrong[i].text);
    }
    Error error = {0};
    run->dt = 1e-9F;
    assert_refused(moments_plan(&plan, panels, 1, 0, FRAMES - 1, &(RenderOptions){.hold = 60}, &error),
                   "too many pictures for one sequence");
    run->dt = 10;
    assert_true(moments_plan(&plan, panels, 1, 0, FRAMES - 1, &(RenderOptions){.slow = 2, .title_card = true}, &error));
    assert_true(plan.title == 1 && plan.slow_first == IMPACT - 1 && plan.slow_last == IMPACT + 1);
    run->dt = 1.0F / 60;
}

int main(void) { return run_all_tests(make, destroy); }
