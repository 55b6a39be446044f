/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One run of a study of stability: a scene with its numbers, a method, a verdict; and the converged runs that verdicts
   need, each made once for all methods. */
#pragma once
#include "stability/stability_studies.h"
#include "study/contenders.h"

enum { STABILITY_PATH_SIZE = 4096 };

/* A scene of the study, open at numbers that are still to come. */
typedef struct StabilityPlace {
    const char *scenes; /* the folder above stability/ */
    const char *scene;  /* file name without folder and ending */
} StabilityPlace;

/* "scenes/stability/SCENE.yaml". ERROR_INPUT where it is too long. */
bool stability_path(char path[STABILITY_PATH_SIZE], const StabilityPlace *place, Error *error);

/* Reads it with these numbers. The caller frees it. */
Scene *stability_scene(const StabilityPlace *place, const SceneSetting *settings, int count, Error *error);

/* The unit of one of the scene's numbers; "" where it has none. */
const char *stability_unit(const Scene *scene, const char *parameter);

/* Shifts the first body that moves, or else the bomb, along x: not at all for seed 0, by 1e-6 m forth and back for 1
   and 2. */
void stability_shift(Scene *scene, int seed);

/* False, with the reason in error, where the method does not go with the scene: it cannot be created, or refuses the first
   step. */
bool stability_applies(const Method *method, const Scene *scene, Error *error);

/* True for a method that makes as many sweeps as the scene sets. */
bool stability_takes_iterations(const Method *method);

/* A converged run, by the value of the number that is scanned. */
typedef struct ConvergedRun {
    double value;
    EnergyLog log;
} ConvergedRun;

/* How many runs are done; asks whether to go on. Zero-initialise. */
typedef struct RunCounter {
    const Progress *progress; /* may be NULL */
    double done, expected;
    bool stopped;
} RunCounter;

/* Counts one, from any thread. False with error set where progress asked to stop. */
bool run_counter_add(RunCounter *counter, const char *what, Error *error);

/* Converged runs begin each step with the impulses of the one before, whatever the scene says: where they end does not
   depend on that, but a stack of 40 that begins with nothing takes them minutes.

   Zero-initialise. Threads may ask at once; one that asks for what another is about to make makes it, too, which changes
   nothing. Those of shifted scenes are the unshifted one's. */
typedef struct ConvergedRuns {
    int count;
    size_t capacity;
    ConvergedRun **runs; /* [count] */
} ConvergedRuns;

/* The run of the scene at the value by the method "reference". NULL with error set where it cannot be made. */
const EnergyLog *converged_runs_get(ConvergedRuns *runs, const Scene *scene, double value, Error *error);
void converged_runs_free(ConvergedRuns *runs);

/* The converged run of a scene, for one use. */
bool converged_run_once(EnergyLog *log, const Scene *scene, Error *error);
