/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures time and, where the system permits it, instructions of the calling thread. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/* Pins the calling thread to its current core, to avoid the cost of migration; unpins it. No effect if the system does
   not support it. */
void meter_pin(void);
void meter_unpin(void);

/* Nanoseconds of a monotonic clock. Tests put a clock that counts in the place of the system's
   (tests/studies/test_times.c). */
int64_t meter_time(void);

/* Nanoseconds between two consecutive calls of meter_time(), to be subtracted from every measurement. */
int64_t meter_time_overhead(void);
/* `passed` without the overhead; at least 0, as the overhead itself varies by some nanoseconds. */
int64_t meter_without(int64_t passed, int64_t overhead);

/* Instructions of this thread since the counter was opened; 0 if it is not available. */
bool meter_open_instructions(void);
int64_t meter_instructions(void);
void meter_close_instructions(void);
