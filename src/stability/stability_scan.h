/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One study of stability: the borders of every method, as a part of a longer work (study_parts.h). */
#pragma once
#include "common/progress.h"
#include "stability/stability_case.h"

typedef struct StabilityScan {
    const StabilityStudy *study;
    const char *scenes; /* the folder above stability/ */
    const ContenderList *methods;
} StabilityScan;

/* Writes the lines of the tables "stability", "refusals", "fallbacks" (of each run by a network, without a shift) and
   "rest" (of each run of a study that rests, without a shift) in the order of the methods, which are studied in
   parallel. A method that has its own number of iterations has no row where those are scanned. `scan` is a
   StabilityScan. */
bool stability_scan_write(void *scan, FILE *lines, const Progress *progress, Error *error);

/* The verdict on one run of a study; seed: stability_shift. False with error set where the method does not go with the
   scene, or memory is short. */
bool stability_scan_run(const StabilityScan *scan, const Method *method, double value, int seed,
                        ConvergedRuns *converged, VerdictReading *reading, Error *error);
