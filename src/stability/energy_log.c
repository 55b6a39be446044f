/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/energy_log.h"

#include "common/array.h"
#include "study/world_measures.h"

#include <math.h>
#include <stdlib.h>

void energy_log_free(EnergyLog *log) {
    free(log->energy);
    *log = (EnergyLog){0};
}

/* m: height along the direction opposite to gravity. */
static double height(const Body *body, Vec2 gravity, double pull) {
    return -((double)body->position.x * gravity.x + (double)body->position.y * gravity.y) / pull;
}

/* Adds the potential energy of new bodies. The first dynamic bodies determine the lowest height. */
static void add_potential(EnergyLog *log, const Body *bodies, int count) {
    double pull = hypot((double)log->gravity.x, (double)log->gravity.y), lowest = INFINITY;
    if (pull == 0) return;
    for (int i = 0; i < count; i++)
        if (bodies[i].inv_mass != 0) lowest = fmin(lowest, height(&bodies[i], log->gravity, pull));
    if (isinf(log->lowest)) log->lowest = lowest;
    for (int i = 0; i < count; i++)
        if (bodies[i].inv_mass != 0)
            log->potential += fmax(0, height(&bodies[i], log->gravity, pull) - log->lowest) * pull / bodies[i].inv_mass;
    log->available = fmax(log->available, log->potential);
}

bool energy_log_begin(EnergyLog *log, Vec2 gravity, int frames, const Body *bodies, int count, Error *error) {
    if (!array_reserve((void **)&log->energy, &log->capacity, (size_t)frames + 1, sizeof *log->energy))
        return error_memory(error, "energy log");
    log->gravity = gravity;
    log->frames = frames;
    log->energy[0] = log->level = bodies_energy(bodies, count, gravity);
    log->available = log->potential = 0;
    log->lowest = INFINITY;
    log->body_count = count;
    add_potential(log, bodies, count);
    return true;
}

void energy_log_step(EnergyLog *log, int frame, const Body *bodies, int count) {
    double energy = bodies_energy(bodies, count, log->gravity);
    if (count > log->body_count) {
        log->level += bodies_energy(bodies + log->body_count, count - log->body_count, log->gravity);
        add_potential(log, bodies + log->body_count, count - log->body_count);
    }
    /* The energy of removed bodies is no longer known: the step that removes them counts as one without losses. */
    if (count < log->body_count) log->level += energy - log->energy[frame - 1];
    if (energy > log->level) log->level = energy;
    if (log->level - energy > log->available) log->available = log->level - energy;
    log->energy[frame] = energy;
    log->body_count = count;
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
