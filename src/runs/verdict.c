/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "runs/verdict.h"

#include "base/base.h"
#include "base/hash.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/internal.h"
#include "runs/runs.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const verdict_words[VERDICTS + 2] = {"settles",        "sways",         "creeps",   "falls",
                                                 "sinks",          "tunnels",       "explodes", "non-finite",
                                                 "adapter failed", "not applicable"};

const char *verdict_name(Verdict verdict) { return verdict_words[verdict]; }

bool verdict_holds(Verdict verdict) { return verdict <= VERDICT_CREEPS; }

void verdict_watch_free(VerdictWatch *watch) {
    free(watch->bodies);
    free(watch->statics);
    contact_finder_free(&watch->finder);
    *watch = (VerdictWatch){0};
}

static void store_last(VerdictWatch *watch, const Body *bodies) {
    for (int i = 0; i < watch->body_count; i++) {
        watch->bodies[i].last = bodies[i].position;
        watch->bodies[i].last_angle = bodies[i].angle;
    }
}

static bool add_static(VerdictWatch *watch, const Body *body, int index, Error *error) {
    if (!array_reserve((void **)&watch->statics, &watch->static_capacity, (size_t)watch->static_count + 1,
                       sizeof *watch->statics))
        return error_memory(error, "verdict");
    watch->statics[watch->static_count++] = (WatchedStatic){index, cos((double)body->angle), sin((double)body->angle)};
    return true;
}

static bool add_bodies(VerdictWatch *watch, const Body *bodies, int count, Error *error) {
    if (!array_reserve((void **)&watch->bodies, &watch->capacity, (size_t)count, sizeof *watch->bodies))
        return error_memory(error, "verdict");
    while (watch->static_count > 0 && watch->statics[watch->static_count - 1].body >= count) watch->static_count--;
    for (int i = count; i < watch->body_count; i++) watch->touched_count -= watch->bodies[i].touched;
    for (int i = watch->body_count; i < count; i++) {
        watch->bodies[i] =
            (WatchedBody){.outside = bodies[i].position, .last = bodies[i].position, .last_angle = bodies[i].angle};
        if (bodies[i].inv_mass != 0) watch->smallest = fmin(watch->smallest, smaller_side(&bodies[i]));
        if (bodies[i].inv_mass == 0 && !add_static(watch, &bodies[i], i, error)) return false;
    }
    watch->body_count = count;
    return true;
}

static bool starts_at_rest(const Scene *scene) {
    for (int i = 0; i < scene->body_count; i++) {
        const BodyDef *body = &scene->bodies[i];
        if (body->velocity.x != 0 || body->velocity.y != 0 || body->angular_velocity != 0) return false;
    }
    return true;
}

void verdict_run_set_engine(VerdictRun *run, const Method *method) {
    run->other_engine = method->kind->description->external;
    const char *text = run->other_engine ? settings_get(&method->settings, "skin") : NULL;
    if (text != NULL) run->finds_contacts = parse_float(text, &run->skin);
}

VerdictRun verdict_run_of(const Scene *scene) {
    const bool rests = starts_at_rest(scene), bomb = scene_has_launch(scene);
    return (VerdictRun){.gravity = scene->gravity,
                        .dt = scene->dt,
                        .frames = scene->frames,
                        .stands = rests && !bomb,
                        .until_bomb = rests && bomb};
}

/* The contacts of the next step. */
static bool find_contacts(VerdictWatch *watch, const Body *bodies, int count, Error *error) {
    return !watch->run.finds_contacts || contact_finder_find(&watch->finder, bodies, count, watch->run.skin, error);
}

bool verdict_watch_begin(VerdictWatch *watch, const VerdictRun *run, const Body *bodies, int count, Error *error) {
    if (run->converged != NULL && run->converged->frames < run->frames)
        return error_input(error, "verdict", "the converged run has only %d of %d frames", run->converged->frames,
                           run->frames);
    *watch = (VerdictWatch){.run = *run,
                            .smallest = INFINITY,
                            .bodies = watch->bodies,
                            .capacity = watch->capacity,
                            .statics = watch->statics,
                            .finder = watch->finder,
                            .static_capacity = watch->static_capacity};
    energy_balance_begin(&watch->own, run->gravity, bodies, count);
    watch->kept = watch->brought = watch->own.energy;
    return add_bodies(watch, bodies, count, error) && find_contacts(watch, bodies, count, error);
}

static void store_rested(VerdictWatch *watch) {
    for (int i = 0; i < watch->body_count; i++) watch->bodies[i].rested = watch->bodies[i].last;
    watch->rested_count = watch->body_count;
    watch->rested = watch->energy;
}

bool verdict_watch_step(VerdictWatch *watch, const VerdictStep *given, Error *error) {
    const ContactSet *found = &watch->finder.set;
    const VerdictStep judged = {.frame = given->frame,
                                .body_count = given->body_count,
                                .contact_count = found->contact_count,
                                .bomb = given->bomb,
                                .bodies = given->bodies,
                                .contacts = found->contacts},
                      *step = watch->run.finds_contacts ? &judged : given;
    if (watch->worst.verdict >= VERDICT_NON_FINITE) return true;
    watch->frame = step->frame;
    if (!check_finite(watch, step)) return true;
    check_energy(watch, step);
    if (!add_bodies(watch, step->bodies, step->body_count, error)) return false;
    check_tunnels(watch, step);
    check_depth(watch, step);
    check_falls(watch, step);
    check_creep(watch, step);
    check_calm(watch, step);
    store_last(watch, step->bodies);
    if (step->frame == verdict_steps(VERDICT_CREEP_FROM, watch->run.dt)) store_rested(watch);
    return find_contacts(watch, step->bodies, step->body_count, error);
}

bool verdict_watch_observe(void *watch, int frame, const World *world, Error *error) {
    const ContactProblem *problem = world_problem(world);
    const VerdictStep step = {.frame = frame,
                              .body_count = world_body_count(world),
                              .contact_count = problem->contact_count,
                              .bomb = problem->marked,
                              .bodies = world_bodies(world),
                              .contacts = problem->contacts};
    return verdict_watch_step(watch, &step, error);
}

/* The words of exec.c. */
static const char adapter_failed[] = "adapter failed: ";

/* The words of world.c, soft_step.c and avbd.c. */
bool verdict_is_failure(const Error *failure) {
    return failure->kind == ERROR_INPUT &&
           (strstr(failure->message, "NaN or infinite") != NULL || strstr(failure->message, adapter_failed) != NULL);
}

/* Without the place, which is that of the verdict. */
static void copy_reason(char reason[VERDICT_REASON_SIZE], const char *text) {
    const char *place = NULL;
    for (const char *at = strstr(text, ", in step "); at != NULL; at = strstr(at + 1, ", in step ")) place = at;
    const size_t length = place != NULL ? (size_t)(place - text) : strlen(text);
    char whole[sizeof((Error *)NULL)->message];
    snprintf(whole, sizeof whole, "%.*s", (int)length, text);
    snprintf(reason, VERDICT_REASON_SIZE, "%.*s", (int)utf8_cut(whole, VERDICT_REASON_SIZE - 1), whole);
}

void verdict_watch_failed(VerdictWatch *watch, int frame, const Error *failure) {
    const char *adapter = strstr(failure->message, adapter_failed);
    if (watch->worst.verdict >= VERDICT_NON_FINITE) return;
    watch->frame = frame;
    verdict_note(watch, adapter != NULL ? VERDICT_ADAPTER_FAILED : VERDICT_NON_FINITE, -1, watch->speed, "m/s");
    if (adapter != NULL) copy_reason(watch->worst.reason, adapter + strlen(adapter_failed));
}

bool verdict_watch_is_final(const VerdictWatch *watch) { return watch->worst.verdict >= VERDICT_EXPLODES; }

static VerdictReading read_verdict(const VerdictWatch *watch) {
    if (watch->worst.verdict > VERDICT_SWAYS) return watch->worst;
    const bool calm = watch->calm >= VERDICT_CALM_FRAMES;
    return (VerdictReading){.verdict = calm ? VERDICT_SETTLES : VERDICT_SWAYS,
                            .frame = watch->frame - watch->calm + (calm ? 1 : 0),
                            .body = -1,
                            .value = calm ? watch->kinetic : watch->kinetic_not_calm,
                            .unit = "J"};
}

VerdictReading verdict_watch_end(const VerdictWatch *watch) {
    VerdictReading reading = read_verdict(watch);
    reading.drift = reading.gained = NAN;
    reading.deepest = watch->deepest;
    reading.excess = watch->run.no_energy ? NAN : watch->excess;
    if (watch->rested_count == 0 || watch->frame == verdict_steps(VERDICT_CREEP_FROM, watch->run.dt)) return reading;
    reading.drift = 0;
    reading.gained = watch->energy - watch->rested;
    for (int i = 0; i < watch->rested_count && i < watch->body_count; i++)
        reading.drift = fmax(reading.drift, vec2_distance(watch->bodies[i].rested, watch->bodies[i].last));
    return reading;
}

/* A body has no padding: eleven floats. */
static uint64_t hash_bodies(const Body *bodies, int count) {
    return count > 0 ? hash_fnv1a64(FNV1A64_START, bodies, (size_t)count * sizeof *bodies) : FNV1A64_START;
}

/* An input error during the run means that the state became NaN or infinite, or that a program failed. That is a valid
   result. */
static bool run_step(VerdictWatch *watch, Stepper *stepper, World *world, const Step *step, Error *error) {
    Error failure = {0};
    if (simulate_step(stepper, world, step, &failure)) return verdict_watch_observe(watch, step->frame, world, error);
    if (failure.kind == ERROR_INPUT)
        verdict_watch_failed(watch, step->frame, &failure);
    else
        *error = failure;
    return failure.kind == ERROR_INPUT;
}

bool verdict_run(VerdictReading *reading, const Scene *scene, const Method *method, const VerdictRun *run,
                 Error *error) {
    VerdictWatch watch = {0};
    VerdictRun judged = *run;
    verdict_run_set_engine(&judged, method);
    World *world = scene_world(scene, error);
    Stepper *stepper = world != NULL ? stepper_create(method, scene, error) : NULL;
    bool ok =
        stepper != NULL && verdict_watch_begin(&watch, &judged, world_bodies(world), world_body_count(world), error);
    NetworkFallbacks fallbacks = {0};
    for (int frame = 1; ok && frame <= scene->frames && !verdict_watch_is_final(&watch); frame++) {
        ok = run_step(&watch, stepper, world, &(Step){.scene = scene, .frame = frame}, error);
        network_fallbacks_add(&fallbacks, &world_solution(world)->fallbacks);
    }
    if (ok) {
        *reading = verdict_watch_end(&watch);
        reading->state = hash_bodies(world_bodies(world), world_body_count(world));
        reading->steps = watch.frame;
        reading->fallbacks = fallbacks;
    }
    verdict_watch_free(&watch);
    stepper_destroy(stepper);
    world_destroy(world);
    return ok;
}
