/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A method beside the engine and the reference in closed loop. */
#include "base/base.h"
#include "methods/methods.h"
#include "scenes/scenes.h"
#include "studies/closed_loop.h"
#include "studies/contenders.h"
#include "studies/rollout.h"
#include "studies/statistics.h"
#include "studies/timing.h"

#include <math.h>
#include <stdlib.h>

static bool log_run(RunLog *log, const char *method, bool engine_contacts, const Scene *launched, Error *error) {
    Method parsed;
    if (!method_parse(&parsed, method, error)) return false;
    Rollout rollout = {.log = *log, .engine_contacts = engine_contacts};
    Stepper *stepper = stepper_create(&parsed, launched, error);
    const bool ok = stepper != NULL && rollout_run(&rollout, stepper, launched, NULL, NULL, error);
    stepper_destroy(stepper);
    *log = rollout.log;
    rollout.log = (RunLog){0};
    rollout_free(&rollout);
    return ok &&
           (log->frames >= launched->frames ||
            error_input(error, launched->name, "the run of %s ends at frame %d with a state that is NaN or infinite",
                        method, log->frames));
}

bool closed_loop_log(RunLog *log, const char *method, const Scene *launched, Error *error) {
    return log_run(log, method, false, launched, error);
}

bool closed_loop_log_converged(ConvergedLogs *logs, const Scene *launched, Error *error) {
    return log_run(&logs->with[false], "reference", true, launched, error) &&
           log_run(&logs->with[true], "reference", false, launched, error);
}

void converged_logs_free(ConvergedLogs *logs) {
    run_log_free(&logs->with[false]);
    run_log_free(&logs->with[true]);
}

static const double apart_distance = 0.1; /* m */

static double frames_apart(const RunLog *log, const RunLog *other, int frames) {
    if (other == NULL) return NAN;
    const int apart = run_log_apart(log, other, apart_distance, frames);
    return other->first_unconverged == 0 || apart < other->first_unconverged ? apart : (double)NAN;
}

bool closed_loop_launch(Rollout *rollout, const Method *method, const Scene *launched, const RunLog *engine,
                        const ConvergedLogs *converged, LaunchLoop *result, Error *error) {
    Stepper *stepper = stepper_create(method, launched, error);
    const bool ok = stepper != NULL && rollout_run(rollout, stepper, launched, NULL, NULL, error);
    const RunLog *log = &rollout->log,
                 *yardstick = ok && converged != NULL ? &converged->with[stepper_mends(stepper)] : NULL;
    stepper_destroy(stepper);
    if (!ok) return false;
    const int frames = launched->frames;
    *result = (LaunchLoop){.frames_engine = frames_apart(log, engine, frames),
                           .frames_converged = frames_apart(log, yardstick, frames),
                           .moved = run_log_moved(log, launched),
                           .momentum_error = log->momentum_error,
                           .steps = log->frames,
                           .fallen_back = log->fallen_back};
    const int launch = launched->bomb.frame < log->frames ? launched->bomb.frame : log->frames;
    result->energy_put_in = result->energy_most = log->at[launch].energy;
    for (int frame = 1; frame <= log->frames; frame++) {
        result->penetration = fmax(result->penetration, log->at[frame].penetration);
        if (frame > launch) result->energy_most = fmax(result->energy_most, log->at[frame].energy);
    }
    return true;
}

bool closed_loop_run(const Method *method, const Scene *launches, const ConvergedLogs *converged, int count,
                     ClosedLoop *result, Error *error) {
    double *frames = malloc((size_t)count * sizeof *frames), momentum = 0, steps = 0;
    if (frames == NULL) return error_memory(error, "closed loop");
    Rollout rollout = {0};
    *result = (ClosedLoop){0};
    bool ok = true;
    for (int i = 0; ok && i < count; i++) {
        LaunchLoop launch;
        Scene scene = launches[i];
        scene.frames = CLOSED_LOOP_FRAMES;
        ok = closed_loop_launch(&rollout, method, &scene, NULL, &converged[i], &launch, error);
        if (!ok) break;
        frames[i] = launch.frames_converged;
        result->penetration_max = fmax(result->penetration_max, launch.penetration);
        result->energy_ratio = fmax(result->energy_ratio, launch.energy_most / launch.energy_put_in);
        momentum += launch.momentum_error;
        steps += launch.steps;
    }
    if (ok) {
        const int known = statistics_known(frames, count);
        result->frames_until_apart = statistics_quantile(frames, known, 0.5);
        result->unconverged = count - known;
        result->momentum_error = steps > 0 ? momentum / steps : 0;
    }
    rollout_free(&rollout);
    free(frames);
    return ok;
}

bool closed_loop_time(const Method *method, const SnapshotList *states, int repetitions, double *us_step,
                      double *us_step_engine, Error *error) {
    Contender engine, other = {.method = *method};
    const Contender *const both[] = {&engine, &other};
    const TimingOptions options = {.launches = states->items[0].scene, .repetitions = repetitions};
    StepCost closed[2][PHASES], frozen[2][PHASES];
    if (!method_parse(&engine.method, "engine", error) ||
        !timing_measure(both, 2, &options, states, closed, frozen, NULL, error))
        return false;
    *us_step_engine = step_cost_mean(frozen[0], false);
    *us_step = step_cost_mean(frozen[1], false);
    return true;
}
