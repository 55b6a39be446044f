/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What all trainings share: Adam's laws; a training has the same bits however often it is interrupted. */
#include "testing.h"

#include "learning/learning.h"

/* The bias corrections cancel the decay: with equal slopes every step has the length of the rate, less epsilon over the
   slope of it: 4e-8 here. */
TEST(equal_slopes_make_steps_of_the_rate) {
    enum { STEPS = 50 };
    const double slopes[2] = {3, -0.25}, rate = 0.01;
    Adam adam;
    assert_ok(adam_create(&adam, 2, ADAM_SQUARE_DECAY, &error), error);
    for (int i = 1; i <= STEPS; i++) {
        adam_step(&adam, slopes, rate);
        assert_near(adam.weights[0], -rate * i, 4.1e-8 * rate * i);
        assert_near(adam.weights[1], rate * i, 4.1e-8 * rate * i);
    }
    adam_free(&adam);
}

/* f(x) = (x - 3)^2 / 2 */
TEST(finds_a_minimum) {
    Adam adam;
    assert_ok(adam_create(&adam, 1, 0.99, &error), error);
    for (int i = 0; i < 2000; i++) {
        const double slope = adam.weights[0] - 3;
        adam_step(&adam, &slope, 0.05 * (2000 - i) / 2000);
    }
    assert_near(adam.weights[0], 3, 1e-4);
    adam_restart(&adam);
    assert_near(adam.weights[0], 3, 1e-4);
    assert_true(adam.steps == 0 && adam.mean[0] == 0 && adam.square[0] == 0);
    adam_free(&adam);
}

TEST(slopes_are_shortened_and_never_nan) {
    double fine[2] = {0.3, -0.4}, longer[2] = {3, -4}, bad[2] = {1, NAN};
    assert_true(slopes_limit(fine, 2, 1) && fine[0] == 0.3 && fine[1] == -0.4);
    assert_true(slopes_limit(longer, 2, 1));
    assert_near(longer[0], 0.6, 1e-15);
    assert_near(longer[1], -0.8, 1e-15);
    assert_true(!slopes_limit(bad, 2, 1) && bad[0] == 0 && bad[1] == 0);
}

/* Two stages of 7 steps, each over two of four weights; a state after every third step. */
enum { WEIGHTS = 4, STAGES = 2, STEPS = 7, WRITTEN = 3 };

typedef struct Toy {
    Fit fit;
    int steps, written; /* in this run */
    int64_t in_sum;     /* losses that were reported */
    double last;        /* loss of the last stage */
} Toy;

static bool toy_step(void *context, Adam *adam, double *loss, Error *error) {
    Toy *toy = context;
    assert_int_equal(adam->count, WEIGHTS / STAGES);
    if (adam->weights[0] > 1e6) return error_input(error, "toy", "diverged");
    *loss += 1 + toy->fit.stage;
    toy->steps++;
    adam_step(adam, (const double[]){adam->weights[0] - 3, sqrt((double)adam->steps + 1) - 2}, 0.1);
    return true;
}

static bool toy_written(void *context, double loss, int64_t steps, Error *error) {
    (void)error;
    Toy *toy = context;
    assert_near(loss, (double)steps * (1 + toy->fit.stage), 0);
    toy->written++;
    toy->in_sum += steps;
    return true;
}

/* NULL progress: to the end. */
static bool train(Toy *toy, const char *path, const char *command, const Progress *progress, Error *error) {
    const FitSteps steps = {STEPS, WRITTEN, toy_step, toy_written, toy};
    bool found;
    *toy = (Toy){.steps = 0};
    fit_init(&toy->fit, command, path, progress);
    if (!fit_begin(&toy->fit, WEIGHTS, &found, error)) return false;
    if (!found)
        for (int i = 0; i < WEIGHTS; i++) toy->fit.adam.weights[i] = i;
    if (!found && !fit_write(&toy->fit, error)) return false;
    for (int stage = toy->fit.stage; stage < STAGES; stage++) {
        progress_next_stage(&toy->fit.share, 1.0 / STAGES);
        if (stage > toy->fit.stage) fit_stage(&toy->fit, stage);
        if (!fit_run(&toy->fit, stage * (WEIGHTS / STAGES), WEIGHTS / STAGES, &steps, &toy->last, error)) return false;
    }
    return true;
}

static bool go_on(void *context, double done, double total) {
    (void)context;
    assert_true(done >= 0 && done < total && total == 1);
    return true;
}

static const Progress all = {go_on, NULL};

/* Stops at the report of that number. */
static bool stop_at(void *context, double done, double total) {
    return go_on(NULL, done, total) && --*(int *)context > 0;
}

TEST(a_training_writes_reports_and_ends) {
    Toy toy;
    const char *path = temporary_path("whole.part");
    assert_ok(train(&toy, path, "train", &all, &error), error);
    assert_int_equal(toy.steps, STAGES * STEPS);
    assert_int_equal(toy.written, STAGES * 3); /* after 3, 6 and 7 steps */
    assert_int_equal(toy.in_sum, STAGES * STEPS);
    assert_near(toy.last, 2, 0); /* of the last step alone */
    fit_free(&toy.fit);
    assert_ok(train(&toy, path, "train", &all, &error), error); /* again: nothing is left */
    assert_true(toy.steps == 0 && toy.last == 0 && toy.fit.stage == 1 && toy.fit.epoch == 3);
    assert_near(toy.fit.adam.square_left, pow(ADAM_SQUARE_DECAY, STEPS), 1e-15);
    fit_free(&toy.fit);
}

/* At each of its reports in turn, again and again. */
TEST(interruptions_leave_no_trace) {
    Toy whole, parts;
    assert_ok(train(&whole, temporary_path("whole.part"), "train", &all, &error), error);
    for (int every = 1; every <= 6; every++) {
        const char *path = temporary_path("parts.part");
        remove(path);
        int runs = 1, steps = 0;
        for (int left = every;; left = every > 1 ? every : 2, runs++) {
            assert_in_range(runs, 1, 20);
            const Progress progress = {stop_at, &left};
            error = (Error){0};
            const bool done = train(&parts, path, "train", &progress, &error);
            steps += parts.steps;
            if (done) break;
            assert_error(error, ERROR_INTERRUPTED, "parts.part: error: stopped; the same command continues");
            fit_free(&parts.fit);
        }
        assert_true(runs > 1);
        assert_int_equal(steps, STAGES * STEPS); /* none is done twice */
        assert_memory_equal(parts.fit.adam.weights, whole.fit.adam.weights, WEIGHTS * sizeof(double));
        fit_free(&parts.fit);
    }
    fit_free(&whole.fit);
}

TEST(a_failing_step_ends_the_training) {
    Toy toy;
    const char *path = temporary_path("fails.part");
    assert_ok(train(&toy, path, "train", &all, &error), error);
    fit_stage(&toy.fit, 0);
    toy.fit.adam.weights[0] = 1e7;
    assert_ok(fit_write(&toy.fit, &error), error);
    fit_free(&toy.fit);
    assert_refused(train(&toy, path, "train", &all, &error), "toy: error: diverged");
    assert_int_equal(toy.written, 0);
    fit_free(&toy.fit);
}

TEST(another_command_begins_again) {
    Toy toy;
    const char *path = temporary_path("other.part");
    assert_ok(train(&toy, path, "train a", NULL, &error), error);
    fit_free(&toy.fit);
    assert_ok(train(&toy, path, "train b", NULL, &error), error);
    assert_int_equal(toy.steps, STAGES * STEPS);
    fit_free(&toy.fit);
}

TEST(damaged_states_are_refused) {
    bool found;
    const char *path = temporary_path("net.npz.part");
    Fit fit, other;
    fit_init(&fit, "train", path, NULL);
    fit_init(&other, "train", path, NULL);
    assert_ok(fit_begin(&fit, WEIGHTS, &found, &error) && fit_write(&fit, &error), error);
    assert_refused(fit_begin(&other, WEIGHTS - 1, &found, &error), "net.npz.part: error: ", "weights");
    fit_free(&other);
    fit.adam.weights[1] = NAN;
    assert_ok(fit_write(&fit, &error), error);
    assert_refused(fit_begin(&other, WEIGHTS, &found, &error), "weights: number 1 is NaN or infinite");
    assert_true(other.adam.weights[0] == 0 && other.adam.weights[1] == 0);
    fit_free(&other);
    fit.adam.weights[1] = 0;
    fit.stage = -1;
    assert_ok(fit_write(&fit, &error), error);
    assert_refused(fit_begin(&other, WEIGHTS, &found, &error), "at: number 0, -1, is not possible");
    fit_free(&other);
    write_bytes(path, "x", 1);
    assert_refused(fit_begin(&other, WEIGHTS, &found, &error), path);
    fit_free(&other);
    fit_free(&fit);
}

RUN_TESTS(NULL, NULL)
