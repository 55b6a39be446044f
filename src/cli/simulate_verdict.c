/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/simulate_verdict.h"

#include "common/file.h"
#include "common/text_add.h"
#include "simulate/recorder.h"

#include <stdio.h>
#include <string.h>

enum { FIGURE_SIZE = 160 };

bool simulate_verdict_begin(SimulateVerdict *verdict, const Scene *scene, const char *method, Error *error) {
    *verdict = (SimulateVerdict){.scene = scene, .method = method};
    const VerdictRun run = verdict_run_of(scene);
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
    if (failure->kind != ERROR_NONE && !verdict_is_non_finite(failure)) return false;
    if (failure->kind != ERROR_NONE) verdict_watch_failed(&verdict->watch, verdict->watch.frame + 1);
    verdict->reading = verdict_watch_end(&verdict->watch);
    return true;
}

void simulate_verdict_free(SimulateVerdict *verdict) { verdict_watch_free(&verdict->watch); }

/* The dynamic bodies but the bomb, and how many of them have fallen. */
static int count_bodies(const SimulateVerdict *verdict, int *fallen) {
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
    default: snprintf(figure, FIGURE_SIZE, "kinetic energy %.3g J per body", value);
    }
}

void simulate_verdict_words(const SimulateVerdict *verdict, char words[TRAJECTORY_VERDICT_SIZE]) {
    const VerdictReading *reading = &verdict->reading;
    const double time = reading->frame * (double)verdict->scene->dt;
    char figure[FIGURE_SIZE];
    int fallen;
    const int count = count_bodies(verdict, &fallen);
    write_figure(verdict, figure);
    const char *when = reading->verdict != VERDICT_SWAYS ? "at" : runs_to_the_end(verdict) ? "to the end," : "until";
    snprintf(words, TRAJECTORY_VERDICT_SIZE, "%s %s %.3g s (%s)", verdict_name(reading->verdict), when, time, figure);
    if (!verdict->watch.run.stands && fallen > 0)
        text_add(words, TRAJECTORY_VERDICT_SIZE, "; %d of %d bodies have fallen", fallen, count);
}

void simulate_verdict_print(const SimulateVerdict *verdict) {
    char words[TRAJECTORY_VERDICT_SIZE];
    simulate_verdict_words(verdict, words);
    printf("    verdict: %s\n", words);
}

Trajectory *simulate_judged(const Scene *scene, const Method *method, const Progress *progress, Error *error) {
    SimulateVerdict verdict;
    char words[TRAJECTORY_VERDICT_SIZE];
    Recorder *recorder = recorder_create(scene, method, error);
    if (recorder == NULL) return NULL;
    const StepObserver observer = simulate_verdict_observer(&verdict);
    const RunWatch watch = {.recorder = recorder, .observers = &observer, .observer_count = 1, .progress = progress};
    Trajectory *run = NULL;
    if (simulate_verdict_begin(&verdict, scene, method->text, error) &&
        simulate_watched(scene, method, &watch, error) && simulate_verdict_end(&verdict, error)) {
        run = recorder_take(recorder);
        simulate_verdict_words(&verdict, words);
        trajectory_judge(run, words, verdict.reading.frame, verdict.reading.body);
    }
    simulate_verdict_free(&verdict);
    recorder_destroy(recorder);
    return run;
}

/* What the value is. */
static const char *quantity(const VerdictReading *reading) {
    static const char *const quantities[VERDICTS] = {
        [VERDICT_SETTLES] = "mean kinetic energy of a body",
        [VERDICT_SWAYS] = "mean kinetic energy of a body",
        [VERDICT_CREEPS] = "distance in 10 s",
        [VERDICT_SINKS] = "penetration",
        [VERDICT_TUNNELS] = "speed",
        [VERDICT_EXPLODES] = "energy gained",
        [VERDICT_NON_FINITE] = "highest speed before",
    };
    if (reading->verdict == VERDICT_FALLS) return strcmp(reading->unit, "deg") == 0 ? "rotation" : "descent";
    return quantities[reading->verdict];
}

static void write_fallen(const SimulateVerdict *verdict, JsonWriter *json) {
    int fallen;
    json_put_int(json, "bodies", count_bodies(verdict, &fallen));
    json_begin_array(json, "fallen", JSON_ONE_LINE);
    for (int i = 0; i < verdict->scene->body_count && i < verdict->watch.body_count; i++)
        if (verdict->watch.bodies[i].fallen) json_put_int(json, NULL, i);
    json_end(json);
}

static void write_reading(const SimulateVerdict *verdict, JsonWriter *json) {
    const VerdictReading *reading = &verdict->reading;
    json_put_text(json, "verdict", verdict_name(reading->verdict));
    json_put_bool(json, "holds", verdict_holds(reading->verdict));
    json_put_int(json, "frame", reading->frame);
    json_put_number(json, "time", reading->frame * (double)verdict->scene->dt);
    if (reading->body >= 0)
        json_put_int(json, "body", reading->body);
    else
        json_put_text(json, "body", NULL);
    json_put_text(json, "quantity", quantity(reading));
    json_put_number(json, "value", reading->value);
    json_put_text(json, "unit", reading->unit);
}

void simulate_verdict_put(const SimulateVerdict *verdict, JsonWriter *json, const char *key) {
    const VerdictWatch *watch = &verdict->watch;
    json_begin_object(json, key, JSON_LINES);
    json_put_text(json, "format", "twinbox simulate verdict 1");
    json_put_text(json, "scene", verdict->scene->name);
    json_put_text(json, "method", verdict->method);
    json_put_int(json, "steps", watch->frame);
    json_put_number(json, "dt", (double)verdict->scene->dt);
    write_reading(verdict, json);
    json_put_text(json, "falls_judged",
                  watch->run.stands       ? "to the end"
                  : watch->run.until_bomb ? "until the bomb touches"
                                          : "no");
    write_fallen(verdict, json);
    json_put_number(json, "kinetic", watch->kinetic);
    json_put_number(json, "energy", watch->energy);
    json_put_number(json, "available", watch->own.available);
    json_put_number(json, "drift", verdict->reading.drift);
    json_put_number(json, "gained", verdict->reading.gained);
    json_end(json);
}

static void write_json(FILE *out, const void *context) {
    JsonWriter json = {.out = out};
    simulate_verdict_put(context, &json, NULL);
}

bool simulate_verdict_write(const SimulateVerdict *verdict, const char *path, Error *error) {
    return file_write_text(path, write_json, verdict, error);
}
