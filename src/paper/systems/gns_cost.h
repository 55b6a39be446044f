/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What networks of gns cost, whatever they have learned. */
#pragma once
#include "common/error.h"
#include "common/progress.h"

typedef struct GnsCost {
    int boxes;                 /* of the scene, with the bomb */
    double seconds_a_pass;     /* neighbour search and network for all boxes, one thread */
    double seconds_a_gradient; /* a gradient step of the paper's batch, on all threads */
    double hours;              /* for the paper's number of gradient steps */
} GnsCost;

/* Measures `count` networks on a launch of a scene; `steps` gradient steps each. */
bool gns_cost_measure(const char *scene, const int *widths, const int *rounds, int count, int steps, GnsCost *costs,
                      const Progress *progress, Error *error);
