/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Refuses launches whose bomb would start inside a body, and finds those that strike nothing. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/launch_check.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A launch by its place in the caller's list. */
typedef struct Due {
    int frame, launch;
} Due;

typedef struct Check {
    const Scene *scene;
    const Launch *launches;
    int count;
    Due *due; /* [count] by frame */
    int done; /* of due */
    Box *boxes;
} Check;

static int by_frame(const void *a, const void *b) {
    const Due *left = a, *right = b;
    return left->frame != right->frame ? left->frame - right->frame : left->launch - right->launch;
}

static Box box_of(const Body *body) { return box_make(body->position, body->size, body->angle); }

static Box bomb_box(const Scene *scene, const Launch *launch) {
    return box_make(vec2(launch->x, scene->bomb.y), scene->bomb.size, launch->rotation);
}

static int by_start(const void *a, const void *b) {
    const OverlapSpan *left = a, *right = b;
    return left->from < right->from ? -1 : left->from > right->from;
}

/* Refuses a launch, and names the x that are free. */
static bool refuse(const Check *check, int launch, int body, const Box *bomb, int bodies, Error *error) {
    const Launch *at = &check->launches[launch];
    char which[32] = "the launch", text[400] = "";
    if (check->count > 1) snprintf(which, sizeof which, "launch %d", launch + 1);
    error_input(
        error, check->scene->name,
        "%s at x = %g m, rotation %g rad: the bomb would start %.3g m inside body %d in frame %d, more than the "
        "slop of %g m; launch it elsewhere, or write 'overlaps: allowed' in the scene",
        which, (double)at->x, (double)at->rotation, overlap_depth(&check->boxes[body], bomb), body, at->frame,
        (double)CONTACT_SLOP);

    /* From the ends of the launches' x, or of the scene's family where there is one launch, */
    double low = (double)check->scene->bomb.x.from, high = (double)check->scene->bomb.x.to;
    bool turned = false;
    for (int i = 0; i < check->count; i++) {
        low = fmin(low, (double)check->launches[i].x);
        high = fmax(high, (double)check->launches[i].x);
        turned |= check->launches[i].rotation != check->launches[0].rotation;
    }
    /* without the spans that bodies block: "-7 to -5.1, 5.1 to 7". */
    OverlapSpan *blocked = malloc((size_t)bodies * sizeof *blocked);
    int count = 0;
    if (blocked == NULL) return false;
    for (int i = 0; i < bodies; i++) {
        const OverlapSpan span = overlap_span(&check->boxes[i], bomb, vec2(1, 0), SCENE_OVERLAP, turned);
        blocked[count] = (OverlapSpan){(double)at->x + span.from, (double)at->x + span.to};
        count += span.from < span.to;
    }
    qsort(blocked, (size_t)count, sizeof *blocked, by_start);
    for (int i = 0; i <= count; i++) {
        const double until = i < count ? fmin(blocked[i].from, high) : high;
        /* Rounded inwards, to a hundredth of a metre. */
        const double from = ceil(100 * low - 1e-6) / 100, to = floor(100 * until + 1e-6) / 100;
        if (to > from) text_join(text, sizeof text, ", ", "%g to %g", from, to);
        if (i < count) low = fmax(low, blocked[i].to);
    }
    free(blocked);
    error_add(error, "; free x%s: %s", turned ? ", at any rotation" : "", text[0] != '\0' ? text : "none");
    return false;
}

/* Checks the launches of this frame. */
static bool check_frame(Check *check, int frame, const World *world, Error *error) {
    const Body *bodies = world_bodies(world);
    const int count = world_body_count(world);
    if (check->done == check->count || check->due[check->done].frame != frame) return true; /* none */
    for (int i = 0; i < count; i++) check->boxes[i] = box_of(&bodies[i]);
    for (; check->done < check->count && check->due[check->done].frame == frame; check->done++) {
        const int launch = check->due[check->done].launch;
        const Box bomb = bomb_box(check->scene, &check->launches[launch]);
        for (int i = 0; i < count; i++)
            if (overlap_exceeds(&check->boxes[i], &bomb, SCENE_OVERLAP))
                return refuse(check, launch, i, &bomb, count, error);
    }
    return true;
}

/* The engine's run without the bomb, up to the frame of the last launch. */
static bool run_quietly(Check *check, Error *error) {
    Scene quiet = *check->scene;
    quiet.bomb.present = false;
    quiet.frames = check->due[check->count - 1].frame;
    Method engine;
    Simulation run;
    if (!method_parse(&engine, "engine", error) || !simulation_begin(&run, &quiet, &engine, error)) return false;
    bool ok = true;
    for (int frame = 0; ok && frame <= quiet.frames; frame++)
        ok = (frame == 0 || simulation_step(&run, frame, error)) && check_frame(check, frame, run.world, error);
    simulation_end(&run);
    return ok;
}

bool launches_check(const Scene *scene, const Launch *launches, int count, Error *error) {
    if (scene->overlaps_allowed || !scene->bomb.present || count == 0) return true;
    Check check = {.scene = scene,
                   .launches = launches,
                   .count = count,
                   .due = malloc((size_t)count * sizeof *check.due),
                   .boxes = malloc((size_t)scene->body_count * sizeof *check.boxes)};
    bool ok = check.due != NULL && check.boxes != NULL;
    for (int i = 0; ok && i < count; i++) check.due[i] = (Due){launches[i].frame, i};
    if (ok) qsort(check.due, (size_t)count, sizeof *check.due, by_frame);
    ok = ok ? run_quietly(&check, error) : error_memory(error, scene->name);
    free(check.due);
    free(check.boxes);
    return ok;
}

bool launch_is_free(const Scene *scene, const World *world) {
    if (scene->overlaps_allowed) return true;
    const Launch launch = launch_of(scene);
    const Box bomb = bomb_box(scene, &launch);
    const Body *bodies = world_bodies(world);
    for (int i = 0; i < world_body_count(world); i++) {
        const Box box = box_of(&bodies[i]);
        if (overlap_exceeds(&box, &bomb, SCENE_OVERLAP)) return false;
    }
    return true;
}

bool scene_check_launches(const Scene *scene, Error *error) {
    enum { TRAINING = LAUNCH_GRID, SCORING = LAUNCH_GRID - 1 };
    Launch launches[TRAINING + SCORING + 1];
    int count = 0;
    if (!scene->bomb.present) return true;
    if (launch_has_family(scene)) {
        if (!launches_for_training(scene, TRAINING, launches, error) ||
            !launches_for_scoring(scene, SCORING, launches + TRAINING, error))
            return false;
        count = TRAINING + SCORING;
    }
    launches[count++] = launch_of(scene);
    return launches_check(scene, launches, count, error);
}

bool launch_find_touch(const Scene *launched, const char *method_text, int *touch, Error *error) {
    Method method;
    Error failure = {0};
    PhaseTracker tracker = {.impact_frames = launched->bomb.impact_frames};
    Stepper *stepper = method_parse(&method, method_text, error) ? stepper_create(&method, launched, error) : NULL;
    World *world = stepper != NULL ? scene_world(launched, error) : NULL;
    bool ok = world != NULL;
    for (int frame = 1; ok && tracker.touch == 0 && frame <= launched->frames; frame++) {
        ok = simulate_step(stepper, world, &(Step){.scene = launched, .frame = frame}, &failure);
        if (ok) phase_next(&tracker, world_problem(world), frame);
    }
    *touch = tracker.touch;
    world_destroy(world);
    stepper_destroy(stepper);
    if (failure.kind == ERROR_NONE) return ok;
    if (failure.failure != FAILURE_NONE) return true;
    *error = failure;
    return false;
}

bool launches_refuse_misses(const Scene *scene, const Launch *launches, int count, Error *error) {
    char where[64] = "";
    double from = INFINITY, to = -INFINITY;
    for (int i = 0; i < count; i++) {
        from = fmin(from, (double)launches[i].x);
        to = fmax(to, (double)launches[i].x);
    }
    snprintf(where, sizeof where, from < to ? "x = %.3g to %.3g m" : "x = %.3g m", from, to);
    if (count == 1)
        return error_input(error, scene->name, "the bomb strikes no box (%s): there is no impact to study", where);
    return error_input(
        error, scene->name,
        "the bomb strikes no box in any of %d launches (%s): there is no impact to study; the picture of "
        "'twinbox check' has its path",
        count, where);
}

bool scene_check_strike(const Scene *scene, Error *error) {
    Launch launches[LAUNCH_GRID];
    const int count = launch_has_family(scene) ? LAUNCH_GRID : 1;
    launches[0] = launch_of(scene);
    if (!scene->bomb.present) return true;
    if (count > 1 && !launches_for_training(scene, count, launches, error)) return false;
    for (int i = 0; i < count; i++) {
        const Scene launched = launch_scene(scene, &launches[i]);
        int touch;
        if (!launch_find_touch(&launched, "engine", &touch, error)) return false;
        if (touch > 0) return true;
    }
    return launches_refuse_misses(scene, launches, count, error);
}

bool launches_find_misses(const Scene *scene, LaunchMisses *misses, Error *error) {
    Launch launches[LAUNCH_TRIES];
    const bool family = launch_has_family(scene);
    /* Bodies times steps that all tries together may take: some seconds. */
    const double most_states = 1e6, steps = (scene->body_count + 1.0) * fmax(scene->frames, 1);
    *misses = (LaunchMisses){.tried = (int)fmin(family ? LAUNCH_TRIES : 1, most_states / steps)};
    launches[0] = launch_of(scene);
    if (family && !launches_for_training(scene, misses->tried, launches, error)) return false;
    bool missed = false;
    for (int i = 0; i < misses->tried; i++) {
        const Scene launched = launch_scene(scene, &launches[i]);
        int touch;
        if (!launch_find_touch(&launched, "engine", &touch, error)) return false;
        if (touch == 0) { /* launches of one side that miss, each next to the one before, are a span */
            misses->missed++;
            if (!missed) misses->spans[misses->span_count++].from = (double)launches[i].x;
            misses->spans[misses->span_count - 1].to = (double)launches[i].x;
        }
        missed = touch == 0;
    }
    return true;
}

static bool run_one_step(const Scene *scene, const Method *method, bool with_bomb, Error *error) {
    Scene short_run = *scene;
    short_run.frames = 1;
    short_run.bomb.frame = 0;
    short_run.bomb.present = scene->bomb.present && with_bomb;
    short_run.overlaps_allowed = true; /* it may not be the bomb's frame */
    return simulate_watched(&short_run, method, &(RunWatch){.recorder = NULL}, error);
}

bool scene_check_networks(const Scene *scene, Error *error) {
    for (int i = 0; i < scene->network_count; i++) {
        Method method;
        const SceneNetwork *network = &scene->networks[i];
        if (!method_parse(&method, network->method, error)) return false;
        if (!method.kind->description->needs_network)
            return error_input(error, network->path, "the method %s has no network", network->method);
        if (!run_one_step(scene, &method, false, error) ||
            (scene->bomb.present && !run_one_step(scene, &method, true, error)))
            return false;
    }
    return true;
}

static bool check_end(const char *path, const SceneSetting *setting, Error *error) {
    Scene *scene = scene_read_with(path, setting, 1, error);
    const bool ok = scene != NULL && scene_check_launches(scene, error);
    scene_destroy(scene);
    if (!ok) error_add(error, "\n(with %s = %.9g, an end of its range)", setting->name, setting->value);
    return ok;
}

bool scene_check_ends(const char *path, const Scene *scene, Error *error) {
    for (int i = 0; i < scene->parameter_count; i++) {
        const SceneParameter *parameter = &scene->parameters[i];
        SceneSetting setting = {.value = parameter->from};
        strcpy(setting.name, parameter->name);
        if (!check_end(path, &setting, error)) return false;
        setting.value = parameter->to;
        if (!check_end(path, &setting, error)) return false;
    }
    return true;
}
