/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of a video: counts, order and fractions; films of any frame rate play in real time, and films of a given
   length last as long. */
#include "owned.h"

#include "pictures/render.h"
#include "runs.h"

enum { FRAMES = 100, IMPACT = 20, BEFORE = 9, AFTER = 36 }; /* 0.15 s and 0.6 s at 60 Hz */

static Trajectory *run;

static void touch(Trajectory *trajectory, int step, int a, int b) {
    TrajectoryContact contact = {.a = a, .b = b, .normal = {0, 1}};
    add_contact(trajectory, step, contact);
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

FIXTURE(make) { run = struck(FRAMES, IMPACT); }

FIXTURE(destroy) { trajectory_destroy(run); }

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
        OWN(Trajectory) *other = struck(cases[i].frames, cases[i].impact);
        MomentPlan plan;
        const Trajectory *panels[] = {other};
        assert_ok(moments_plan(&plan, panels, 1, 0, cases[i].frames - 1, &(RenderOptions){.slow = 4}, &error), error);
        assert_int_equal(moments_last(&plan) + 1, cases[i].frames + 3 * cases[i].between);
        assert_int_equal(moments_at(&plan, moments_last(&plan)).frame, cases[i].frames - 1);
    }
}

TEST(the_first_impact_of_all_panels_counts) {
    OWN(Trajectory) *later = struck(FRAMES + 5, IMPACT + 30);
    MomentPlan plan;
    const Trajectory *panels[] = {later, run};
    assert_ok(moments_plan(&plan, panels, 2, 0, FRAMES + 4, &(RenderOptions){.slow = 2}, &error), error);
    assert_int_equal(plan.slow_first, IMPACT - BEFORE);
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

/* Films of other rates, and of given lengths. */

static const double run_rates[] = {20, 59.94, 60, 75.5, 120, 1000}; /* Hz */
static const double film_rates[] = {1, 24, 25, 29.97, 30, 50, 60, 120, 240};
enum { RUN_RATES = sizeof run_rates / sizeof *run_rates, FILM_RATES = sizeof film_rates / sizeof *film_rates };

static bool plan_range(MomentPlan *plan, double rate, int first, int last, RenderOptions options, Error *error) {
    const Trajectory *panels[] = {run};
    run->dt = (float)(1 / rate);
    return moments_plan(plan, panels, 1, first, last, &options, error);
}

static MomentPlan plan_at(double rate, RenderOptions options) {
    MomentPlan plan;
    Error error = {0};
    assert_ok(plan_range(&plan, rate, 0, FRAMES - 1, options, &error), error);
    return plan;
}

TEST(pictures_are_shown_at_their_time) {
    for (int r = 0; r < RUN_RATES; r++)
        for (int f = 0; f < FILM_RATES; f++) {
            const double fps = film_rates[f], length = (FRAMES - 1) / run_rates[r];
            MomentPlan plan = plan_at(run_rates[r], (RenderOptions){.fps = fps});
            const int last = moments_last(&plan);
            assert_near(plan.rate, fps, 1e-9);
            for (int p = 0; p < last; p++) {
                Moment moment = moments_at(&plan, p);
                assert_near(time_of(moment) / run_rates[r], p / fps, 1e-5); /* rates are rounded to 1/1000 Hz */
                assert_int_equal(moment.kind, moment.part > 0 ? MOMENT_BETWEEN : MOMENT_STORED);
                assert_true(moment.part < moment.parts && moment.slow == 1);
                assert_int_equal(moment.parts, moments_at(&plan, 0).parts);
            }
            assert_true(time_of(moments_at(&plan, last)) == FRAMES - 1);
            assert_true(last / fps > length - 1e-5 && last / fps < length + 1 / fps); /* at most one picture late */
        }
}

/* A film of the run's rate, or of a whole fraction of it, shows stored frames only. */
TEST(frames_are_picked_where_they_fit) {
    for (int every = 1; every <= 4; every++) {
        MomentPlan plan = plan_at(120, (RenderOptions){.fps = 120.0 / every});
        for (int p = 0; p < moments_last(&plan); p++) {
            Moment moment = moments_at(&plan, p);
            assert_true(moment.kind == MOMENT_STORED && moment.frame == p * every && moment.parts == 1);
        }
    }
    MomentPlan finer = plan_at(20, (RenderOptions){.fps = 60});
    for (int p = 0; p <= moments_last(&finer); p++) {
        Moment moment = moments_at(&finer, p);
        assert_true(moment.frame == p / 3 && moment.part == p % 3 && moment.parts == 3);
    }
}

/* 0.15 s before the impact to 0.6 s after it are slower, at any rate of the film. */
TEST(slow_motion_is_as_slow_at_every_rate) {
    for (int f = 1; f < FILM_RATES; f++)
        for (int slow = 2; slow <= 5; slow++) {
            const double fps = film_rates[f];
            MomentPlan plan = plan_at(60, (RenderOptions){.fps = fps, .slow = slow});
            for (int p = 1; p < moments_last(&plan); p++) {
                Moment before = moments_at(&plan, p - 1), moment = moments_at(&plan, p);
                const bool inside = time_of(before) >= IMPACT - 9 && time_of(moment) < IMPACT + 36;
                const bool outside = time_of(before) >= IMPACT + 36 || time_of(moment) <= IMPACT - 9;
                const double passed = (time_of(moment) - time_of(before)) / 60;
                if (inside || outside) assert_near(passed, 1 / fps / (inside ? slow : 1), 1e-9);
                assert_true(moment.slow == (time_of(moment) >= IMPACT - 9 && time_of(moment) < IMPACT + 36 ? slow : 1));
            }
            const double length = (FRAMES - 1 + (slow - 1) * 45) / 60.0;
            assert_true(moments_last(&plan) / fps >= length - 1e-9 && moments_last(&plan) / fps < length + 1 / fps);
        }
}

TEST(a_duration_is_that_of_the_whole_film) {
    static const double durations[] = {0.5, 1, 2, 7.5, 30};
    for (int d = 0; d < 5; d++)
        for (int f = 1; f < FILM_RATES; f++)
            for (int parts = 0; parts < 8; parts++) {
                RenderOptions options = {.fps = film_rates[f],
                                         .duration = 5 + durations[d],
                                         .slow = parts & 1 ? 3 : 0,
                                         .hold = parts & 2 ? 1 : 0,
                                         .title_card = parts & 4,
                                         .end_card = parts & 4};
                MomentPlan plan = plan_at(60, options);
                const int count = moments_last(&plan) + 1, begin = plan.title, end = begin + plan.run - 1;
                assert_near(count / film_rates[f], options.duration, 0.5 / film_rates[f] + 1e-9);
                assert_int_equal(plan.title + plan.run + plan.hold + plan.end, count);
                assert_true(time_of(moments_at(&plan, begin)) == 0);
                assert_true(time_of(moments_at(&plan, end - 1)) < FRAMES - 1);
                assert_true(time_of(moments_at(&plan, end)) == FRAMES - 1);
                const Moment first = moments_at(&plan, begin), second = moments_at(&plan, begin + 1);
                if (!(parts & 1)) assert_near(time_of(second) / 60 * film_rates[f], plan.speed, 1e-6);
                assert_near(first.slow, 1 / plan.speed, 1e-12);
            }
    MomentPlan same = plan_at(60, (RenderOptions){.duration = FRAMES / 60.0});
    assert_near(same.speed, 1, 1e-6);
    for (int p = 0; p < FRAMES; p++) assert_int_equal(moments_at(&same, p).frame, p);
}

TEST(what_makes_no_sense_is_refused) {
    const struct {
        double rate;
        int first, last;
        RenderOptions options;
        const char *text;
    } wrong[] = {
        {60, 5, 5, {.duration = 2}, "--duration: error: a single frame has no speed; --hold shows it"},
        {60, 0, 9, {.duration = 0.02}, "--duration: error: 0.02 s are too short: 0.0333 s at 60 pictures per second"},
        {60, 0, 9, {.duration = 0.1, .fps = 10}, "0.1 s are too short: 0.2 s at 10 pictures per second are needed"},
        {60,
         0,
         9,
         {.duration = 4.5, .fps = 10, .hold = 0.5, .title_card = true, .end_card = true},
         "4.5 s are too short: with the cards and the held frame, 4.7 s at 10 pictures per second are needed"},
        {1e12, 0, 9, {.fps = 60}, "have no real time that a video can show"},
        {1e-4, 0, 9, {.fps = 60}, "time steps of 10000 s have no real time"},
        {1e-3, 0, FRAMES - 1, {.fps = 240, .slow = 16}, NULL},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        error = (Error){0};
        MomentPlan plan;
        const bool planned = plan_range(&plan, wrong[i].rate, wrong[i].first, wrong[i].last, wrong[i].options, &error);
        assert_int_equal(planned, wrong[i].text == NULL);
        if (!planned) assert_error(error, ERROR_INPUT, wrong[i].text);
    }
    MomentPlan plan;
    run->dt = 1000;
    const Trajectory *panels[] = {run};
    assert_refused(moments_plan(&plan, panels, 1, 0, 9999, &(RenderOptions){.fps = 240}, &error),
                   "too many pictures for one sequence");
}

RUN_TESTS(make, destroy)
