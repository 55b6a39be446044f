/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/closed_loop.h"

#include "simulate/simulate.h"
#include "study/meter.h"
#include "study/statistics.h"

#include <math.h>
#include <stdlib.h>

bool closed_loop_log(RunLog *log, const char *method, const Scene *launched, Error *error) {
    Method parsed;
    if (!method_parse(&parsed, method, error)) return false;
    Rollout rollout = {.log = *log};
    Stepper *stepper = stepper_create(&parsed, launched, error);
    bool ok = stepper != NULL && rollout_run(&rollout, stepper, launched, NULL, NULL, error);
    stepper_destroy(stepper);
    *log = rollout.log;
    rollout.log = (RunLog){0};
    rollout_free(&rollout);
    if (ok && log->frames < launched->frames)
        ok = error_input(error, launched->name, "the run of %s ends at frame %d with a state that is NaN or infinite",
                         method, log->frames);
    return ok;
}

static void measure(const RunLog *log, const Scene *scene, LaunchLoop *result) {
    const int launch = scene->bomb.frame < log->frames ? scene->bomb.frame : log->frames;
    result->energy_put_in = result->energy_most = log->energy[launch];
    for (int frame = 1; frame <= log->frames; frame++) {
        result->penetration = fmax(result->penetration, log->penetration[frame]);
        if (frame > launch) result->energy_most = fmax(result->energy_most, log->energy[frame]);
    }
}

bool closed_loop_launch(Rollout *rollout, const Method *method, const Scene *launched, const RunLog *engine,
                        const RunLog *converged, LaunchLoop *result, Error *error) {
    Stepper *stepper = stepper_create(method, launched, error);
    const bool ok = stepper != NULL && rollout_run(rollout, stepper, launched, NULL, NULL, error);
    stepper_destroy(stepper);
    if (!ok) return false;
    const RunLog *log = &rollout->log;
    const int frames = launched->frames;
    *result = (LaunchLoop){.frames_engine = run_log_apart(log, engine, CLOSED_LOOP_APART, frames),
                           .frames_converged = converged != NULL
                                                   ? (double)run_log_apart(log, converged, CLOSED_LOOP_APART, frames)
                                                   : (double)NAN,
                           .moved = run_log_moved(log, launched),
                           .momentum_error = log->momentum_error,
                           .steps = log->frames,
                           .fallen_back = log->fallen_back};
    measure(log, launched, result);
    return true;
}

static bool run_launch(Rollout *rollout, RunLog *engine, const Method *method, const Scene *launched,
                       LaunchLoop *result, Error *error) {
    Scene scene = *launched;
    scene.frames = CLOSED_LOOP_FRAMES;
    return closed_loop_log(engine, "engine", &scene, error) &&
           closed_loop_launch(rollout, method, &scene, engine, NULL, result, error);
}

bool closed_loop_run(const Method *method, const Scene *launches, int count, ClosedLoop *result, Error *error) {
    double *frames = malloc((size_t)count * sizeof *frames), momentum = 0, steps = 0;
    if (frames == NULL) return error_memory(error, "closed loop");
    Rollout rollout = {0};
    RunLog engine = {0};
    *result = (ClosedLoop){0};
    bool ok = true;
    for (int i = 0; ok && i < count; i++) {
        LaunchLoop launch;
        ok = run_launch(&rollout, &engine, method, &launches[i], &launch, error);
        if (!ok) break;
        frames[i] = launch.frames_engine;
        result->penetration_max = fmax(result->penetration_max, launch.penetration);
        result->energy_ratio = fmax(result->energy_ratio, launch.energy_most / launch.energy_put_in);
        momentum += launch.momentum_error;
        steps += launch.steps;
    }
    if (ok) {
        result->frames_until_apart = statistics_quantile(frames, count, 0.5);
        result->momentum_error = steps > 0 ? momentum / steps : 0;
    }
    run_log_free(&engine);
    rollout_free(&rollout);
    free(frames);
    return ok;
}

/* The engine and a method, each with a world of its own. */
typedef struct Pair {
    Stepper *steppers[2]; /* engine, method */
    World *worlds[2];
} Pair;

static void pair_end(Pair *pair) {
    for (int i = 0; i < 2; i++) {
        stepper_destroy(pair->steppers[i]);
        world_destroy(pair->worlds[i]);
    }
    *pair = (Pair){0};
}

static bool pair_begin(Pair *pair, const Method *method, const Scene *scene, Error *error) {
    Method engine;
    *pair = (Pair){0};
    if (!method_parse(&engine, "engine", error)) return false;
    const Method *methods[2] = {&engine, method};
    for (int i = 0; i < 2; i++) {
        if ((pair->worlds[i] = scene_world(scene, error)) == NULL ||
            (pair->steppers[i] = stepper_create(methods[i], scene, error)) == NULL) {
            pair_end(pair);
            return false;
        }
    }
    return true;
}

/* Mean microseconds per step over all states; negative if a step failed. */
static double time_states(Stepper *stepper, World *world, const SnapshotList *states, Error *error) {
    const int64_t overhead = meter_time_overhead();
    int64_t sum = 0;
    for (int i = 0; i < states->count; i++) {
        const Snapshot *state = &states->items[i];
        const Step step = {.scene = state->scene, .frame = state->frame};
        if (!world_copy(world, state->world, error)) return -1;
        const int64_t before = meter_time();
        if (!stepper_step(stepper, world, &step, error)) return -1;
        sum += meter_without(meter_time() - before, overhead);
    }
    return 1e-3 * (double)sum / states->count;
}

bool closed_loop_time(const Method *method, const SnapshotList *states, int repetitions, double *us_step,
                      double *us_step_engine, Error *error) {
    Pair pair;
    double *times = malloc(2 * (size_t)repetitions * sizeof *times);
    if (times == NULL) return error_memory(error, "closed loop");
    bool ok = pair_begin(&pair, method, states->items[0].scene, error);
    for (int r = 0; ok && r < repetitions; r++)
        for (int i = 0; ok && i < 2; i++)
            ok = (times[i * repetitions + r] = time_states(pair.steppers[i], pair.worlds[i], states, error)) >= 0;
    if (ok) {
        *us_step_engine = statistics_quantile(times, repetitions, 0.5);
        *us_step = statistics_quantile(times + repetitions, repetitions, 0.5);
    }
    pair_end(&pair);
    free(times);
    return ok;
}
