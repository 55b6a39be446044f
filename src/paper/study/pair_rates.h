/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How often a network is right. The paper's "successful prediction rate" (section 4: 60 to 91%) is not defined there, so
   it is measured in three ways, on steps sampled from the engine's runs (frozen.h), each beside predicting the mean and
   beside the engine with fewer sweeps:

     range     a pair's change of relative velocity, both numbers, within 5% of the range of what the engine did in the
               sampled steps
     absolute  the same within 0.1 m/s, as a vector
     bodies    bodies whose velocity after the step is right by the converged reference (reference/solution_error.h)

   A network trained on net changes or on single impulses is asked for those. The engine's visits are what single
   impulses are: all its rates are 1 there. */
#pragma once
#include "study/frozen.h"

typedef enum RateDefinition { RATE_RANGE, RATE_ABSOLUTE, RATE_BODIES, RATE_DEFINITIONS } RateDefinition;
typedef enum RateColumn {
    RATE_NETWORK,
    RATE_CONSTANT,
    RATE_ENGINE1,
    RATE_ENGINE4,
    RATE_ENGINE10,
    RATE_COLUMNS
} RateColumn;

enum { RATE_PHASES = PHASES + 1, RATE_ALL = PHASES };

extern const char *const rate_definition_names[RATE_DEFINITIONS + 1]; /* ends in NULL */

/* Shares, 0 to 1; NAN where there is nothing to count, or a network that cannot take a step. RATE_ALL weighs the phases
   by how seldom they were sampled. */
typedef struct PairRates {
    double share[RATE_DEFINITIONS][RATE_PHASES][RATE_COLUMNS];
} PairRates;

/* path: of a network; NULL: the impulses of the last step once more, and no constant beside it. lists[count]: sampled by
   `sampling` from launches of the scene. */
bool pair_rates_measure(const char *path, const Scene *scene, const SnapshotList *lists, int count,
                        const Sampling *sampling, PairRates *rates, Error *error);
