/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A progress bar with the time left on a terminal, lines of text elsewhere. Ctrl-C requests the work to stop. Work of
   less than a second shows nothing. */
#pragma once
#include "common/progress.h"

typedef struct ProgressBar {
    const char *what;
    double begun, shown; /* s */
    bool visible, terminal;
    Progress progress; /* hand &bar.progress to the work */
} ProgressBar;

void progress_bar_begin(ProgressBar *bar, const char *what);

/* Removes the bar from the terminal so that a line can be printed; the next report shows it again. */
void progress_bar_clear(ProgressBar *bar);
void progress_bar_end(ProgressBar *bar);

/* True after Ctrl-C or SIGTERM since the first bar began. */
bool progress_interrupted(void);
