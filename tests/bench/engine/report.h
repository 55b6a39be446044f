/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Samples, their medians and quartiles, as lines of CSV. */
#pragma once

enum { SAMPLES_MAX = 64 };

typedef struct Samples {
    int count;
    double values[SAMPLES_MAX];
} Samples;

void samples_add(Samples *samples, double value);
/* The value below which this share of the samples lies, between two of them where it falls there. */
double samples_quantile(const Samples *samples, double share);
double samples_median(const Samples *samples);

/* Seconds, from any start: of the clock, and of processor time, which on a busy machine does not count the pauses that
   a long run meets more often than a short one. */
double clock_seconds(void);
double processor_seconds(void);

void report_header(void);
void report_line(const char *benchmark, const char *rival, const char *figure, const char *unit,
                 const Samples *samples);
/* "target name: figure, at most (or at least) limit: held". */
void report_target(const char *name, double figure, const char *relation, double limit);
