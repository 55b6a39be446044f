/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "trajectory/growth.h"

#include "common/file.h"

#include <gsl/gsl_fit.h>
#include <math.h>
#include <stdlib.h>

static const double LN_2 = 0.69314718055994530942;

/* Sets all members but the rate; fills `count` of logarithms and times [end - from]. */
static void find_window(Growth *growth, const double *distance, int from, int end, double dt, double *times,
                        double *logarithms) {
    growth->end = end;
    for (int frame = from; frame < growth->end; frame++) {
        if (distance[frame] >= GROWTH_SATURATED) {
            growth->saturated = true;
            growth->end = frame;
            return;
        }
        if (!(distance[frame] > 0)) continue;
        if (growth->count == 0) {
            growth->first = frame;
            growth->from = distance[frame];
        }
        growth->last = frame;
        growth->to = distance[frame];
        times[growth->count] = frame * dt;
        logarithms[growth->count++] = log(distance[frame]);
    }
}

bool growth_measure(const double *distance, int from, int end, double dt, Growth *growth, Error *error) {
    *growth = (Growth){.first = -1, .last = -1, .end = from, .rate = NAN, .scatter = NAN};
    if (from < 0 || from >= end) return true;
    size_t frames = (size_t)(end - from);
    double *times = malloc(2 * frames * sizeof *times);
    if (times == NULL) return error_memory(error, "growth");
    double *logarithms = times + frames;
    find_window(growth, distance, from, end, dt, times, logarithms);
    if (growth->count >= GROWTH_MIN_FRAMES) {
        double at_zero, cov00, cov01, cov11, squares;
        gsl_fit_linear(times, 1, logarithms, 1, (size_t)growth->count, &at_zero, &growth->rate, &cov00, &cov01, &cov11,
                       &squares);
        growth->scatter = sqrt(squares / growth->count);
    }
    free(times);
    return true;
}

double growth_doubling(const Growth *growth, double dt) { return LN_2 / (growth->rate * dt); }

static bool grows(const Growth *growth, double dt) {
    return growth->rate * (growth->last - growth->first) * dt >= LN_2;
}

GrowthVerdict growth_compare(const Growth *growth, const Growth *shifted, double dt) {
    if (isnan(growth->rate) || isnan(shifted->rate)) return GROWTH_UNKNOWN;
    bool one = grows(growth, dt), other = grows(shifted, dt);
    if (!one && !other) return GROWTH_NEITHER;
    if (!other || (one && growth->rate > GROWTH_ALIKE * shifted->rate)) return GROWTH_FASTER;
    if (!one || shifted->rate > GROWTH_ALIKE * growth->rate) return GROWTH_SLOWER;
    return GROWTH_SAME;
}

static void print_table(FILE *out, const void *context) {
    const DistanceTable *table = context;
    fprintf(out, "frame,time,distance,shifted_distance\n");
    for (int frame = 0; frame < table->frames; frame++) {
        fprintf(out, "%d,%.9g,%.9g,", frame, frame * table->dt, table->distance[frame]);
        if (table->shifted != NULL && !isnan(table->shifted[frame])) fprintf(out, "%.9g", table->shifted[frame]);
        fputc('\n', out);
    }
}

bool distance_table_write(const DistanceTable *table, const char *path, Error *error) {
    return file_write_text(path, print_table, table, error);
}
