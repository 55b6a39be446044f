/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The progress bar, and the time that is left. */
#include "base/machine.h"
#include "cli/interrupt.h"
#include "cli/notes.h"
#include "cli/progress_bar.h"

#include <string.h>
#include <unistd.h>

/* s; share of the time so far */
static const double least_window = 4, window_share = 1.0 / 3, first_spacing = 0.05;
static const double least_time = 2, least_part = 0.02, patience = 20, least_ever = 0.002, agreement = 2;

void time_left_begin(TimeLeft *left) {
    *left = (TimeLeft){.count = 1, .spacing = first_spacing}; /* the first sample: nothing done at 0 s */
}

void time_left_add(TimeLeft *left, double time, double part) {
    if (time < left->samples[left->count - 1].time + left->spacing) return;
    if (left->count == TIME_LEFT_SAMPLES) { /* every second one stays */
        for (int i = 1; 2 * i < left->count; i++) left->samples[i] = left->samples[2 * i];
        left->count = (left->count + 1) / 2;
        left->spacing *= 2;
    }
    left->samples[left->count++] = (struct TimeLeftSample){time, part};
}

/* The part that was done at a time, between samples along a line from one to the next. */
static double part_at(const TimeLeft *left, const struct TimeLeftSample *now, double time) {
    struct TimeLeftSample before = left->samples[0], after = *now;
    for (int i = 0; i < left->count; i++) {
        if (left->samples[i].time > time) {
            after = left->samples[i];
            break;
        }
        before = left->samples[i];
    }
    if (after.time <= before.time) return before.part;
    return before.part + (after.part - before.part) * (time - before.time) / (after.time - before.time);
}

bool time_left_estimate(const TimeLeft *left, double time, double part, double *seconds) {
    if (time < least_time || part < (time < patience ? least_part : least_ever)) return false;
    double window = time * window_share > least_window ? time * window_share : least_window;
    if (window > time) window = time;
    const struct TimeLeftSample now = {time, part};
    const double begin = part_at(left, &now, time - window), middle = part_at(left, &now, time - window / 2);
    const double first = middle - begin, second = part - middle;
    if (first <= 0 || second <= 0 || first > agreement * second || second > agreement * first) return false;
    *seconds = part < 1 ? (1 - part) * window / (part - begin) : 0;
    return true;
}

void time_left_text(double seconds, char text[TIME_LEFT_TEXT_SIZE]) {
    const double most = 1e6; /* s */
    const int rounded = (int)((seconds < most ? seconds : most) + 0.5), whole = rounded < 1 ? 1 : rounded;
    const int tens = (whole + 5) / 10 * 10, minutes = (whole + 30) / 60, ten_minutes = (minutes + 5) / 10 * 10;
    if (whole < 60)
        snprintf(text, TIME_LEFT_TEXT_SIZE, "%d s", whole);
    else if (tens < 600)
        snprintf(text, TIME_LEFT_TEXT_SIZE, "%d min %02d s", tens / 60, tens % 60);
    else if (minutes < 60)
        snprintf(text, TIME_LEFT_TEXT_SIZE, "%d min", minutes);
    else
        snprintf(text, TIME_LEFT_TEXT_SIZE, "%d h %02d min", ten_minutes / 60, ten_minutes % 60);
}

/* There is one terminal: one bar at a time. */
static struct {
    char what[192];
    double begun, shown;          /* s */
    double last;                  /* part that was shown last */
    bool held, visible, terminal; /* held: signals wait for the work */
    TimeLeft left;
} bar;

static void progress_bar_show(double part, double elapsed) {
    enum { WIDTH = 30 };
    char left[TIME_LEFT_TEXT_SIZE] = "";
    double seconds = 0;
    const bool known = part < 1 && time_left_estimate(&bar.left, elapsed, part, &seconds);
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

static bool progress_bar_report(void *context, double done, double total) {
    (void)context;
    /* Not before: work that waits for its input does not look at what this returns. */
    if (!bar.held) interrupt_hold();
    bar.held = true;
    const double time = clock_seconds(), elapsed = time - bar.begun, pause = bar.terminal ? 0.1 : 5.0;
    const double part = done < total ? done / total : 1.0;
    time_left_add(&bar.left, elapsed, part);
    /* The last line in a file is the end, however soon it comes after the one before. */
    const bool ends = part == 1 && bar.visible && bar.last < 1 && !bar.terminal;
    if (note_level() > NOTES_QUIET && elapsed >= 1.0 && (time - bar.shown >= pause || ends) && done > 0) {
        bar.shown = time;
        bar.last = part;
        bar.visible = true;
        progress_bar_show(part, elapsed);
    }
    return !interrupt_requested();
}

const Progress *progress_bar_begin(const char *what) {
    static const Progress progress = {progress_bar_report, NULL};
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
