/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "base/machine.h"

#include <omp.h>
#include <stdatomic.h>

enum { PIECES = 1000 };

static bool add_one(void *context, int i, Error *error) {
    (void)error;
    ((int *)context)[i]++;
    return true;
}

static bool fail_at_500(void *context, int i, Error *error) {
    ((int *)context)[i]++;
    return i != 500 || error_input(error, "piece", "number %d", i);
}

TEST(every_piece_is_done_once) {
    int done[PIECES] = {0};
    assert_ok(parallel_for(&(ParallelWork){add_one, done}, PIECES, "test", NULL, &error), error);
    for (int i = 0; i < PIECES; i++) assert_int_equal(done[i], 1);
}

TEST(an_error_stops_the_rest) {
    int done[PIECES] = {0};
    assert_refused(parallel_for(&(ParallelWork){fail_at_500, done}, PIECES, "test", NULL, &error),
                   "piece: error: number 500");
    for (int i = 0; i < PIECES; i++) assert_true(done[i] <= 1);
}

/* Piece 0 fails after another, which another thread does meanwhile. */
static bool fail_backwards(void *context, int i, Error *error) {
    atomic_int *failed = context;
    while (i == 0 && omp_get_num_threads() > 1 && atomic_load(failed) == 0) continue;
    atomic_fetch_add(failed, 1);
    return error_input(error, "piece", "number %d", i);
}

TEST(the_error_is_that_of_the_least_piece) {
    for (int i = 0; i < 10; i++) {
        atomic_int failed = 0;
        assert_refused(parallel_for(&(ParallelWork){fail_backwards, &failed}, PIECES, "test", NULL, &error),
                       "piece: error: number 0");
    }
}

static bool stop_at_ten(void *context, double done, double total) {
    assert_true(total == PIECES);
    return done < *(const double *)context;
}

TEST(progress_can_stop_it) {
    int done[PIECES] = {0}, count = 0;
    double limit = 10;
    Progress progress = {stop_at_ten, &limit};
    assert_false(parallel_for(&(ParallelWork){add_one, done}, PIECES, "launches", &progress, &error));
    assert_error(error, ERROR_INTERRUPTED, "launches: error: stopped after 1");
    for (int i = 0; i < PIECES; i++) count += done[i];
    assert_true(count >= 10 && count < PIECES);
}

/* Every thread does a piece, because none goes on before all have begun one. */
static bool meet_the_others(void *context, int i, Error *error) {
    (void)i, (void)error;
    atomic_int *begun = context;
    atomic_fetch_add(begun, 1);
    while (atomic_load(begun) < omp_get_num_threads()) continue;
    return true;
}

static bool count_call(void *context, double done, double total) {
    (void)total;
    int *calls = context;
    assert_true(done == ++*calls);
    return true;
}

TEST(progress_is_reported_by_one_thread_at_a_time) {
    atomic_int begun = 0;
    int calls = 0;
    const Progress progress = {count_call, &calls};
    assert_ok(parallel_for(&(ParallelWork){meet_the_others, &begun}, PIECES, "test", &progress, &error), error);
    assert_int_equal(calls, PIECES);
}

RUN_TESTS(NULL, NULL)
