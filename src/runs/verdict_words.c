/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdict on one run, in words. */
#include "base/base.h"
#include "engine/engine.h"
#include "runs/runs.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

#include <stdio.h>
#include <string.h>

enum { FIGURE_SIZE = VERDICT_REASON_SIZE };

bool simulate_verdict_begin(SimulateVerdict *verdict, const Scene *scene, const Method *method, Error *error) {
    *verdict = (SimulateVerdict){.scene = scene, .method = method->text};
    VerdictRun run = verdict_run_of(scene);
    verdict_run_set_engine(&run, method);
    World *start = scene_world(scene, error);
    bool ok = start != NULL &&
              verdict_watch_begin(&verdict->watch, &run, world_bodies(start), world_body_count(start), error);
    world_destroy(start);
    return ok;
}

StepObserver simulate_verdict_observer(SimulateVerdict *verdict) {
    return (StepObserver){verdict_watch_observe, &verdict->watch};
}

bool simulate_verdict_end(SimulateVerdict *verdict, const Error *failure) {
    if (failure->kind != ERROR_NONE && !verdict_is_failure(failure)) return false;
    if (failure->kind != ERROR_NONE) verdict_watch_failed(&verdict->watch, verdict->watch.frame + 1, failure);
    verdict->reading = verdict_watch_end(&verdict->watch);
    return true;
}

void simulate_verdict_free(SimulateVerdict *verdict) { verdict_watch_free(&verdict->watch); }

int simulate_verdict_bodies(const SimulateVerdict *verdict, int *fallen) {
    const Scene *scene = verdict->scene;
    int count = 0;
    *fallen = 0;
    for (int i = 0; i < scene->body_count && i < verdict->watch.body_count; i++) {
        if (scene->bodies[i].fixed) continue;
        count++;
        *fallen += verdict->watch.bodies[i].fallen;
    }
    return count;
}

static bool runs_to_the_end(const SimulateVerdict *verdict) { return verdict->reading.frame >= verdict->watch.frame; }

/* "body 7, 0.53 m lower" */
static void write_figure(const SimulateVerdict *verdict, char figure[FIGURE_SIZE]) {
    const VerdictReading *reading = &verdict->reading;
    const double value = reading->value;
    const int body = reading->body;
    const bool turned = strcmp(reading->unit, "deg") == 0;
    switch (reading->verdict) {
    case VERDICT_CREEPS:
        snprintf(figure, FIGURE_SIZE, "body %d, %.3g m in %d s", body, value, VERDICT_CREEP_SECONDS);
        return;
    case VERDICT_FALLS:
        snprintf(figure, FIGURE_SIZE, turned ? "body %d, rotated by %.3g degrees" : "body %d, %.3g m lower", body,
                 value);
        return;
    case VERDICT_SINKS:
        snprintf(figure, FIGURE_SIZE, "body %d, %.3g m deep for %g s", body, value, VERDICT_SINK_TIME);
        return;
    case VERDICT_TUNNELS:
        snprintf(figure, FIGURE_SIZE, "body %d, at %.3g m/s through a static box", body, value);
        return;
    case VERDICT_EXPLODES:
        snprintf(figure, FIGURE_SIZE, "body %d is the most energetic, %.3g J gained", body, value);
        return;
    case VERDICT_NON_FINITE:
        snprintf(figure, FIGURE_SIZE, "a body's state is NaN or infinite; fastest body before: %.3g m/s", value);
        return;
    case VERDICT_ADAPTER_FAILED: snprintf(figure, FIGURE_SIZE, "%s", reading->reason); return;
    default: snprintf(figure, FIGURE_SIZE, "kinetic energy %.3g J per body", value);
    }
}

void simulate_verdict_words(const SimulateVerdict *verdict, char words[TRAJECTORY_VERDICT_SIZE]) {
    const VerdictReading *reading = &verdict->reading;
    const double time = reading->frame * (double)verdict->scene->dt;
    char figure[FIGURE_SIZE];
    int fallen;
    const int count = simulate_verdict_bodies(verdict, &fallen);
    write_figure(verdict, figure);
    const char *when = reading->verdict != VERDICT_SWAYS ? " at"
                       : runs_to_the_end(verdict)        ? ": still moves at the end,"
                                                         : ": moves until";
    snprintf(words, TRAJECTORY_VERDICT_SIZE, "%s%s %.3g s (%s)", verdict_name(reading->verdict), when, time, figure);
    if (!verdict->watch.run.stands && fallen > 0)
        text_add(words, TRAJECTORY_VERDICT_SIZE, "; %d of %d bodies have fallen", fallen, count);
}
