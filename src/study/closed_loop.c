/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/closed_loop.h"

#include "simulate/simulate.h"
#include "study/meter.h"
#include "study/statistics.h"
#include "study/world_measures.h"

#include <math.h>
#include <stdlib.h>

/* One launch run by two methods. */
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

/* m: the largest distance of a body from its position in the engine's run. */
static double distance_apart(const Pair *pair) {
    const Body *a = world_bodies(pair->worlds[0]), *b = world_bodies(pair->worlds[1]);
    double apart = 0;
    for (int i = 0; i < world_body_count(pair->worlds[0]); i++) {
        double x = (double)a[i].position.x - (double)b[i].position.x;
        double y = (double)a[i].position.y - (double)b[i].position.y;
        apart = fmax(apart, hypot(x, y));
    }
    return apart;
}

typedef struct LaunchResult {
    double frames_until_apart, penetration, energy_before, energy_most, momentum_sum;
    int steps;
} LaunchResult;

static void measure(const Pair *pair, const Scene *scene, int frame, LaunchResult *result) {
    const World *world = pair->worlds[1];
    const double energy = world_energy(world, scene->gravity);
    if (result->frames_until_apart == CLOSED_LOOP_FRAMES && !(distance_apart(pair) <= CLOSED_LOOP_APART))
        result->frames_until_apart = frame;
    result->penetration = fmax(result->penetration, world_penetration(world));
    result->momentum_sum += (double)world_solution(world)->momentum_error;
    result->steps = frame;
    if (frame <= scene->bomb.frame) result->energy_before = energy;
    result->energy_most = frame <= scene->bomb.frame ? energy : fmax(result->energy_most, energy);
}

static bool run_launch(const Method *method, const Scene *launched, LaunchResult *result, Error *error) {
    Pair pair;
    Scene scene = *launched;
    scene.frames = CLOSED_LOOP_FRAMES;
    if (!pair_begin(&pair, method, &scene, error)) return false;
    *result = (LaunchResult){.frames_until_apart = CLOSED_LOOP_FRAMES};
    result->energy_before = result->energy_most = world_energy(pair.worlds[1], scene.gravity);
    bool ok = true;
    for (int frame = 1; ok && frame <= CLOSED_LOOP_FRAMES; frame++) {
        const Step step = {.scene = &scene, .frame = frame};
        Error failure = {0};
        ok = simulate_step(pair.steppers[0], pair.worlds[0], &step, error);
        if (ok && !simulate_step(pair.steppers[1], pair.worlds[1], &step, &failure)) {
            /* The state became NaN or infinite. That is a valid result. */
            if (failure.kind == ERROR_INPUT) {
                result->frames_until_apart = fmin(result->frames_until_apart, frame);
                break;
            }
            *error = failure;
            ok = false;
        }
        if (ok) measure(&pair, &scene, frame, result);
    }
    pair_end(&pair);
    return ok;
}

bool closed_loop_run(const Method *method, const Scene *launches, int count, ClosedLoop *result, Error *error) {
    double *frames = malloc((size_t)count * sizeof *frames), momentum = 0, steps = 0;
    if (frames == NULL) return error_memory(error, "closed loop");
    *result = (ClosedLoop){0};
    bool ok = true;
    for (int i = 0; ok && i < count; i++) {
        LaunchResult launch;
        ok = run_launch(method, &launches[i], &launch, error);
        if (!ok) break;
        frames[i] = launch.frames_until_apart;
        result->penetration_max = fmax(result->penetration_max, launch.penetration);
        result->energy_ratio = fmax(result->energy_ratio, launch.energy_most / launch.energy_before);
        momentum += launch.momentum_sum;
        steps += launch.steps;
    }
    if (ok) {
        result->frames_until_apart = statistics_quantile(frames, count, 0.5);
        result->momentum_error = steps > 0 ? momentum / steps : 0;
    }
    free(frames);
    return ok;
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
