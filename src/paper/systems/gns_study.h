/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study of gns: how far its runs are from those that it was trained on, by rounds of messages and with noise or without;
   how the shapes of boxes last; large piles; what the paper's own size costs. */
#pragma once
#include "paper/systems/system.h"

/* What a row of system_gns.csv is about. */
typedef enum GnsMeasure { GNS_ROLLOUT, GNS_LARGE, GNS_COST } GnsMeasure;
enum { GNS_MEASURES = GNS_COST + 1, GNS_MAX_ROWS = 1000 };
extern const char *const gns_measure_words[GNS_MEASURES + 1]; /* rollout, large, cost */

/* NAN where a number is not applicable. */
typedef struct GnsRow {
    int measure;         /* GnsMeasure */
    const char *variant; /* of gns_variants; of a cost "width 128, M = 10" */
    const char *scene;
    double seconds; /* s from the bomb's launch on */
    double boxes;   /* that move, with the bomb */
    double error;   /* m: distance of a box from its place in the run of the method that made the training data,
                                   mean over boxes and launches */
    double shape;   /* m: gns_shape_distance, mean over launches */
    double moved, moved_engine; /* boxes that moved more than 0.5 m, at most 5 s after the launch */
    double ms_step;             /* ms of a simulation step on one thread: neighbour search, network, projection */
    double ms_gradient;         /* ms of a gradient step with the paper's batch, on all threads */
    double hours;               /* for the paper's number of gradient steps */
} GnsRow;

/* What the rollouts compare, each trained by scenes/networks/train in the same number of steps. */
typedef struct GnsVariant {
    const char *name, *network, *settings; /* network: a file of the folder `networks` beside the scenes */
    int rounds;
} GnsVariant;

enum { GNS_SHIPPED, GNS_TWO_ROUNDS, GNS_ONE_ROUND, GNS_NO_NOISE, GNS_NOT_RIGID, GNS_VARIANTS };
extern const GnsVariant gns_variants[GNS_VARIANTS];

extern const CsvLayout gns_table_layout;

/* States the claims from the table. */
bool gns_claims(const Claims *claims, Error *error);
