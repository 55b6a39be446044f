/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A progress bar with the time left on a terminal, plain lines elsewhere; and Ctrl-C, which asks work to stop.
   Work of under a second shows nothing. */
#pragma once
#include "common/progress.h"

typedef struct ProgressBar {
    const char *what;
    double begun, shown; /* s */
    bool visible, terminal;
    Progress progress; /* hand &bar.progress to the work */
} ProgressBar;

void progress_bar_begin(ProgressBar *bar, const char *what);

/* Takes the bar off the terminal, so that a line can be printed in its place; it comes back by itself. */
void progress_bar_clear(ProgressBar *bar);
void progress_bar_end(ProgressBar *bar);

/* True once Ctrl-C (or a request to terminate) came since the first bar began. */
bool progress_interrupted(void);
