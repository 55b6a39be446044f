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

static VerdictRun run_of(const Scene *scene, const Method *method) {
    VerdictRun run = {.gravity = scene->gravity,
                      .dt = scene->dt,
                      .bomb = scene_has_launch(scene) ? scene->body_count : -1,
                      .finds_contacts = method->kind->description->whole_scenes};
    const char *text = run.finds_contacts ? settings_get(&method->settings, "skin") : NULL;
    if (text != NULL && !parse_float(text, &run.skin)) run.skin = 0;
    return run;
}

bool simulate_verdict_begin(SimulateVerdict *verdict, const Scene *scene, const Method *method, Error *error) {
    *verdict = (SimulateVerdict){.scene = scene->name, .method = method->text};
    const VerdictRun run = run_of(scene, method);
    World *start = scene_world(scene, error);
    bool ok = start != NULL &&
              verdict_watch_begin(&verdict->watch, &run, world_bodies(start), world_body_count(start), error);
    world_destroy(start);
    return ok;
}

bool simulate_verdict_end(SimulateVerdict *verdict, const Error *failure) {
    if (failure->kind != ERROR_NONE && failure->failure == FAILURE_NONE) return false;
    if (failure->kind != ERROR_NONE) verdict_watch_failed(&verdict->watch, verdict->watch.frame + 1, failure);
    verdict->reading = verdict_watch_end(&verdict->watch);
    return true;
}

void simulate_verdict_free(SimulateVerdict *verdict) { verdict_watch_free(&verdict->watch); }

void simulate_verdict_words(const SimulateVerdict *verdict, char words[TRAJECTORY_VERDICT_SIZE]) {
    enum { SIZE = TRAJECTORY_VERDICT_SIZE };
    const VerdictReading *reading = &verdict->reading;
    const VerdictCount *count = &reading->count;
    const VerdictWatch *watch = &verdict->watch;
    const double dt = (double)watch->run.dt, value = reading->value;
    const int body = reading->body;
    snprintf(words, SIZE, "%s", verdict_name(reading->verdict));
    if (!verdict_sound(reading->verdict)) text_add(words, SIZE, " at %.3g s (", reading->frame * dt);
    if (reading->verdict == VERDICT_HANGS)
        text_add(words, SIZE, "body %d, in the air for %.3g s)", body, value);
    else if (reading->verdict == VERDICT_SINKS)
        text_add(words, SIZE, "body %d, %.3g m deep)", body, value);
    else if (reading->verdict == VERDICT_TUNNELS)
        text_add(words, SIZE, "body %d, at %.3g m/s through body %d)", body, value, reading->other);
    else if (reading->verdict == VERDICT_EXPLODES && strcmp(reading->unit, "J") == 0)
        text_add(words, SIZE, "body %d is the most energetic, %.3g J gained)", body, value);
    else if (reading->verdict == VERDICT_EXPLODES)
        text_add(words, SIZE, "body %d bursts away at %.3g m/s)", body, value);
    else if (reading->verdict == VERDICT_NON_FINITE)
        text_add(words, SIZE, "a body's state is NaN or infinite; fastest body before: %.3g m/s)", value);
    else if (reading->verdict == VERDICT_ADAPTER_FAILED)
        text_add(words, SIZE, "%s)", reading->reason);
    if (reading->verdict >= VERDICT_NON_FINITE) return;
    if (count->fell > 0) {
        text_add(words, SIZE, "; %d of %d fell, first at %.3g s", count->fell, count->bodies, count->first * dt);
        if (reading->by_itself) text_add(words, SIZE, ", before the bomb touched anything");
    }
    if (count->moved > 0) text_add(words, SIZE, "; %d moved by up to %.2g m", count->moved, count->farthest);
    if (count->left > 0) text_add(words, SIZE, "; %d out of the scene", count->left);
    if (watch->run.bomb >= 0 && watch->met < 0) text_add(words, SIZE, "; the bomb touched nothing");
    if (reading->too_short)
        text_add(words, SIZE, "; too short to tell");
    else if (reading->moving)
        text_add(words, SIZE, "; still moving at the end");
    else if (reading->since == 0)
        text_add(words, SIZE, "; at rest throughout");
    else
        text_add(words, SIZE, "; at rest since %.3g s", reading->since * dt);
    const int unconverged = reading->fallbacks.not_converged;
    if (unconverged > 0)
        text_add(words, SIZE, "; %d step%s did not converge", unconverged, unconverged == 1 ? "" : "s");
}
