/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closed loop: a method, the engine and the reference run the same launches, each on its own trajectory. */
#pragma once
#include "base/base.h"
#include "methods/methods.h"
#include "scenes/scenes.h"
#include "studies/rollout.h"

#include <stdbool.h>

enum { CLOSED_LOOP_FRAMES = 600 };

/* A run of one launch beside others of the same launch. */
typedef struct LaunchLoop {
    double frames_engine; /* first frame in which a body is more than 0.1 m from its place in the engine's
                                run; the scene's frames: never; NAN without a run to compare with */
    /* the same of the converged run; NAN, too, if that is not converged before the runs part */
    double frames_converged;
    double moved;           /* boxes that moved more than 0.5 m in the 5 s after the launch */
    double penetration;     /* m: the deepest contact */
    double energy_put_in;   /* J: mechanical energy when the bomb was added */
    double energy_most;     /* J: the largest from then on */
    double momentum_error;  /* N s: momentum created by all steps (ContactSolution), sum */
    int steps, fallen_back; /* steps taken; those with discarded outputs, beyond training or solved by sweeps */
} LaunchLoop;

/* Logs of the converged runs of one launch. Other contacts lead elsewhere, however well they are solved, so a method is
   compared with the run that has contacts as its own: with[stepper_mends()]. Zero-initialise. */
typedef struct ConvergedLogs {
    RunLog with[2]; /* Box2D-Lite's contacts, mended ones */
} ConvergedLogs;

void converged_logs_free(ConvergedLogs *logs);

/* Runs a launched scene for its frames and compares. engine, converged: logs of whole runs of this launch, or NULL. The
   run ends early if its state becomes NaN or infinite. rollout: scratch. */
bool closed_loop_launch(Rollout *rollout, const Method *method, const Scene *launched, const RunLog *engine,
                        const ConvergedLogs *converged, LaunchLoop *result, Error *error);

/* Log runs of a launched scene to compare others with. ERROR_INPUT if a state becomes NaN or infinite. */
bool closed_loop_log(RunLog *log, const char *method, const Scene *launched, Error *error);
bool closed_loop_log_converged(ConvergedLogs *logs, const Scene *launched, Error *error);

typedef struct ClosedLoop {
    double frames_until_apart; /* LaunchLoop.frames_converged, median over the launches of which it is known */
    int unconverged;           /* launches of which it is not */
    double penetration_max;    /* m: of all launches */
    double momentum_error;     /* N s: momentum created per step (ContactSolution), mean */
    double energy_ratio;       /* largest mechanical energy / energy when the bomb was added; largest of all launches */
} ClosedLoop;

/* Runs launches[count] of a scene for CLOSED_LOOP_FRAMES. converged[count]: for as long. */
bool closed_loop_run(const Method *method, const Scene *launches, const ConvergedLogs *converged, int count,
                     ClosedLoop *result, Error *error);

/* Microseconds per step of a method and of the engine, measured in turns on engine states: as in
   studies/timing.h. */
bool closed_loop_time(const Method *method, const SnapshotList *states, int repetitions, double *us_step,
                      double *us_step_engine, Error *error);
