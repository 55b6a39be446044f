/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Properties of the clocks that need no waiting. */
#define _GNU_SOURCE
#include "testing.h"

#include "studies/meter.h"

#include <sched.h>

TEST(time_does_not_go_back) {
    int64_t last = meter_time();
    for (int i = 0; i < 1000; i++) {
        int64_t now = meter_time();
        assert_true(now >= last);
        last = now;
    }
    assert_true(meter_time_overhead() >= 0);
}

TEST(no_work_takes_no_negative_time) {
    assert_int_equal(meter_without(30, 20), 10);
    assert_int_equal(meter_without(20, 30), 0);
}

TEST(a_thread_is_pinned_to_one_core_and_let_go) {
    cpu_set_t before, pinned, after;
    assert_int_equal(sched_getaffinity(0, sizeof before, &before), 0);
    meter_pin();
    assert_int_equal(sched_getaffinity(0, sizeof pinned, &pinned), 0);
    meter_unpin();
    assert_int_equal(sched_getaffinity(0, sizeof after, &after), 0);
    assert_int_equal(CPU_COUNT(&pinned), 1);
    assert_true(CPU_EQUAL(&before, &after));
}

/* Where instructions can be counted: a longer loop takes more. */
TEST(instructions_grow_with_the_work) {
    if (!meter_open_instructions()) skip();
    int64_t counts[2];
    for (int k = 0; k < 2; k++) {
        int64_t begun = meter_instructions();
        for (volatile int i = 0; i < 1000 * (1 + 99 * k); i++) continue;
        counts[k] = meter_instructions() - begun;
    }
    meter_close_instructions();
    assert_true(counts[0] >= 1000 && counts[1] > 10 * counts[0]);
}

RUN_TESTS(NULL, NULL)
