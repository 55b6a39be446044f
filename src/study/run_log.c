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
    free(log->bomb);
    *log = (RunLog){0};
}

bool run_log_begin(RunLog *log, const Scene *scene, const World *world) {
    size_t rows = (size_t)scene->frames + 1;
    log->bodies = scene->body_count;
    log->touch = log->fallen_back = 0;
    log->momentum_error = 0;
    log->launch_frame = scene->bomb.frame < scene->frames ? scene->bomb.frame : scene->frames;
    double end = log->launch_frame + moved_after / (double)scene->dt;
    log->end_frame = end < scene->frames ? (int)lround(end) : scene->frames;
    if (!array_reserve((void **)&log->position, &log->position_capacity, rows * (size_t)log->bodies, sizeof(Vec2)) ||
        !array_reserve((void **)&log->energy, &log->energy_capacity, rows, sizeof(double)) ||
        !array_reserve((void **)&log->penetration, &log->penetration_capacity, rows, sizeof(double)) ||
        !array_reserve((void **)&log->phase, &log->phase_capacity, rows, sizeof(Phase)) ||
        !array_reserve((void **)&log->bomb, &log->bomb_capacity, rows, sizeof(Vec2)))
        return false;
    run_log_step(log, scene, world, 0, PHASE_REST);
    return true;
}

static bool fell_back(const NetworkFallbacks *step) {
    return step->not_finite + step->beyond_training + step->by_sweeps > 0;
}

void run_log_step(RunLog *log, const Scene *scene, const World *world, int frame, Phase phase) {
    log->frames = frame;
    if (phase == PHASE_IMPACT && log->touch == 0) log->touch = frame;
    for (int i = 0; i < log->bodies; i++)
        log->position[(size_t)frame * (size_t)log->bodies + (size_t)i] = world_bodies(world)[i].position;
    log->energy[frame] = world_energy(world, scene->gravity);
    log->penetration[frame] = world_penetration(world);
    log->phase[frame] = phase;
    log->bomb[frame] = world_body_count(world) > log->bodies ? world_bodies(world)[log->bodies].position : vec2(0, 0);
    log->momentum_error += (double)world_solution(world)->momentum_error;
    log->fallen_back += fell_back(&world_solution(world)->fallbacks);
}

static double distance_apart(const RunLog *log, const RunLog *other, int frame) {
    const size_t row = (size_t)frame * (size_t)log->bodies;
    double apart = vec2_distance(log->bomb[frame], other->bomb[frame]);
    for (int i = 0; i < log->bodies; i++)
        apart = fmax(apart, vec2_distance(log->position[row + (size_t)i], other->position[row + (size_t)i]));
    return apart;
}

int run_log_apart(const RunLog *log, const RunLog *other, double limit, int frames) {
    for (int frame = 1; frame <= frames; frame++)
        if (frame > log->frames || (frame <= other->frames && distance_apart(log, other, frame) > limit)) return frame;
    return frames;
}

double run_log_moved(const RunLog *log, const Scene *scene) {
    int moved = 0;
    const Vec2 *before = log->position + (size_t)log->launch_frame * (size_t)log->bodies;
    const Vec2 *after = log->position + (size_t)log->end_frame * (size_t)log->bodies;
    for (int i = 0; i < log->bodies; i++) {
        if (scene->bodies[i].fixed) continue;
        moved += log->frames < log->end_frame || vec2_distance(before[i], after[i]) > moved_distance;
    }
    return moved;
}

static double mean_distance(const RunLog *log, const RunLog *other, const Scene *scene, int frame) {
    double sum = 0;
    int count = 0;
    size_t row = (size_t)frame * (size_t)log->bodies;
    for (int i = 0; i < log->bodies; i++) {
        if (scene->bodies[i].fixed) continue;
        sum += vec2_distance(log->position[row + (size_t)i], other->position[row + (size_t)i]);
        count++;
    }
    return count > 0 ? sum / count : NAN;
}

RunMeasures run_measures(const RunLog *log, const RunLog *converged, const Scene *scene) {
    RunMeasures measures = {.drift = NAN, .moved = run_log_moved(log, scene)};
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
