/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "paper/systems/gns_rollout.h"

#include "particles_training/gns_training.h"
#include "simulate/gns.h"
#include "simulate/simulate.h"
#include "study/meter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const double gns_times[GNS_TIMES] = {0.25, 0.5, 0.75, 1, 1.5, 2, 3, 4, 5};

static const double far_enough = 0.5; /* m, as in charts (run_log_moved) */

typedef struct Rollouts {
    const Scene *scene;
    Stepper *teacher;
    World *taught, *learned;
    void *gns;
    bool broken; /* gns came to a state that is NaN or infinite */
    Vec2 *start; /* [2, bodies] places at the launch: of the teacher's run, of gns's */
    int64_t nanoseconds;
} Rollouts;

static bool begin(Rollouts *runs, const char *network, const char *settings, Error *error) {
    Settings given;
    Method teacher;
    runs->start = calloc(2 * (size_t)(runs->scene->body_count + 1), sizeof *runs->start);
    if (runs->start == NULL) return error_memory(error, runs->scene->name);
    if (!settings_parse(&given, settings, stepping_gns.description.settings, "gns", error)) return false;
    if (!settings_default(&given, "network", network))
        return error_input(error, network, "the name is too long for a setting");
    runs->gns = stepping_gns.create(&given, runs->scene, error);
    if (runs->gns == NULL || !method_parse(&teacher, gns_teacher, error)) return false;
    runs->teacher = stepper_create(&teacher, runs->scene, error);
    runs->taught = scene_world(runs->scene, error);
    runs->learned = scene_world(runs->scene, error);
    return runs->teacher != NULL && runs->taught != NULL && runs->learned != NULL;
}

static void end(Rollouts *runs) {
    if (runs->gns != NULL) stepping_gns.destroy(runs->gns);
    stepper_destroy(runs->teacher);
    world_destroy(runs->taught);
    world_destroy(runs->learned);
    free(runs->start);
}

/* A failed step of gns leaves the world as it was, from then on. */
static bool step_learned(Rollouts *runs, int frame, Error *error) {
    Error failure = {0};
    StepMeter meter = {.now = meter_time};
    const Step step = {runs->scene, frame, &meter};
    if (!runs->broken) runs->broken = !stepping_gns.step(runs->gns, runs->learned, &step, &failure);
    if (failure.kind != ERROR_NONE && failure.kind != ERROR_INPUT) return *error = failure, false;
    runs->nanoseconds += meter.solving;
    return frame != runs->scene->bomb.frame || scene_add_bomb(runs->scene, runs->learned, error);
}

static double mean_distance(const Rollouts *runs) {
    const Body *a = world_bodies(runs->taught), *b = world_bodies(runs->learned);
    double sum = 0;
    int count = 0;
    for (int i = 0; i < world_body_count(runs->taught); i++) {
        if (!(a[i].inv_mass > 0)) continue;
        sum += vec2_distance(a[i].position, b[i].position);
        count++;
    }
    return count > 0 ? sum / count : 0;
}

static void note_start(Rollouts *runs) {
    const int count = runs->scene->body_count;
    for (int i = 0; i < count; i++) {
        runs->start[i] = world_bodies(runs->taught)[i].position;
        runs->start[count + i] = world_bodies(runs->learned)[i].position;
    }
}

static double count_moved(const World *world, const Vec2 *start, int count) {
    int moved = 0;
    for (int i = 0; i < count; i++)
        moved += vec2_distance(world_bodies(world)[i].position, start[i]) > far_enough ? 1 : 0;
    return moved;
}

/* Fills the times that have come; all others too after the last frame. */
static void note_times(GnsRollout *rollout, const Rollouts *runs, int frame, int last, int *time) {
    const double seconds = (double)(frame - runs->scene->bomb.frame) * (double)runs->scene->dt;
    const double half = 0.5 * (double)runs->scene->dt;
    for (; *time < GNS_TIMES && (frame == last || seconds >= gns_times[*time] - half); ++*time) {
        rollout->error[*time] = mean_distance(runs);
        rollout->shape[*time] = (double)gns_shape_distance(runs->gns);
    }
}

static bool run(Rollouts *runs, GnsRollout *rollout, Error *error) {
    const Scene *scene = runs->scene;
    const int bodies = scene->body_count;
    int last = scene->bomb.frame + (int)lround(gns_times[GNS_TIMES - 1] / (double)scene->dt), time = 0;
    if (last > scene->frames) last = scene->frames;
    if (scene->bomb.frame == 0) note_start(runs);
    for (int frame = 1; frame <= last; frame++) {
        const Step step = {.scene = scene, .frame = frame};
        if (!simulate_step(runs->teacher, runs->taught, &step, error) || !step_learned(runs, frame, error))
            return false;
        if (frame == scene->bomb.frame) note_start(runs);
        if (frame > scene->bomb.frame) note_times(rollout, runs, frame, last, &time);
    }
    for (int i = 0; i < world_body_count(runs->taught); i++)
        rollout->boxes += world_bodies(runs->taught)[i].inv_mass > 0;
    rollout->moved_teacher = count_moved(runs->taught, runs->start, bodies);
    rollout->moved = count_moved(runs->learned, runs->start + bodies, bodies);
    rollout->seconds_a_step = 1e-9 * (double)runs->nanoseconds / last;
    return true;
}

bool gns_rollout_run(GnsRollout *rollout, const Scene *launched, const char *network, const char *settings,
                     Error *error) {
    Rollouts runs = {.scene = launched};
    *rollout = (GnsRollout){.boxes = 0};
    const bool ok = begin(&runs, network, settings, error) && run(&runs, rollout, error);
    end(&runs);
    return ok;
}
