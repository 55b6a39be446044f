/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A progress bar on a terminal, lines of text elsewhere; with the time left once it is known (common/time_left.h).
   A signal requests the work to stop (interrupt.h). Work of less than a second shows nothing. There is one bar at a time. */
#pragma once
#include "common/progress.h"

/* Replaces the bar before it, and returns what the work reports to. Signals that are held stay so. */
const Progress *progress_bar_begin(const char *what);

/* Removes the bar from the terminal so that a line can be printed; the next report shows it again. */
void progress_bar_clear(void);
void progress_bar_end(void);
