/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where two runs part: the growth of their distance, and chaos, measured with a shifted run. */
#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <gsl/gsl_fit.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void chaos_free(Chaos *chaos) {
    free(chaos->distance);
    *chaos = (Chaos){.frames = 0};
}

static double shift_x(float *x) {
    float before = *x;
    *x = before + CHAOS_SHIFT;
    if (*x == before) *x = nextafterf(before, INFINITY);
    return (double)*x - before;
}

/* Whether the body has a contact in any step up to the frame. */
static bool touches(const Trajectory *run, int body, int frame) {
    for (int64_t i = 0; i < run->contact_start[frame + 1]; i++)
        if (run->contacts[i].a == body || run->contacts[i].b == body) return true;
    return false;
}

int chaos_body(const Trajectory *run, int diverged, int frame) {
    bool dynamic = diverged >= 0 && !run->fixed[diverged];
    if (run->bomb >= 0 && (!dynamic || touches(run, run->bomb, frame))) return run->bomb;
    if (run->bomb >= 0) return diverged;
    int body = run->bodies - 1;
    while (body >= 0 && run->fixed[body]) body--;
    return body;
}

/* Copies the scene; the caller frees shifted->bodies. Only the position changes: an aimed bomb keeps its velocity. */
static bool shifted_scene(const Scene *scene, int body, Scene *shifted, Chaos *chaos, Error *error) {
    *shifted = *scene;
    size_t size = (size_t)scene->body_count * sizeof *scene->bodies;
    shifted->bodies = malloc(size + 1);
    if (shifted->bodies == NULL) return error_memory(error, scene->name);
    if (size > 0) memcpy(shifted->bodies, scene->bodies, size);
    shifted->bomb.velocity = scene_bomb_body(scene).velocity;
    shifted->bomb.velocity_from_position = false;
    chaos->body = body;
    chaos->shift = shift_x(body == scene->body_count ? &shifted->bomb.x.value : &shifted->bodies[body].position.x);
    return true;
}

typedef struct Watch {
    Chaos *chaos;
    const Trajectory *unshifted;
    ProgressStage stage;
} Watch;

static bool divergence_measure(void *context, int frame, const World *world, Error *error) {
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

static bool run_shifted(const Scene *scene, const Method *method, Watch *watch, Error *error) {
    const StepObserver observer = {divergence_measure, watch};
    Chaos *chaos = watch->chaos;
    for (int frame = 0; frame < chaos->frames; frame++) chaos->distance[frame] = NAN;
    chaos->distance[0] = trajectory_has(watch->unshifted, 0, chaos->body) ? chaos->shift : 0;
    Error failure = {0};
    /* A run that ends in a NaN or infinite state is a valid result. */
    if (simulate_observed(scene, method, &observer, &failure) || failure.failure != FAILURE_NONE) return true;
    *error = failure;
    return false;
}

static bool run_and_measure(Chaos *chaos, const Scene *scene, const Method *method, const Trajectory *unshifted,
                            const Trajectory *run, int body, const Progress *progress, Error *error) {
    TrajectoryDifference difference;
    trajectory_compare(unshifted, run, &difference);
    if (difference.frame < 0 && unshifted->bodies != run->bodies)
        return error_input(error, scene->name, "is not the scene of the run: %s", difference.what);
    chaos->rerun_differs = difference.frame;
    Scene shifted;
    if (!shifted_scene(scene, body, &shifted, chaos, error)) return false;
    Watch watch = {chaos, unshifted, {progress, 0.5, 0.5, false}};
    bool ok = run_shifted(&shifted, method, &watch, error);
    free(shifted.bodies);
    return ok;
}

static bool run_both(Chaos *chaos, const Scene *scene, const Trajectory *run, int body, const Progress *progress,
                     Error *error) {
    Method method;
    if (!method_parse(&method, run->method, error)) return false;
    ProgressStage first = {progress, 0, 0.5, false};
    Trajectory *unshifted = simulate(scene, &method, &(Progress){progress_stage, &first}, error);
    bool ok = unshifted != NULL && run_and_measure(chaos, scene, &method, unshifted, run, body, progress, error);
    trajectory_destroy(unshifted);
    return ok;
}

static bool run_scene(Chaos *chaos, Scene *scene, const char *path, const Trajectory *run, int body, int frames,
                      const Progress *progress, Error *error) {
    uint64_t hash = scene_hash(scene);
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
