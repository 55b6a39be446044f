/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How fast two runs diverge: the slope of the logarithm of their distance over time. Where the distance grows by a
   constant factor per frame, this is the largest Lyapunov exponent. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "runs/trajectory.h"

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

/* Sensitivity to the initial state: runs a scene twice with one method, the second time with one body shifted by a
   micrometre, and measures how fast the runs diverge. */

#define CHAOS_SHIFT 1e-6f /* m, in x; at least one ulp of the position */

typedef struct Chaos {
    int body;          /* the shifted body */
    double shift;      /* m, as represented in float32 */
    int rerun_differs; /* first frame in which the unshifted run differs from the given run; -1: none */
    int frames;
    double *distance; /* [frames] m, the largest of all bodies; NaN from where the shifted run is NaN or infinite */
} Chaos;

/* The body to shift, given that two runs diverge in this frame at body `diverged` (-1, -1: nowhere): the bomb or,
   without a bomb, the last dynamic body. If the bomb has touched nothing by that frame its shift cannot grow, so
   `diverged` is returned. -1: no dynamic body. */
int chaos_body(const Trajectory *run, int diverged, int frame);

/* Two runs are as near to each other as roundings keep them if in each frame they are no farther apart than the sum of
   what CHAOS_ROUNDINGS roundings of each step before have grown to: each grows as the shift of all bodies by one
   rounding did in as many steps. */
#define CHAOS_ROUNDINGS 8.0 /* of a coordinate in a step */

/* The first frame in which they are not, of as many as both have; -1: none. distance: m, NaN: farther than any. */
int chaos_exceeded(const Chaos *chaos, const double *distance, int frames);

/* Reads the scene at `path`, checks its hash against the run's, and runs `frames` frames with the run's method. `body`
   must be dynamic; -1: each dynamic body is shifted by one rounding in x, in turns to the right and to the left (in y,
   it would open and close contacts). ERROR_INPUT for another scene or an unavailable method. */
bool chaos_run(Chaos *chaos, const char *path, const Trajectory *run, int body, int frames, const Progress *progress,
               Error *error);
void chaos_free(Chaos *chaos);
