/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/time_left.h"

#include <stdio.h>

/* s; share of the time so far */
static const double least_window = 4, window_share = 1.0 / 3, first_spacing = 0.05;
static const double least_time = 2, least_part = 0.02, patience = 20, agreement = 2;

void time_left_begin(TimeLeft *left) {
    *left = (TimeLeft){.count = 1, .spacing = first_spacing}; /* the first sample: nothing done at 0 s */
}

static void thin(TimeLeft *left) {
    for (int i = 1; 2 * i < left->count; i++) left->samples[i] = left->samples[2 * i];
    left->count = (left->count + 1) / 2;
    left->spacing *= 2;
}

void time_left_add(TimeLeft *left, double time, double part) {
    if (time < left->samples[left->count - 1].time + left->spacing) return;
    if (left->count == TIME_LEFT_SAMPLES) thin(left);
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
    if (time < least_time || (part < least_part && time < patience)) return false;
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
