/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Verdicts on runs: of simulate, of stored ones for check and import, and as JSON. */
#include "cli/judge.h"

#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "cli/notes.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

#include <math.h>
#include <string.h>

Trajectory *simulate_judged(const Scene *scene, const Method *method, const Progress *progress, Error *error) {
    SimulateVerdict verdict;
    char words[TRAJECTORY_VERDICT_SIZE];
    Recorder *recorder = recorder_create(scene, method, error);
    if (recorder == NULL) return NULL;
    const StepObserver observer = {verdict_watch_observe, &verdict.watch};
    const RunWatch watch = {.recorder = recorder, .observers = &observer, .observer_count = 1, .progress = progress};
    Trajectory *run = NULL;
    if (simulate_verdict_begin(&verdict, scene, method, error) && simulate_watched(scene, method, &watch, error) &&
        simulate_verdict_end(&verdict, error)) {
        run = recorder_take(recorder);
        simulate_verdict_words(&verdict, words);
        trajectory_judge(run, words, verdict.reading.frame, verdict.reading.body);
    }
    simulate_verdict_free(&verdict);
    recorder_destroy(recorder);
    return run;
}

bool judged_run_find(JudgedRun *judged, const Trajectory *run, const JudgeOptions *options, Error *error) {
    *judged = (JudgedRun){0};
    Scene *scene =
        options->scene != NULL ? scene_read_with(options->scene, options->set.items, options->set.count, error) : NULL;
    const bool ok = (scene != NULL || options->scene == NULL) &&
                    simulate_verdict_of_run(&judged->verdict, run, scene, options->skin, error);
    if (ok) simulate_verdict_words(&judged->verdict, judged->words);
    scene_destroy(scene);
    return ok;
}

void judged_run_print(const JudgedRun *judged, const JudgeOptions *options) {
    const VerdictReading *reading = &judged->verdict.reading;
    printf("    verdict: %s\n    deepest overlap: %.3g m\n", judged->words, reading->deepest);
    if (!isnan(reading->drift))
        printf("    drift after the first %.3g s: %.3g m\n", VERDICT_DRIFT_UNITS * judged->verdict.watch.unit,
               reading->drift);
    if (isnan(reading->excess))
        printf("    energy gained: unknown without masses\n");
    else
        printf("    energy gained: %.3g J above what start and bomb brought\n", reading->excess);
    if (judged->verdict.watch.run.masses_unknown)
        note_print("assumed: bodies of %g kg/m2 and a gravity of %g m/s2; with --scene SCENE they are the scene's",
                   (double)VERDICT_DENSITY, (double)VERDICT_GRAVITY);
    else if (options->scene == NULL)
        note_print("assumed: a gravity of %g m/s2; with --scene SCENE it is the scene's", (double)VERDICT_GRAVITY);
}

void judged_run_free(JudgedRun *judged) { simulate_verdict_free(&judged->verdict); }

/* What the value is. */
static const char *quantity(const VerdictReading *reading) {
    switch (reading->verdict) {
    case VERDICT_FALLS:
    case VERDICT_COLLAPSES: return "bodies that fell";
    case VERDICT_HANGS: return "time in the air";
    case VERDICT_SINKS: return "penetration";
    case VERDICT_TUNNELS: return "speed";
    case VERDICT_EXPLODES:
        return strcmp(reading->unit, "J") == 0 ? "energy gained" : "speed of a body that bursts away";
    case VERDICT_NON_FINITE:
    case VERDICT_ADAPTER_FAILED: return "highest speed before";
    default: return "speed of the fastest body at the end";
    }
}

void simulate_verdict_put(const SimulateVerdict *verdict, JsonWriter *json, const char *key) {
    const VerdictWatch *watch = &verdict->watch;
    const VerdictReading *reading = &verdict->reading;
    const VerdictCount *count = &reading->count;
    char words[TRAJECTORY_VERDICT_SIZE];
    simulate_verdict_words(verdict, words);
    json_begin_object(json, key, JSON_LINES);
    json_put_text(json, "format", "twinbox simulate verdict 1");
    json_put_text(json, "scene", verdict->scene);
    json_put_text(json, "method", verdict->method);
    json_put_int(json, "steps", reading->steps);
    json_put_number(json, "dt", (double)watch->run.dt);
    json_put_text(json, "verdict", verdict_name(reading->verdict));
    json_put_text(json, "words", words);
    json_put_bool(json, "holds", verdict_holds(reading->verdict));
    json_put_bool(json, "sound", verdict_sound(reading->verdict));
    json_put_int(json, "frame", reading->frame);
    json_put_number(json, "time", reading->frame * (double)watch->run.dt);
    if (!json_put_absent(json, "body", reading->body < 0)) json_put_int(json, "body", reading->body);
    json_put_text(json, "quantity", quantity(reading));
    json_put_number(json, "value", reading->value);
    json_put_text(json, "unit", reading->unit);
    if (reading->reason[0] != '\0') json_put_text(json, "reason", reading->reason);
    json_put_int(json, "bodies", count->bodies);
    json_begin_array(json, "fallen", JSON_ONE_LINE);
    for (int i = 0; i < watch->body_count; i++)
        if (verdict_watch_fell(watch, i)) json_put_int(json, NULL, i);
    json_end(json);
    json_put_int(json, "left", count->left);
    json_put_int(json, "moved", count->moved);
    json_put_number(json, "farthest", count->farthest);
    if (!json_put_absent(json, "at_rest", reading->too_short)) json_put_bool(json, "at_rest", !reading->moving);
    if (!json_put_absent(json, "rest_since", reading->moving))
        json_put_number(json, "rest_since", reading->since * (double)watch->run.dt);
    json_put_number(json, "energy", reading->energy);
    json_put_number(json, "available", watch->available - watch->least);
    json_put_number(json, "drift", reading->drift);
    json_put_number(json, "gained", reading->gained);
    json_put_number(json, "deepest", reading->deepest);
    json_put_number(json, "excess", reading->excess);
    json_end(json);
}

static void print_json(FILE *out, const void *context) {
    JsonWriter json = {.out = out};
    simulate_verdict_put(context, &json, NULL);
}

bool simulate_verdict_write(const SimulateVerdict *verdict, const char *path, Error *error) {
    return file_write_text(path, print_json, verdict, error);
}
