/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/energy_log.h"

#include "common/array.h"

#include <stdlib.h>

void energy_log_free(EnergyLog *log) {
    free(log->energy);
    *log = (EnergyLog){0};
}

bool energy_log_begin(EnergyLog *log, Vec2 gravity, int frames, const Body *bodies, int count, Error *error) {
    if (!array_reserve((void **)&log->energy, &log->capacity, (size_t)frames + 1, sizeof *log->energy))
        return error_memory(error, "energy log");
    log->frames = frames;
    energy_balance_begin(&log->balance, gravity, bodies, count);
    log->energy[0] = log->balance.energy;
    return true;
}

void energy_log_step(EnergyLog *log, int frame, const Body *bodies, int count) {
    energy_balance_step(&log->balance, bodies, count);
    log->energy[frame] = log->balance.energy;
}

static bool observe(void *context, int frame, const World *world, Error *error) {
    (void)error;
    energy_log_step(context, frame, world_bodies(world), world_body_count(world));
    return true;
}

bool energy_log_run(EnergyLog *log, const Scene *scene, const Method *method, Error *error) {
    World *start = scene_world(scene, error);
    bool ok = start != NULL &&
              energy_log_begin(log, scene->gravity, scene->frames, world_bodies(start), world_body_count(start), error);
    world_destroy(start);
    return ok && simulate_observed(scene, method, &(StepObserver){observe, log}, error);
}
