/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where two runs part: the growth of their distance, and chaos, measured with a shifted run. */
#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/compare_runs.h"
#include "runs/divergence.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <gsl/gsl_fit.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void chaos_free(Chaos *chaos) {
    free(chaos->distance);
    *chaos = (Chaos){.frames = 0};
}

int chaos_body(const Trajectory *run, int diverged, int frame) {
    if (run->bomb >= 0) {
        bool strikes = diverged < 0 || run->fixed[diverged]; /* or has a contact in a step up to the frame */
        for (int64_t i = 0; !strikes && i < run->contact_start[frame + 1]; i++)
            strikes = run->contacts[i].a == run->bomb || run->contacts[i].b == run->bomb;
        return strikes ? run->bomb : diverged;
    }
    int body = run->bodies - 1;
    while (body >= 0 && run->fixed[body]) body--;
    return body;
}

/* Copies the scene; the caller frees shifted->bodies. Only the position changes: an aimed bomb keeps its velocity. */
static bool shifted_scene(const Scene *scene, int body, Scene *shifted, Chaos *chaos, Error *error) {
    *shifted = *scene;
    const size_t size = (size_t)scene->body_count * sizeof *scene->bodies;
    shifted->bodies = calloc((size_t)scene->body_count + 1, sizeof *scene->bodies);
    if (shifted->bodies == NULL) return error_memory(error, scene->name);
    if (size > 0) memcpy(shifted->bodies, scene->bodies, size);
    shifted->bomb.velocity = scene_bomb_body(scene).velocity;
    shifted->bomb.velocity_from_position = false;
    chaos->body = body;
    chaos->shift = 0;
    for (int i = 0; body < 0 && i <= scene->body_count; i++) { /* the last is the bomb */
        float *x = i == scene->body_count ? &shifted->bomb.x.value : &shifted->bodies[i].position.x;
        const float unit = FLT_EPSILON * fmaxf(1, exp2f(floorf(log2f(fabsf(*x))))); /* of the last place, from 1 m on */
        if (i == scene->body_count ? !scene->bomb.present : scene->bodies[i].fixed) continue;
        *x += i % 2 == 0 ? unit : -unit;
        chaos->shift = fmax(chaos->shift, (double)unit);
    }
    if (body < 0) return true;
    float *x = body == scene->body_count ? &shifted->bomb.x.value : &shifted->bodies[body].position.x;
    const float before = *x;
    *x = before + CHAOS_SHIFT;
    if (*x == before) *x = nextafterf(before, INFINITY);
    chaos->shift = (double)*x - before;
    return true;
}

typedef struct Watch {
    Chaos *chaos;
    const Trajectory *unshifted;
    ProgressStage stage;
} Watch;

static bool measure(void *context, int frame, const World *world, Error *error) {
    Watch *watch = context;
    const Trajectory *unshifted = watch->unshifted;
    const Body *bodies = world_bodies(world);
    double largest = 0;
    for (int i = 0; i < world_body_count(world); i++)
        largest =
            fmax(largest, vec2_distance(bodies[i].position, unshifted->position[trajectory_at(unshifted, frame, i)]));
    watch->chaos->distance[frame] = largest;
    return progress_stage(&watch->stage, frame, unshifted->frames) ||
           error_interrupted(error, unshifted->scene, "stopped after step %d of %d", frame, unshifted->frames - 1);
}

/* Runs the scene as it is, then shifted; measures how far the two are apart. */
static bool run_both(Chaos *chaos, const Scene *scene, const Trajectory *run, int body, const Progress *progress,
                     Error *error) {
    Method method;
    Scene shifted = {.bodies = NULL};
    TrajectoryDifference difference;
    Error failure = {0};
    if (!method_parse(&method, run->method, error)) return false;
    ProgressStage first = {progress, 0, 0.5, false};
    Trajectory *unshifted = simulate(scene, &method, &(Progress){progress_stage, &first}, error);
    bool ok = unshifted != NULL;
    if (ok) {
        trajectory_compare(unshifted, run, &difference);
        chaos->rerun_differs = difference.frame;
        if (difference.frame < 0 && unshifted->bodies != run->bodies)
            ok = error_input(error, scene->name, "is not the scene of the run: %s", difference.what);
    }
    ok = ok && shifted_scene(scene, body, &shifted, chaos, error);
    if (ok) {
        Watch watch = {chaos, unshifted, {progress, 0.5, 0.5, false}};
        for (int frame = 0; frame < chaos->frames; frame++) chaos->distance[frame] = NAN;
        chaos->distance[0] = body < 0 || trajectory_has(unshifted, 0, body) ? chaos->shift : 0;
        /* A run that ends in a NaN or infinite state is a valid result. */
        ok = simulate_observed(&shifted, &method, &(StepObserver){measure, &watch}, &failure) ||
             failure.failure != FAILURE_NONE;
        if (!ok) *error = failure;
    }
    free(shifted.bodies);
    trajectory_destroy(unshifted);
    return ok;
}

static bool run_scene(Chaos *chaos, Scene *scene, const char *path, const Trajectory *run, int body, int frames,
                      const Progress *progress, Error *error) {
    const uint64_t hash = scene_hash(scene);
    if (run->scene_hash == 0)
        return error_input(error, path, "cannot be run again for the run by %s: that run does not state its scene_hash",
                           run->method);
    if (hash != run->scene_hash)
        return error_input(error, path,
                           "is not the scene of the run by %s: its hash is %016" PRIx64
                           ", that of the run's scene is %016" PRIx64,
                           run->method, hash, run->scene_hash);
    if (frames - 1 > SCENE_MAX_FRAMES)
        return error_input(error, path, "can run at most %d steps (got %d)", SCENE_MAX_FRAMES, frames - 1);
    scene->frames = frames - 1;
    *chaos = (Chaos){.frames = frames, .distance = malloc((size_t)frames * sizeof *chaos->distance)};
    if (chaos->distance == NULL) return error_memory(error, path);
    if (run_both(chaos, scene, run, body, progress, error)) return true;
    chaos_free(chaos);
    return false;
}

bool chaos_run(Chaos *chaos, const char *path, const Trajectory *run, int body, int frames, const Progress *progress,
               Error *error) {
    Scene *scene = scene_read(path, error);
    bool ok = scene != NULL && run_scene(chaos, scene, path, run, body, frames, progress, error);
    scene_destroy(scene);
    return ok;
}

int chaos_exceeded(const Chaos *chaos, const double *distance, int frames) {
    double sum = 0;
    for (int frame = 0; frame < frames; frame++) {
        sum += isnan(chaos->distance[frame]) ? INFINITY : chaos->distance[frame];
        if (!(distance[frame] <= CHAOS_ROUNDINGS * sum)) return frame;
    }
    return -1;
}

static const double LN_2 = 0.69314718055994530942;

/* Sets all members but the rate; fills `count` of logarithms and times [end - from]. */
static void find_window(Growth *growth, const double *distance, int from, int end, double dt, double *times,
                        double *logarithms) {
    growth->end = end;
    for (int frame = from; frame < growth->end; frame++) {
        if (distance[frame] >= GROWTH_SATURATED) {
            growth->saturated = true;
            growth->end = frame;
            return;
        }
        if (!(distance[frame] > 0)) continue;
        if (growth->count == 0) {
            growth->first = frame;
            growth->from = distance[frame];
        }
        growth->last = frame;
        growth->to = distance[frame];
        times[growth->count] = frame * dt;
        logarithms[growth->count++] = log(distance[frame]);
    }
}

bool growth_measure(const double *distance, int from, int end, double dt, Growth *growth, Error *error) {
    *growth = (Growth){.first = -1, .last = -1, .end = from, .rate = NAN, .scatter = NAN};
    if (from < 0 || from >= end) return true;
    size_t frames = (size_t)(end - from);
    double *times = malloc(2 * frames * sizeof *times);
    if (times == NULL) return error_memory(error, "growth");
    double *logarithms = times + frames;
    find_window(growth, distance, from, end, dt, times, logarithms);
    if (growth->count >= GROWTH_MIN_FRAMES) {
        double at_zero, cov00, cov01, cov11, squares;
        gsl_fit_linear(times, 1, logarithms, 1, (size_t)growth->count, &at_zero, &growth->rate, &cov00, &cov01, &cov11,
                       &squares);
        growth->scatter = sqrt(squares / growth->count);
    }
    free(times);
    return true;
}

double growth_doubling(const Growth *growth, double dt) { return LN_2 / (growth->rate * dt); }

static bool grows(const Growth *growth, double dt) {
    return growth->rate * (growth->last - growth->first) * dt >= LN_2;
}

GrowthVerdict growth_compare(const Growth *growth, const Growth *shifted, double dt) {
    if (isnan(growth->rate) || isnan(shifted->rate)) return GROWTH_UNKNOWN;
    bool one = grows(growth, dt), other = grows(shifted, dt);
    if (!one && !other) return GROWTH_NEITHER;
    if (!other || (one && growth->rate > GROWTH_ALIKE * shifted->rate)) return GROWTH_FASTER;
    if (!one || shifted->rate > GROWTH_ALIKE * growth->rate) return GROWTH_SLOWER;
    return GROWTH_SAME;
}

static void print_table(FILE *out, const void *context) {
    const DistanceTable *table = context;
    fprintf(out, "frame,time,distance,shifted_distance\n");
    for (int frame = 0; frame < table->frames; frame++) {
        fprintf(out, "%d,%.9g,%.9g,", frame, frame * table->dt, table->distance[frame]);
        if (table->shifted != NULL && !isnan(table->shifted[frame])) fprintf(out, "%.9g", table->shifted[frame]);
        fputc('\n', out);
    }
}

bool distance_table_write(const DistanceTable *table, const char *path, Error *error) {
    return file_write_text(path, print_table, table, error);
}
