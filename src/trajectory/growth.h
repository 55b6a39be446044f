/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How fast two runs diverge: the slope of the logarithm of their distance over time. Where the distance grows by a
   constant factor per frame, this is the largest Lyapunov exponent. */
#pragma once
#include "trajectory/trajectory.h"

/* Above this distance, a tenth of a box, growth is saturated and frames do not count. */
#define GROWTH_SATURATED 0.1 /* m */

enum { GROWTH_MIN_FRAMES = 10 };

/* Rates within this factor count as equal: the choice of frames changes them by as much. */
#define GROWTH_ALIKE 2.0

typedef struct Growth {
    int first, last; /* frames of the fit, from the first distance above 0 on; -1, -1: none */
    int count;       /* of distances above 0 in them; below GROWTH_MIN_FRAMES there is no rate */
    int end;         /* the end of the frames considered: the last one, */
    bool saturated;  /* or one with a distance of at least GROWTH_SATURATED */
    double from, to; /* m, in frames first and last */
    double rate;     /* 1/s, by least squares; NAN without a fit */
    double scatter;  /* RMS of the logarithm about the line */
} Growth;

/* distance[from .. end - 1] in m, one per frame of dt seconds; 0 and NAN (unknown) are left out. False with error set
   when memory is short. */
bool growth_measure(const double *distance, int from, int end, double dt, Growth *growth, Error *error);

/* Number of frames in which the distance doubles; negative: halves. */
double growth_doubling(const Growth *growth, double dt);

/* A growth compared with that after a tiny shift, in the same frames. A distance grows if it at least doubles. */
typedef enum GrowthVerdict { GROWTH_UNKNOWN, GROWTH_NEITHER, GROWTH_SAME, GROWTH_FASTER, GROWTH_SLOWER } GrowthVerdict;
GrowthVerdict growth_compare(const Growth *growth, const Growth *shifted, double dt);

/* `frame,time,distance,shifted_distance`; shifted NULL, or NAN: that field is empty. */
typedef struct DistanceTable {
    int frames;
    double dt;                        /* s */
    const double *distance, *shifted; /* [frames] m */
} DistanceTable;
bool distance_table_write(const DistanceTable *table, const char *path, Error *error);
