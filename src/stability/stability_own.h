/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study of one scene file: borders along its parameters and, with two of them, their map. */
#pragma once
#include "stability/stability_studies.h"

enum { STABILITY_MAX_VARY = 2, STABILITY_OWN_NAME_SIZE = 40 };

typedef struct StabilityOwn {
    char names[STABILITY_MAX_VARY + 1][STABILITY_OWN_NAME_SIZE]; /* of the studies, then of the map */
    char parameters[STABILITY_MAX_VARY][SCENE_PARAMETER_SIZE];   /* varied */
    bool stepped[STABILITY_MAX_VARY];                            /* the range has a step: these values and no fewer */
    int study_count, map_count;                                  /* of the arrays below */
    StabilityStudy studies[STABILITY_MAX_VARY];                  /* SCENE_PARAMETER */
    StabilityMap maps[1];                                        /* SCENE_PARAMETER_PARAMETER */
} StabilityOwn;

/* Makes the studies of the scene at `path` for texts "NAME", "NAME=FROM:TO" or "NAME=FROM:TO:STEP"; without FROM and TO a parameter's bounds.
   A range without STEP whose ends differ by more than a factor of 20 is logarithmic. The result points into itself and to `path`.
   ERROR_INPUT: no or unknown parameters, more than STABILITY_MAX_VARY, a parameter twice, a range that is not within the
   parameter's bounds, a unit that tables cannot hold, a value of the scan for which the scene is refused. */
bool stability_own_make(StabilityOwn *own, const char *path, const char *const *texts, int count, bool quick,
                        Error *error);
