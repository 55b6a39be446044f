/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How fast two runs part: the slope of the logarithm of their distance against time (the largest Lyapunov exponent of
   what happens in these frames, where the distance grows by a constant factor a frame). */
#pragma once
#include "trajectory/trajectory.h"

/* From here on two runs are two runs, and their distance says nothing about growth: a tenth of a box. */
#define GROWTH_SATURATED 0.1 /* m */

enum { GROWTH_MIN_FRAMES = 10 };

/* Rates within this factor of each other are told as alike: no finer than the frames taken decide. */
#define GROWTH_ALIKE 2.0

typedef struct Growth {
    int first, last; /* frames of the fit: from the first distance above 0 on; -1, -1: none */
    int count;       /* of distances above 0 among them; below GROWTH_MIN_FRAMES there is no rate */
    int end;         /* the first frame that was not looked at: behind all, */
    bool saturated;  /* or with a distance of GROWTH_SATURATED or more */
    double from, to; /* m, in frames first and last */
    double rate;     /* 1/s, by least squares; NAN where there is none */
    double scatter;  /* RMS of the logarithm about the line */
} Growth;

/* distance[from .. end - 1] in m, one a frame of dt seconds; NAN: not known, like 0 left out. False with error set when
   memory is short. */
bool growth_measure(const double *distance, int from, int end, double dt, Growth *growth, Error *error);

/* Frames in which the distance doubles; negative: in which it halves. */
double growth_doubling(const Growth *growth, double dt);

/* A growth beside that which a tiny shift gives by itself in the same frames. To grow means to double at least once. */
typedef enum GrowthVerdict { GROWTH_UNKNOWN, GROWTH_NEITHER, GROWTH_SAME, GROWTH_FASTER, GROWTH_SLOWER } GrowthVerdict;
GrowthVerdict growth_compare(const Growth *growth, const Growth *shifted, double dt);

/* `frame,time,distance,shifted_distance`; shifted NULL, or NAN: that field is empty. */
typedef struct DistanceTable {
    int frames;
    double dt;                        /* s */
    const double *distance, *shifted; /* [frames] m */
} DistanceTable;
bool distance_table_write(const DistanceTable *table, const char *path, Error *error);
