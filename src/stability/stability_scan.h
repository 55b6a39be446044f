/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One stability study: the borders of every method along a parameter; a part of the study (study_parts.h). */
#pragma once
#include "common/progress.h"
#include "stability/stability_case.h"

typedef struct StabilityScan {
    const StabilityStudy *study;
    const char *scenes; /* the folder that contains stability/ */
    const ContenderList *methods;
} StabilityScan;

/* Writes the rows of the tables "stability", "refusals", "fallbacks" (every unshifted run of a method that may fall back)
   and "rest" (every unshifted run, if study.rests), ordered by method; methods run in parallel. Omits methods that set
   their own number of sweeps if the study scans it. `scan` is a StabilityScan. */
bool stability_scan_write(void *scan, FILE *lines, const Progress *progress, Error *error);

/* The verdict on one run of a study; seed: stability_shift(). False with error set if the method does not apply to the
   scene or memory is short. */
bool stability_scan_run(const StabilityScan *scan, const Method *method, double value, int seed,
                        ConvergedRuns *converged, VerdictReading *reading, Error *error);
