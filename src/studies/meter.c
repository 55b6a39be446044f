/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The clock and the counter of instructions of this thread. */
#define _GNU_SOURCE
#include "studies/meter.h"

#include <linux/perf_event.h>
#include <sched.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

static cpu_set_t free_cores;
static bool pinned;

void meter_pin(void) {
    cpu_set_t core;
    int here = sched_getcpu();
    if (here < 0 || sched_getaffinity(0, sizeof free_cores, &free_cores) != 0) return;
    CPU_ZERO(&core);
    CPU_SET((size_t)here, &core);
    pinned = sched_setaffinity(0, sizeof core, &core) == 0;
}

void meter_unpin(void) {
    if (pinned) sched_setaffinity(0, sizeof free_cores, &free_cores);
    pinned = false;
}

int64_t meter_time(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

int64_t meter_time_overhead(void) {
    int64_t least = INT64_MAX;
    for (int i = 0; i < 1000; i++) {
        int64_t begun = meter_time(), passed = meter_time() - begun;
        if (passed < least) least = passed;
    }
    return least;
}

int64_t meter_without(int64_t passed, int64_t overhead) { return passed > overhead ? passed - overhead : 0; }

static int counter = -1;

bool meter_open_instructions(void) {
    struct perf_event_attr event = {.type = PERF_TYPE_HARDWARE,
                                    .size = sizeof event,
                                    .config = PERF_COUNT_HW_INSTRUCTIONS,
                                    .exclude_kernel = 1,
                                    .exclude_hv = 1};
    counter = (int)syscall(SYS_perf_event_open, &event, 0, -1, -1, 0);
    return counter >= 0;
}

int64_t meter_instructions(void) {
    int64_t count = 0;
    return read(counter, &count, sizeof count) == (ssize_t)sizeof count ? count : 0;
}

void meter_close_instructions(void) {
    if (counter >= 0) close(counter);
    counter = -1;
}
