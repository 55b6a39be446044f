/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a step costs: time of one core, and instructions where the system lets a program count its own. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

/* Keeps the calling thread on the core that it runs on, so that time is not lost in moving; and lets it go again. Where
   the system does not do that, nothing happens. */
void meter_pin(void);
void meter_unpin(void);

/* Nanoseconds since some moment. */
int64_t meter_time(void);

/* Nanoseconds that lie between two calls of meter_time in a row: what every measurement is too long by. */
int64_t meter_time_overhead(void);

/* Instructions that this thread has run since the counter was opened; 0 where there is none. */
bool meter_open_instructions(void);
int64_t meter_instructions(void);
void meter_close_instructions(void);
