/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report.h"

#include <assert.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

void samples_add(Samples *samples, double value) {
    assert(samples->count < SAMPLES_MAX);
    samples->values[samples->count++] = value;
}

static int compare(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double samples_quantile(const Samples *samples, double share) {
    Samples sorted = *samples;
    qsort(sorted.values, (size_t)sorted.count, sizeof sorted.values[0], compare);
    double at = share * (sorted.count - 1);
    int below = (int)at;
    int above = below + 1 < sorted.count ? below + 1 : below;
    return sorted.values[below] + (at - below) * (sorted.values[above] - sorted.values[below]);
}

double samples_median(const Samples *samples) { return samples_quantile(samples, 0.5); }

void give_up(const char *reason) {
    fprintf(stderr, "%s\n", reason);
    exit(3);
}

double processor_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Chipmunk prints to standard output. Results go to a copy of it, and the output of libraries to standard error. */
static FILE *lines;

void report_header(void) {
    lines = fdopen(dup(STDOUT_FILENO), "w");
    if (lines == NULL || dup2(STDERR_FILENO, STDOUT_FILENO) < 0) abort();
    fprintf(lines, "benchmark,rival,figure,unit,median,q1,q3\n");
}

void report_line(const char *benchmark, const char *rival, const char *figure, const char *unit,
                 const Samples *samples) {
    fprintf(lines, "%s,%s,%s,%s,%.4g,%.4g,%.4g\n", benchmark, rival, figure, unit, samples_median(samples),
            samples_quantile(samples, 0.25), samples_quantile(samples, 0.75));
    fflush(lines);
}

void report_target(const char *name, double figure, const char *relation, double limit) {
    bool held = strcmp(relation, "at most") == 0 ? figure <= limit : figure >= limit;
    fprintf(lines, "target %s: %.3g, %s %.3g: %s\n", name, figure, relation, limit, held ? "held" : "not held");
    fflush(lines);
}
