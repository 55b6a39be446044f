/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy of a converged run, and runs that are judged beside it. */
#include "studies/converged.h"

#include "base/base.h"
#include "base/hash.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/runs.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>

void energy_log_free(EnergyLog *log) {
    free(log->energy);
    *log = (EnergyLog){0};
}

static bool log_energy(void *context, int frame, const World *world, Error *error) {
    EnergyLog *log = context;
    (void)error;
    if (frame > 0) fallbacks_add(&log->fallbacks, &world_solution(world)->fallbacks);
    if (log->unconverged == 0 && log->fallbacks.not_converged > 0) log->unconverged = frame;
    const Vec2 gravity = log->gravity;
    const double pull = vec2_distance(gravity, vec2(0, 0));
    log->energy[frame] = 0;
    for (int pass = frame == 0 ? 0 : 1; log->unconverged == 0 && pass < 2; pass++)
        for (int i = 0; i < world_body_count(world); i++) {
            const Body *body = &world_bodies(world)[i];
            if (body->inv_mass == 0) continue;
            const double up = pull > 0 ? -vec2_dot(body->position, gravity) / pull : 0;
            if (pass == 0 || isinf(log->lowest)) log->lowest = fmin(log->lowest, up);
            if (pass == 0) continue;
            log->energy[frame] += body_energy(body, gravity);
            log->liveliest =
                fmax(log->liveliest, body_energy(body, vec2(0, 0)) * body->inv_mass + pull * (up - log->lowest));
        }
    return true;
}

bool energy_log_run(EnergyLog *log, const Scene *scene, const Method *method, Error *error) {
    if (!array_reserve((void **)&log->energy, &log->capacity, (size_t)scene->frames + 1, sizeof *log->energy))
        return error_memory(error, "energy log");
    *log = (EnergyLog){.frames = scene->frames,
                       .energy = log->energy,
                       .capacity = log->capacity,
                       .gravity = scene->gravity,
                       .lowest = INFINITY};
    World *start = scene_world(scene, error);
    const bool ok = start != NULL && log_energy(log, 0, start, error);
    world_destroy(start);
    return ok && simulate_observed(scene, method, &(StepObserver){log_energy, log}, error);
}

/* A body has no padding: eleven floats. */
static uint64_t hash_bodies(const Body *bodies, int count) {
    return count > 0 ? hash_fnv1a64(FNV1A64_START, bodies, (size_t)count * sizeof *bodies) : FNV1A64_START;
}

bool verdict_run(VerdictReading *reading, const Scene *scene, const Method *method, const VerdictRun *run,
                 Error *error) {
    VerdictWatch watch = {0};
    World *world = scene_world(scene, error);
    Stepper *stepper = world != NULL ? stepper_create(method, scene, error) : NULL;
    bool ok = stepper != NULL && verdict_watch_begin(&watch, run, world_bodies(world), world_body_count(world), error);
    for (int frame = 1; ok && frame <= scene->frames && !verdict_watch_is_final(&watch); frame++) {
        Error failure = {0};
        if (simulate_step(stepper, world, &(Step){.scene = scene, .frame = frame}, &failure)) {
            ok = verdict_watch_observe(&watch, frame, world, error);
        } else if (failure.failure != FAILURE_NONE) { /* a method that fails is a result */
            fallbacks_add(&watch.fallbacks, &world_solution(world)->fallbacks);
            verdict_watch_failed(&watch, frame, &failure);
        } else {
            *error = failure;
            ok = false;
        }
    }
    if (ok) {
        *reading = verdict_watch_end(&watch);
        reading->state = hash_bodies(world_bodies(world), world_body_count(world));
        reading->steps = watch.frame;
    }
    verdict_watch_free(&watch);
    stepper_destroy(stepper);
    world_destroy(world);
    return ok;
}
