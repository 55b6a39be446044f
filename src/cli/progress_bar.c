/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/progress_bar.h"

#include "cli/interrupt.h"
#include "cli/notes.h"
#include "common/clock.h"
#include "common/time_left.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* There is one terminal: one bar at a time. */
static struct {
    char what[192];
    double begun, shown;          /* s */
    bool held, visible, terminal; /* held: signals wait for the work */
    TimeLeft left;
} bar;

static void show(double part, double elapsed) {
    enum { WIDTH = 30 };
    char left[TIME_LEFT_TEXT_SIZE] = "";
    double seconds = 0;
    const bool known = time_left_estimate(&bar.left, elapsed, part, &seconds);
    if (known) time_left_text(seconds, left);
    const char *comma = known ? ", " : "", *behind = known ? " left" : "";
    if (!bar.terminal) {
        fprintf(stderr, "%s: %.0f%%%s%s%s\n", bar.what, 100 * part, comma, left, behind);
        return;
    }
    char cells[WIDTH + 1];
    memset(cells, '.', WIDTH);
    memset(cells, '#', (size_t)(part * WIDTH));
    cells[WIDTH] = '\0';
    fprintf(stderr, "\r\033[K%s [%s] %3.0f%%%s%s%s", bar.what, cells, 100 * part, comma, left, behind);
    fflush(stderr);
}

static bool report(void *context, double done, double total) {
    (void)context;
    /* Not before: work that waits for its input does not look at what this returns. */
    if (!bar.held) interrupt_hold();
    bar.held = true;
    const double time = clock_seconds(), elapsed = time - bar.begun, pause = bar.terminal ? 0.1 : 5.0;
    const double part = done < total ? done / total : 1.0;
    time_left_add(&bar.left, elapsed, part);
    if (note_level() > NOTES_QUIET && elapsed >= 1.0 && time - bar.shown >= pause && done > 0) {
        bar.shown = time;
        bar.visible = true;
        show(part, elapsed);
    }
    return !interrupt_requested();
}

const Progress *progress_bar_begin(const char *what) {
    static const Progress progress = {report, NULL};
    progress_bar_clear();
    bar.visible = false; /* signals stay held from one stage of a work to the next */
    bar.begun = clock_seconds();
    bar.shown = 0;
    time_left_begin(&bar.left);
    bar.terminal = isatty(STDERR_FILENO) == 1;
    snprintf(bar.what, sizeof bar.what, "%s", what);
    return &progress;
}

void progress_bar_clear(void) {
    if (bar.visible && bar.terminal) fputs("\r\033[K", stderr);
}

void progress_bar_end(void) {
    progress_bar_clear();
    bar.visible = false;
    if (bar.held) interrupt_release();
    bar.held = false;
}
