/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Estimates of the time left, from made-up times. */
#include "testing.h"

#include "cli/progress_bar.h"

/* Work in two phases: `rate` 1/s up to `turn` s, then `rate_after`. */
typedef struct Work {
    double rate, turn, rate_after;
} Work;

static double part_of(const Work *work, double time) {
    const double part = work->rate * fmin(time, work->turn) + work->rate_after * fmax(time - work->turn, 0);
    return fmin(part, 1);
}

static double true_left(const Work *work, double time) {
    const double part = part_of(work, time), part_at_turn = work->rate * work->turn;
    if (part >= part_at_turn || time >= work->turn) return (1 - part) / work->rate_after;
    return work->turn - time + (1 - part_at_turn) / work->rate_after;
}

enum { REPORTS_PER_SECOND = 50 };

/* Reports up to `time`, then the estimate; NaN without one. */
static double estimate_at(const Work *work, double time) {
    TimeLeft left;
    time_left_begin(&left);
    for (int i = 0; i <= time * REPORTS_PER_SECOND; i++)
        time_left_add(&left, (double)i / REPORTS_PER_SECOND, part_of(work, (double)i / REPORTS_PER_SECOND));
    double seconds = NAN;
    assert_true(left.count <= TIME_LEFT_SAMPLES);
    return time_left_estimate(&left, time, part_of(work, time), &seconds) ? seconds : NAN;
}

static bool none(double estimate) { return isnan(estimate) != 0; }

TEST(steady_work_is_estimated_exactly) {
    static const double durations[] = {4, 10, 100, 3000};
    for (int i = 0; i < 4; i++) {
        const Work work = {1 / durations[i], 1e9, 1};
        for (double share = 0.25; share < 1; share += 0.25)
            if (share * durations[i] >= 2)
                assert_near(estimate_at(&work, share * durations[i]), (1 - share) * durations[i], 1e-6 * durations[i]);
    }
}

TEST(nothing_is_estimated_at_the_beginning) {
    const Work quick = {0.1, 1e9, 1}, slow = {1e-4, 1e9, 1}, slower = {1e-5, 1e9, 1};
    assert_true(none(estimate_at(&quick, 1.9)));
    assert_false(none(estimate_at(&quick, 2)));
    assert_true(none(estimate_at(&slow, 19)));
    assert_near(estimate_at(&slow, 21), 1e4 - 21, 1);
    assert_true(none(estimate_at(&slower, 199)));
    assert_near(estimate_at(&slower, 201), 1e5 - 201, 10);
}

/* A stage ten times slower, or faster, than the one before: the estimate knows the new rate after half of the old
   stage's time. */
TEST(the_recent_rate_counts) {
    const Work slower = {0.005, 100, 0.0005}, faster = {0.0005, 100, 0.005};
    assert_near(estimate_at(&slower, 200), true_left(&slower, 200), 1);
    assert_near(estimate_at(&faster, 160), true_left(&faster, 160), 1);
    assert_near(estimate_at(&slower, 90), 110, 1);
    /* Between the two, the halves of the window disagree. */
    assert_true(none(estimate_at(&slower, 120)));
}

TEST(texts_have_few_digits) {
    static const struct {
        double seconds;
        const char *text;
    } rows[] = {{0.2, "1 s"},         {59.4, "59 s"},        {59.6, "1 min 00 s"},      {397, "6 min 40 s"},
                {594, "9 min 50 s"},  {596, "10 min"},       {3500, "58 min"},          {3599, "1 h 00 min"},
                {7900, "2 h 10 min"}, {1e9, "277 h 50 min"}, {INFINITY, "277 h 50 min"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[TIME_LEFT_TEXT_SIZE];
        time_left_text(rows[i].seconds, text);
        assert_string_equal(text, rows[i].text);
    }
}

RUN_TESTS(NULL, NULL)
