/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdict on the run of `simulate`, found while its steps are made. */
#pragma once
#include "common/json_write.h"
#include "scene/scene.h"
#include "simulate/simulate.h"
#include "stability/verdict.h"

/* Begin with simulate_verdict_begin(); free with simulate_verdict_free(). */
typedef struct SimulateVerdict {
    const Scene *scene;
    const char *method;
    VerdictWatch watch;
    VerdictReading reading; /* after simulate_verdict_end() */
} SimulateVerdict;

/* The scene and the method's text outlive the verdict. */
bool simulate_verdict_begin(SimulateVerdict *verdict, const Scene *scene, const char *method, Error *error);

/* To be called after every step; outlived by the verdict. */
StepObserver simulate_verdict_observer(SimulateVerdict *verdict);

/* After the run; failure: why it failed, if it did. False if there is no verdict: the run failed for another reason than
   a NaN or infinite state. */
bool simulate_verdict_end(SimulateVerdict *verdict, const Error *failure);
void simulate_verdict_free(SimulateVerdict *verdict);

/* "falls at 4.22 s (body 7, 0.53 m lower)" */
void simulate_verdict_words(const SimulateVerdict *verdict, char words[TRAJECTORY_VERDICT_SIZE]);

/* Prints "    verdict: " and these words. */
void simulate_verdict_print(const SimulateVerdict *verdict);

/* simulate() with the verdict in the run. */
Trajectory *simulate_judged(const Scene *scene, const Method *method, const Progress *progress, Error *error);

/* Puts it with all figures as an object into JSON (src/study/README.md, The verdict on one run). */
void simulate_verdict_put(const SimulateVerdict *verdict, JsonWriter *json, const char *key);

/* Writes that object as a file. */
bool simulate_verdict_write(const SimulateVerdict *verdict, const char *path, Error *error);
