/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Watches a run and decides how it ended. */
#include "runs/verdict.h"

#include "base/base.h"
#include "base/hash.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/contact_finder.h"
#include "runs/runs.h"
#include "runs/runs_internal.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const verdict_words[VERDICTS + 2] = {
    "settles",      "agrees",        "stands", "moves",   "creeps",   "undecided",  "falls",          "collapses",
    "too few fall", "too many fall", "sinks",  "tunnels", "explodes", "non-finite", "adapter failed", "not applicable"};

const char *verdict_name(Verdict verdict) { return verdict_words[verdict]; }

bool verdict_holds(Verdict verdict) { return verdict <= VERDICT_CREEPS; }

bool verdict_sound(Verdict verdict) { return verdict < VERDICT_SINKS; }

void verdict_watch_free(VerdictWatch *watch) {
    free(watch->bodies);
    free(watch->statics);
    contact_finder_free(&watch->finder);
    pass_finder_free(&watch->passes);
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

/* Of the first dynamic bodies. */
static void set_fall(VerdictWatch *watch, const Body *bodies, int count) {
    const double dt = (double)watch->run.dt;
    double sum = 0;
    int moving = 0;
    for (int i = 0; i < count; i++) {
        if (bodies[i].inv_mass == 0) continue;
        sum += verdict_size(&bodies[i]);
        moving++;
    }
    if (watch->fall > 0 || moving == 0) return;
    const double way = 2 * VERDICT_FALL_SIZES * sum / moving, pull = vec2_distance(watch->run.gravity, vec2(0, 0));
    const double steps = pull > 0 ? fmin(sqrt(way / pull) / dt, SCENE_MAX_FRAMES) : VERDICT_CALM_FRAMES;
    watch->fall = steps > 1 ? (int)lround(steps) : 1;
    watch->pull = pull > 0 ? pull : way / (steps * dt * steps * dt);
}

/* A body of the scene starts at rest unless it has a speed; one that is not in it is the bomb. */
static bool starts_still(const Scene *scene, int i) {
    const BodyDef *body = &scene->bodies[i];
    return i < scene->body_count && body->velocity.x == 0 && body->velocity.y == 0 && body->angular_velocity == 0;
}

/* What energy can come from, and the smallest side. */
static void add_source(VerdictWatch *watch, const Body *body) {
    watch->smallest = fmin(watch->smallest, smaller_side(body));
    watch->largest = fmax(watch->largest, verdict_size(body));
    watch->highest = fmax(watch->highest, body_height(body, watch->run.gravity));
    watch->liveliest = fmax(watch->liveliest, body_energy(body, vec2(0, 0)) * body->inv_mass);
}

static bool add_bodies(VerdictWatch *watch, const Body *bodies, int count, Error *error) {
    if (!array_reserve((void **)&watch->bodies, &watch->capacity, (size_t)count, sizeof *watch->bodies))
        return error_memory(error, "verdict");
    while (watch->static_count > 0 && watch->statics[watch->static_count - 1].body >= count) watch->static_count--;
    set_fall(watch, bodies, count);
    for (int i = watch->body_count; i < count; i++) {
        const bool dynamic = bodies[i].inv_mass != 0;
        const double lowest =
            body_height(&bodies[i], watch->run.gravity) - vec2_distance(bodies[i].size, vec2(0, 0)) / 2;
        watch->bodies[i] =
            (WatchedBody){.size = verdict_size(&bodies[i]),
                          .outside = bodies[i].position,
                          .last = bodies[i].position,
                          .stood = bodies[i].position,
                          .stood_angle = bodies[i].angle,
                          .last_angle = bodies[i].angle,
                          .below = -1,
                          .stands = dynamic && (watch->run.struck == NULL || starts_still(watch->run.struck, i))};
        if (dynamic) add_source(watch, &bodies[i]);
        if (dynamic) continue;
        watch->floor = fmin(watch->floor, lowest);
        if (!add_static(watch, &bodies[i], i, error)) return false;
    }
    watch->body_count = count;
    return true;
}

static bool starts_at_rest(const Scene *scene) {
    for (int i = 0; i < scene->body_count; i++)
        if (!starts_still(scene, i)) return false;
    return true;
}

/* The scene if it has a bomb or bodies that move at the start, and dynamic ones that do not; else NULL. */
static const Scene *verdict_struck(const Scene *scene) {
    if (!scene_has_launch(scene) && starts_at_rest(scene)) return NULL;
    for (int i = 0; i < scene->body_count; i++)
        if (!scene->bodies[i].fixed && starts_still(scene, i)) return scene;
    return NULL;
}

void verdict_run_set_engine(VerdictRun *run, const Method *method) {
    run->other_engine = method->kind->description->whole_scenes;
    const char *text = run->other_engine ? settings_get(&method->settings, "skin") : NULL;
    run->finds_contacts = run->other_engine;
    if (text != NULL && !parse_float(text, &run->skin)) run->skin = 0;
}

VerdictRun verdict_run_of(const Scene *scene) {
    const bool rests = starts_at_rest(scene), bomb = scene_has_launch(scene);
    return (VerdictRun){.gravity = scene->gravity,
                        .dt = scene->dt,
                        .frames = scene->frames,
                        .stands = rests && !bomb,
                        .until_bomb = rests && bomb,
                        .struck = verdict_struck(scene)};
}

/* The contacts of the next step. Another engine may let bodies rest a little apart: they carry each other within a
   share of the smallest side. */
static bool find_contacts(VerdictWatch *watch, const Body *bodies, int count, Error *error) {
    const float near = 0.005f, smallest = isfinite(watch->smallest) ? (float)watch->smallest : 0;
    const float skin = watch->run.skin + (watch->run.other_engine ? near * smallest : 0);
    return !watch->run.finds_contacts || contact_finder_find(&watch->finder, bodies, count, skin, error);
}

bool verdict_watch_begin(VerdictWatch *watch, const VerdictRun *run, const Body *bodies, int count, Error *error) {
    if (run->converged != NULL && run->converged->frames < run->frames)
        return error_input(error, "verdict", "the converged run has only %d of %d frames", run->converged->frames,
                           run->frames);
    *watch = (VerdictWatch){.run = *run,
                            .worst = {.other = -1},
                            .smallest = INFINITY,
                            .floor = INFINITY,
                            .highest = -INFINITY,
                            .bodies = watch->bodies,
                            .capacity = watch->capacity,
                            .statics = watch->statics,
                            .finder = watch->finder,
                            .passes = watch->passes,
                            .static_capacity = watch->static_capacity};
    watch->passes.deep_count = 0;
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
    check_bursts(watch, step);
    if (!check_passes(watch, step, error)) return false;
    check_depth(watch, step);
    check_falls(watch, step);
    check_creep(watch, step);
    check_calm(watch, step);
    store_last(watch, step->bodies);
    if (step->frame == falls_in_steps(watch, VERDICT_CREEP_FROM)) store_rested(watch);
    return find_contacts(watch, step->bodies, step->body_count, error);
}

bool verdict_watch_observe(void *watch, int frame, const World *world, Error *error) {
    const ContactProblem *problem = world_problem(world);
    const VerdictStep step = {.frame = frame,
                              .body_count = world_body_count(world),
                              .contact_count = problem->contact_count,
                              .bomb = problem->bomb,
                              .bodies = world_bodies(world),
                              .contacts = problem->contacts};
    fallbacks_add(&((VerdictWatch *)watch)->fallbacks, &world_solution(world)->fallbacks);
    return verdict_watch_step(watch, &step, error);
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
    static const char before[] = "adapter failed: ";
    const bool adapter = failure->failure == FAILURE_ADAPTER;
    if (watch->worst.verdict >= VERDICT_NON_FINITE) return;
    watch->frame = frame;
    verdict_note(watch, adapter ? VERDICT_ADAPTER_FAILED : VERDICT_NON_FINITE, -1, watch->speed, "m/s");
    const char *why = strstr(failure->message, before);
    if (adapter) copy_reason(watch->worst.reason, why != NULL ? why + strlen(before) : failure->message);
}

bool verdict_watch_is_final(const VerdictWatch *watch) { return watch->worst.verdict >= VERDICT_EXPLODES; }

/* m: how far a body is beside where it stood. */
static double moved_by(const VerdictWatch *watch, const WatchedBody *body) {
    const Vec2 way = vec2_sub(body->last, body->stood), gravity = watch->run.gravity;
    const double pull = vec2_distance(gravity, vec2(0, 0));
    return pull > 0 ? fabs((double)way.x * gravity.y - (double)way.y * gravity.x) / pull
                    : vec2_distance(way, vec2(0, 0));
}

static VerdictCount count_bodies(const VerdictWatch *watch) {
    VerdictCount count = {.body = -1};
    const bool gravity = vec2_dot(watch->run.gravity, watch->run.gravity) > 0;
    for (int i = 0; i < watch->body_count; i++) {
        const WatchedBody *body = &watch->bodies[i];
        if (!body->stands || (gravity && !body->landed)) continue;
        count.stood++;
        count.fell += body->fell > 0;
        count.left += body->left;
        if (body->fell > 0 && (count.body < 0 || body->fell < count.first)) count.first = body->fell, count.body = i;
        const double way = body->landed && body->fell == 0 ? moved_by(watch, body) : 0;
        if (way <= VERDICT_MOVED_SHARE * body->size) continue;
        count.moved++;
        count.farthest = fmax(count.farthest, way);
    }
    return count;
}

/* What stands of a struck scene. */
static void read_struck(const VerdictCount *count, VerdictReading *reading) {
    reading->struck = true;
    if (count->fell == 0) {
        reading->verdict = VERDICT_STANDS;
        reading->body = -1;
        reading->value = count->farthest;
        reading->unit = "m";
        return;
    }
    reading->verdict = 2 * count->fell < count->stood ? VERDICT_FALLS : VERDICT_COLLAPSES;
    reading->frame = count->first;
    reading->body = count->body;
    reading->value = count->fell;
    reading->unit = "boxes";
}

static VerdictReading read_verdict(const VerdictWatch *watch) {
    const bool calm = watch->calm >= falls_in_steps(watch, VERDICT_CALM_FALLS);
    VerdictReading reading = watch->worst;
    if (reading.verdict < VERDICT_CREEPS) {
        const int which = calm ? 0 : 1;
        const bool hangs = !calm && watch->restless[1] >= 0 && watch->unrest[1] == 0;
        reading = (VerdictReading){.verdict = calm ? VERDICT_SETTLES : VERDICT_MOVES,
                                   .frame = watch->frame - watch->calm + (calm ? 1 : 0),
                                   .body = calm ? -1 : watch->restless[1],
                                   .value = hangs ? watch->bodies[watch->restless[1]].air * (double)watch->run.dt
                                                  : watch->unrest[which],
                                   .unit = hangs ? "s" : "m/s",
                                   .other = -1};
    }
    reading.moving = !calm;
    reading.count = count_bodies(watch);
    if (watch->run.struck != NULL && reading.count.stood > 0 && reading.verdict < VERDICT_UNDECIDED)
        read_struck(&reading.count, &reading);
    return reading;
}

VerdictReading verdict_watch_end(const VerdictWatch *watch) {
    VerdictReading reading = read_verdict(watch);
    reading.drift = reading.gained = NAN;
    reading.deepest = watch->deepest;
    reading.fallbacks = watch->fallbacks;
    reading.excess = watch->run.no_energy ? NAN : watch->excess;
    if (watch->rested_count == 0 || watch->frame == falls_in_steps(watch, VERDICT_CREEP_FROM)) return reading;
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

/* A method that fails is a valid result. */
static bool run_step(VerdictWatch *watch, Stepper *stepper, World *world, const Step *step, Error *error) {
    Error failure = {0};
    if (simulate_step(stepper, world, step, &failure)) return verdict_watch_observe(watch, step->frame, world, error);
    if (failure.failure == FAILURE_NONE) return *error = failure, false;
    fallbacks_add(&watch->fallbacks, &world_solution(world)->fallbacks);
    verdict_watch_failed(watch, step->frame, &failure);
    return true;
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
    for (int frame = 1; ok && frame <= scene->frames && !verdict_watch_is_final(&watch); frame++)
        ok = run_step(&watch, stepper, world, &(Step){.scene = scene, .frame = frame}, error);
    if (ok) {
        *reading = verdict_watch_end(&watch);
        reading->state = hash_bodies(world_bodies(world), world_body_count(world));
        reading->steps = watch.frame;
    }
    verdict_watch_free(&watch);
    stepper_destroy(stepper);
    world_destroy(world);
    return ok;
}
