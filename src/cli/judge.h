/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdict on a run, made or stored:

     Trajectory *run = simulate_judged(scene, &method, NULL, &error);
     JudgedRun judged;
     if (judged_run_find(&judged, run, &(JudgeOptions){0}, &error)) puts(judged.words); */
#pragma once
#include "base/base.h"
#include "base/json.h"
#include "base/machine.h"
#include "cli/options.h"
#include "methods/methods.h"
#include "runs/trajectory.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

/* simulate() with the verdict in the run. */
Trajectory *simulate_judged(const Scene *scene, const Method *method, const Progress *progress, Error *error);

/* Writes the verdict with all its figures as a file. */
bool simulate_verdict_write(const SimulateVerdict *verdict, const char *path, Error *error);

/* Puts it with all figures as an object into JSON (src/studies/README.md, The verdict on one run). */
void simulate_verdict_put(const SimulateVerdict *verdict, JsonWriter *json, const char *key);

/* The verdict on a stored run. */

typedef struct JudgeOptions {
    const char *scene; /* file; NULL: masses and gravity are assumed */
    SceneSettings set; /* of its parameters */
    float skin;        /* m */
} JudgeOptions;

/* Rows of an option table whose Options T have JudgeOptions as `member`. */
#define OPTIONS_JUDGE(T, member)                                                                                   \
    {"--scene", 0, "SCENE", "Scene of the run: its masses, gravity and bomb (default: 1 kg/m2 and 10 m/s2)",       \
     OPTION_PATH(T, member.scene)},                                                                                \
        {OPTION_SET(T, member.set)}, {                                                                             \
        "--skin", 0, "M",                                                                                          \
            "What the engine adds to each side of a box, m: boxes that rest apart by twice that touch, and being " \
            "pushed apart by it is no explosion (default: 0; Box2D before version 3, Planck: 0.0075)",             \
            OPTION_FLOAT(T, member.skin, 0, 1)                                                                     \
    }

typedef struct JudgedRun {
    SimulateVerdict verdict;
    char words[TRAJECTORY_VERDICT_SIZE];
} JudgedRun;

/* Free with judged_run_free(), also after a failure. */
bool judged_run_find(JudgedRun *judged, const Trajectory *run, const JudgeOptions *options, Error *error);
void judged_run_print(const JudgedRun *judged, const JudgeOptions *options);
void judged_run_free(JudgedRun *judged);
