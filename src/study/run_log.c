/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study/run_log.h"

#include "common/array.h"
#include "study/world_measures.h"

#include <math.h>
#include <stdlib.h>

static const double moved_distance = 0.5; /* m: half a box */
static const double moved_after = 5;      /* s */

void run_log_free(RunLog *log) {
    free(log->position);
    free(log->energy);
    free(log->penetration);
    free(log->phase);
    *log = (RunLog){0};
}

bool run_log_begin(RunLog *log, const Scene *scene, const World *world) {
    size_t rows = (size_t)scene->frames + 1;
    log->bodies = scene->body_count;
    log->touch = 0;
    log->launch_frame = scene->bomb.frame < scene->frames ? scene->bomb.frame : scene->frames;
    double end = log->launch_frame + moved_after / (double)scene->dt;
    log->end_frame = end < scene->frames ? (int)lround(end) : scene->frames;
    if (!array_reserve((void **)&log->position, &log->position_capacity, rows * (size_t)log->bodies, sizeof(Vec2)) ||
        !array_reserve((void **)&log->energy, &log->energy_capacity, rows, sizeof(double)) ||
        !array_reserve((void **)&log->penetration, &log->penetration_capacity, rows, sizeof(double)) ||
        !array_reserve((void **)&log->phase, &log->phase_capacity, rows, sizeof(Phase)))
        return false;
    run_log_step(log, scene, world, 0, PHASE_REST);
    return true;
}

void run_log_step(RunLog *log, const Scene *scene, const World *world, int frame, Phase phase) {
    log->frames = frame;
    if (phase == PHASE_IMPACT && log->touch == 0) log->touch = frame;
    for (int i = 0; i < log->bodies; i++)
        log->position[(size_t)frame * (size_t)log->bodies + (size_t)i] = world_bodies(world)[i].position;
    log->energy[frame] = world_energy(world, scene->gravity);
    log->penetration[frame] = world_penetration(world);
    log->phase[frame] = phase;
}

static double distance(const Vec2 *a, const Vec2 *b) { return hypot((double)(a->x - b->x), (double)(a->y - b->y)); }

/* If the run ended early (NaN or infinite), all boxes count as moved. */
static double count_moved(const RunLog *log, const Scene *scene) {
    int moved = 0;
    const Vec2 *before = log->position + (size_t)log->launch_frame * (size_t)log->bodies;
    const Vec2 *after = log->position + (size_t)log->end_frame * (size_t)log->bodies;
    for (int i = 0; i < log->bodies; i++) {
        if (scene->bodies[i].fixed) continue;
        moved += log->frames < log->end_frame || distance(&before[i], &after[i]) > moved_distance;
    }
    return moved;
}

static double mean_distance(const RunLog *log, const RunLog *other, const Scene *scene, int frame) {
    double sum = 0;
    int count = 0;
    size_t row = (size_t)frame * (size_t)log->bodies;
    for (int i = 0; i < log->bodies; i++) {
        if (scene->bodies[i].fixed) continue;
        sum += distance(&log->position[row + (size_t)i], &other->position[row + (size_t)i]);
        count++;
    }
    return count > 0 ? sum / count : NAN;
}

RunMeasures run_measures(const RunLog *log, const RunLog *converged, const Scene *scene) {
    RunMeasures measures = {.drift = NAN, .moved = count_moved(log, scene)};
    int frames[PHASES] = {0}, last = log->frames < converged->frames ? log->frames : converged->frames;
    double energy[PHASES] = {0};
    for (int frame = 1; frame <= last; frame++) {
        Phase phase = log->phase[frame];
        energy[phase] += log->energy[frame] - converged->energy[frame];
        frames[phase]++;
        if (log->penetration[frame] > measures.penetration[phase])
            measures.penetration[phase] = log->penetration[frame];
    }
    for (int phase = 0; phase < PHASES; phase++) {
        measures.energy[phase] = frames[phase] > 0 ? energy[phase] / frames[phase] : NAN;
        if (frames[phase] == 0) measures.penetration[phase] = NAN;
    }
    int rest = converged->touch > 0 ? converged->touch - 1 : last;
    if (log->touch > 0 && log->touch - 1 < rest) rest = log->touch - 1;
    if (rest > 0 && rest <= last) measures.drift = mean_distance(log, converged, scene, rest);
    return measures;
}
