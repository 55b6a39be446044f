/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cost of a step: time on one core, and instructions if the system lets a program count them. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

/* Pins the calling thread to its current core, so that migration does not disturb the time, and unpins it. No effect if
   the system does not support it. */
void meter_pin(void);
void meter_unpin(void);

/* Nanoseconds since a fixed moment. */
int64_t meter_time(void);

/* Nanoseconds between two consecutive calls of meter_time: by so much every measurement is too long. */
int64_t meter_time_overhead(void);

/* Instructions of this thread since the counter was opened; 0 if there is no counter. */
bool meter_open_instructions(void);
int64_t meter_instructions(void);
void meter_close_instructions(void);
