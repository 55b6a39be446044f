/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Samples, their medians and quartiles, as lines of CSV. */
#pragma once
#include "base/machine.h" /* clock_seconds() */

enum { SAMPLES_MAX = 64 };

typedef struct Samples {
    int count;
    double values[SAMPLES_MAX];
} Samples;

void samples_add(Samples *samples, double value);
/* The quantile of the samples, interpolated between two of them. */
double samples_quantile(const Samples *samples, double share);
double samples_median(const Samples *samples);

/* Seconds of processor time, which does not count pauses on a busy machine (a long run has more of them than a short
   one). */
double processor_seconds(void);

/* Ends the program with a reason. */
void give_up(const char *reason);

void report_header(void);
void report_line(const char *benchmark, const char *rival, const char *figure, const char *unit,
                 const Samples *samples);
/* "target name: figure, at most (or at least) limit: held". */
void report_target(const char *name, double figure, const char *relation, double limit);
