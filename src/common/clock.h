/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once

/* Seconds of a clock that never steps back. */
double clock_seconds(void);

/* Processor time of the calling thread: other programs do not count. */
double clock_thread_seconds(void);
