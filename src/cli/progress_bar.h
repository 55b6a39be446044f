/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The progress bar: a bar on a terminal, lines of text elsewhere; with the time left once it is known. A signal
   requests the work to stop. Work of less than a second shows nothing. There is one bar at a time. */
#pragma once
#include "base/machine.h"

#include <stdbool.h>

/* Replaces the bar before it, and returns what the work reports to. Signals that are held stay so. */
const Progress *progress_bar_begin(const char *what);

/* Removes the bar from the terminal so that a line can be printed; the next report shows it again. */
void progress_bar_clear(void);
void progress_bar_end(void);

/* How long work still takes, at the rate of its recent progress. Fed with times: it reads no clock. */

enum { TIME_LEFT_SAMPLES = 64, TIME_LEFT_TEXT_SIZE = 32 };

typedef struct TimeLeft {
    int count;
    double spacing; /* s: samples are at least this far apart; it doubles when there is no room for more */
    struct TimeLeftSample {
        double time, part;
    } samples[TIME_LEFT_SAMPLES];
} TimeLeft;

/* Begins with work of which nothing is done. */
void time_left_begin(TimeLeft *left);

/* At `time` s after the beginning, this part (0 to 1) is done. Neither may fall. */
void time_left_add(TimeLeft *left, double time, double part);

/* The seconds that are left at the rate of the last third of the time, at least 4 s. False if that means little: in the
   first 2 s, with less than 2% done in the first 20 s, or 0.2% later, or while the rates of both halves of that time
   differ by more than a factor of 2. */
bool time_left_estimate(const TimeLeft *left, double time, double part, double *seconds);

/* "8 s", "6 min 40 s" or "2 h 10 min": no digits that an estimate does not have. */
void time_left_text(double seconds, char text[TIME_LEFT_TEXT_SIZE]);
