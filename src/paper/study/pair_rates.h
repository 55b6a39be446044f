/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rates of right predictions. The paper does not define its "successful prediction rate" (section 4: 60 to 91%), so
   this measures three definitions of it, on steps sampled from the engine's runs (frozen.h). Each rate is beside those
   of the constant predictor and of the engine with fewer sweeps:

     range     both components of a pair's change of relative velocity are within 5% of their range in the engine's
               sampled steps
     absolute  the change of relative velocity is within 0.1 m/s, as a vector
     bodies    bodies whose velocity after the step is right, compared with the reference (reference/solution_error.h)

   Networks with the target net or impulse are rated on net changes or single impulses. Single impulses are the engine's
   own visits, so all its rates are 1 for them. */
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

/* Shares, 0 to 1; NAN without anything to count, or for a network that cannot take a step. RATE_ALL weights the phases
   by the inverse of their sampling. */
typedef struct PairRates {
    double share[RATE_DEFINITIONS][RATE_PHASES][RATE_COLUMNS];
} PairRates;

/* path: a network's file; NULL: the warm start, without a constant predictor. lists[count]: sampled by `sampling` from
   launches of the scene. */
bool pair_rates_measure(const char *path, const Scene *scene, const SnapshotList *lists, int count,
                        const Sampling *sampling, PairRates *rates, Error *error);
