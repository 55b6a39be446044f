/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One stability study: the borders of every method along a parameter. */
#pragma once
#include "common/progress.h"
#include "stability/stability_case.h"

#include <stdio.h>

typedef struct StabilityScan {
    const StabilityStudy *study;
    const char *scenes; /* the folder that contains stability/ */
    const ContenderList *methods;
} StabilityScan;

/* What the pieces of a scan have in common. */
typedef struct ScanContext {
    const StabilityScan *scan;
    Scene *typical; /* with default parameters */
    ConvergedRuns converged;
} ScanContext;

/* stability_scan_end() also after a failure. */
bool stability_scan_begin(ScanContext *context, const StabilityScan *scan, Error *error);
void stability_scan_end(ScanContext *context);

/* Does the methods first .. end - 1 and writes their rows (study/piece_tables.h) of the tables "stability", "refusals",
   "fallbacks" (every unshifted run of a method that may fall back) and "rest" (every unshifted run, if study.rests), ordered
   by method. Omits methods that set their own number of sweeps if the study scans it. */
bool stability_scan_write(ScanContext *context, int first, int end, FILE *results, const Progress *progress,
                          Error *error);

/* The verdict on one run of a study; seed: stability_shift(). False with error set if the method does not apply to the
   scene or memory is short. */
bool stability_scan_run(const StabilityScan *scan, const Method *method, double value, int seed,
                        ConvergedRuns *converged, VerdictReading *reading, Error *error);
