/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdict on one run, in words. */
#include "base/base.h"
#include "engine/engine.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
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
    if (failure->kind != ERROR_NONE && failure->failure == FAILURE_NONE) return false;
    if (failure->kind != ERROR_NONE) verdict_watch_failed(&verdict->watch, verdict->watch.frame + 1, failure);
    verdict->reading = verdict_watch_end(&verdict->watch);
    return true;
}

void simulate_verdict_free(SimulateVerdict *verdict) { verdict_watch_free(&verdict->watch); }

double simulate_verdict_falls(const SimulateVerdict *verdict, double falls) {
    return falls * verdict->watch.fall * (double)verdict->scene->dt;
}

/* "body 7, 0.53 m lower" */
static void write_figure(const SimulateVerdict *verdict, char figure[FIGURE_SIZE]) {
    const VerdictReading *reading = &verdict->reading;
    const double value = reading->value;
    const int body = reading->body;
    const bool turned = strcmp(reading->unit, "deg") == 0, hangs = strcmp(reading->unit, "s") == 0;
    switch (reading->verdict) {
    case VERDICT_MOVES:
        snprintf(figure, FIGURE_SIZE, hangs ? "body %d, in the air for %.3g s" : "body %d at %.3g m/s", body, value);
        return;
    case VERDICT_CREEPS:
        snprintf(figure, FIGURE_SIZE, "body %d, %.3g m in %.3g s", body, value,
                 simulate_verdict_falls(verdict, VERDICT_CREEP_FALLS));
        return;
    case VERDICT_FALLS:
        snprintf(figure, FIGURE_SIZE, turned ? "body %d, rotated by %.3g degrees" : "body %d, %.3g m lower", body,
                 value);
        return;
    case VERDICT_SINKS:
        snprintf(figure, FIGURE_SIZE, "body %d, %.3g m deep for %.3g s", body, value,
                 simulate_verdict_falls(verdict, VERDICT_SINK_TIME));
        return;
    case VERDICT_TUNNELS:
        if (reading->other < 0)
            snprintf(figure, FIGURE_SIZE, "body %d, at %.3g m/s through a static box", body, value);
        else
            snprintf(figure, FIGURE_SIZE, "body %d, at %.3g m/s through body %d", body, value, reading->other);
        return;
    case VERDICT_EXPLODES:
        snprintf(figure, FIGURE_SIZE, "body %d is the most energetic, %.3g J gained", body, value);
        return;
    case VERDICT_NON_FINITE:
        snprintf(figure, FIGURE_SIZE, "a body's state is NaN or infinite; fastest body before: %.3g m/s", value);
        return;
    case VERDICT_ADAPTER_FAILED: snprintf(figure, FIGURE_SIZE, "%s", reading->reason); return;
    default: snprintf(figure, FIGURE_SIZE, "no body above %.3g m/s", value);
    }
}

/* "settles at 0.5 s (...)", "falls at 4.22 s (body 7, 0.53 m lower)" */
static void write_whole(const SimulateVerdict *verdict, char words[TRAJECTORY_VERDICT_SIZE]) {
    const VerdictReading *reading = &verdict->reading;
    char figure[FIGURE_SIZE];
    write_figure(verdict, figure);
    const char *when = reading->verdict != VERDICT_MOVES        ? " at"
                       : reading->frame >= verdict->watch.frame ? ": still at the end,"
                                                                : " until";
    snprintf(words, TRAJECTORY_VERDICT_SIZE, "%s%s %.3g s (%s)", verdict_name(reading->verdict), when,
             reading->frame * (double)verdict->scene->dt, figure);
}

/* "8 of 10 boxes fell, 2 of them out of the scene, first at 1.2 s" */
static void add_fallen(const SimulateVerdict *verdict, const char *between, char words[TRAJECTORY_VERDICT_SIZE]) {
    const VerdictCount *count = &verdict->reading.count;
    if (count->fell == 0) return;
    text_add(words, TRAJECTORY_VERDICT_SIZE, "%s%d of %d box%s fell", between, count->fell, count->stood,
             count->stood == 1 ? "" : "es");
    if (count->left > 0) text_add(words, TRAJECTORY_VERDICT_SIZE, ", %d of them out of the scene", count->left);
    text_add(words, TRAJECTORY_VERDICT_SIZE, ", first at %.3g s", count->first * (double)verdict->scene->dt);
}

/* "collapses: 8 of 10 boxes fell, first at 1.2 s; 1 more moved by 0.3 m" */
static void write_struck(const SimulateVerdict *verdict, char words[TRAJECTORY_VERDICT_SIZE]) {
    const VerdictReading *reading = &verdict->reading;
    const VerdictCount *count = &reading->count;
    snprintf(words, TRAJECTORY_VERDICT_SIZE, "%s", verdict_name(reading->verdict));
    add_fallen(verdict, ": ", words);
    /* What has fallen moved, too, and is not counted again. */
    if (count->moved > 0 && count->fell > 0) text_add(words, TRAJECTORY_VERDICT_SIZE, "; %d more", count->moved);
    if (count->moved > 0 && count->fell == 0)
        text_add(words, TRAJECTORY_VERDICT_SIZE, "; %d of %d", count->moved, count->stood);
    if (count->moved > 0)
        text_add(words, TRAJECTORY_VERDICT_SIZE, " moved by %s%.2g m", count->moved > 1 ? "up to " : "",
                 count->farthest);
    if (reading->moving) text_add(words, TRAJECTORY_VERDICT_SIZE, "; still moves at the end");
}

void simulate_verdict_words(const SimulateVerdict *verdict, char words[TRAJECTORY_VERDICT_SIZE]) {
    const int unconverged = verdict->reading.fallbacks.not_converged;
    if (verdict->reading.struck) {
        write_struck(verdict, words);
    } else {
        write_whole(verdict, words);
        if (verdict->watch.run.struck != NULL) add_fallen(verdict, "; ", words);
    }
    if (unconverged > 0)
        text_add(words, TRAJECTORY_VERDICT_SIZE, "; %d step%s did not converge", unconverged,
                 unconverged == 1 ? "" : "s");
}
