/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One run of a stability study: a scene with parameter values, and a method; and the converged runs that verdicts need,
   each computed once for all methods. */
#pragma once
#include "stability/stability_studies.h"
#include "study/contenders.h"

enum { STABILITY_PATH_SIZE = 4096 };

/* A parametric scene of the study. */
typedef struct StabilityPlace {
    const char *scenes; /* the folder that contains stability/ */
    const char *scene;  /* file name without folder and extension */
    const char *file;   /* or this file, if not NULL */
} StabilityPlace;

/* "scenes/stability/SCENE.yaml", or the file. ERROR_INPUT if it is too long. */
bool stability_path(char path[STABILITY_PATH_SIZE], const StabilityPlace *place, Error *error);

/* Reads the scene with these parameter values. The caller frees it. */
Scene *stability_scene(const StabilityPlace *place, const SceneSetting *settings, int count, Error *error);

/* How the run of a study's scene is judged: beside the converged run; whether the scene is meant to stand is given by the
   table of studies, or follows from the scene if it is a file. */
VerdictRun stability_verdict_run(const StabilityPlace *place, const Scene *scene, bool stands,
                                 const EnergyLog *converged);

/* The unit of a parameter of the scene, or "". */
const char *stability_unit(const Scene *scene, const char *parameter);

/* Shifts the first dynamic body, or if there is none the bomb, along x: by 0 for seed 0, by +-1e-6 m for seeds 1 and
   2. */
void stability_shift(Scene *scene, int seed);

/* False, with the reason in error, if the method does not apply to the scene: it cannot be created, or its first step
   fails. */
bool stability_applies(const Method *method, const Scene *scene, Error *error);

/* True for a method that makes as many sweeps as the scene sets. */
bool stability_takes_iterations(const Method *method);

/* A converged run at a value of the scanned parameter. */
typedef struct ConvergedRun {
    double value;
    EnergyLog log;
} ConvergedRun;

/* Counts runs and reports progress. Zero-initialise. */
typedef struct RunCounter {
    const Progress *progress; /* may be NULL */
    double done, expected;
    bool stopped;
} RunCounter;

/* Counts one run. Thread-safe. False with error set if progress stops the study. */
bool run_counter_add(RunCounter *counter, const char *what, Error *error);

/* A cache of converged runs. They always use a warm start, whatever the scene sets: it does not change the converged
   solution, but without it a stack of 40 boxes takes minutes. Shifted scenes use the run of the unshifted scene.

   Zero-initialise. Thread-safe; two threads may compute the same run, with the same result. */
typedef struct ConvergedRuns {
    int count;
    size_t capacity;
    ConvergedRun **runs; /* [count] */
} ConvergedRuns;

/* The run of the scene at the value by the method "reference". NULL with error set if it fails. */
const EnergyLog *converged_runs_get(ConvergedRuns *runs, const Scene *scene, double value, Error *error);
void converged_runs_free(ConvergedRuns *runs);

/* The converged run of a scene, not cached. */
bool converged_run_once(EnergyLog *log, const Scene *scene, Error *error);
