/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Watches a run: places, rest, what carries what, what fell. */
#include "runs/verdict.h"

#include "base/base.h"
#include "engine/engine.h"
#include "runs/runs.h"
#include "runs/verdict_internal.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A body moves within its place by this share of its size: a pixel of a box that is drawn with 50. */
static const double place_share = 0.02;
static const double rest_units = 0.5; /* a hop of a size up and down takes as long */
/* Half a side lower, a box has lost its layer. At 30 degrees a square's centre has risen by nine tenths of what turns
   it over. */
static const double fall_share = 0.5, fall_turn = 30 * M_PI / 180;
static const double moved_share = 0.1;  /* of a size: seen at a glance */
static const double touch_share = 0.03; /* of a side: less is not seen */
static const double unit_sizes = 5;     /* a box of 1 m: one second */

const char *const verdict_words[VERDICTS + 2] = {
    "settles", "agrees",    "stands",       "moves",          "too short",     "undecided",
    "falls",   "collapses", "too few fall", "too many fall",  "hangs",         "sinks",
    "tunnels", "explodes",  "non-finite",   "adapter failed", "not applicable"};

const char *verdict_name(Verdict verdict) { return verdict_words[verdict]; }

bool verdict_holds(Verdict verdict) { return verdict <= VERDICT_MOVES; }

bool verdict_sound(Verdict verdict) { return verdict < VERDICT_HANGS; }

static double size_of(const Body *body) { return sqrt((double)body->size.x * (double)body->size.y); }

void verdict_watch_free(VerdictWatch *watch) {
    free(watch->bodies);
    free(watch->order);
    free(watch->deep);
    contact_finder_free(&watch->finder);
    *watch = (VerdictWatch){0};
}

bool verdict_is_struck(const Scene *scene) {
    int moving = 0, starting = 0;
    for (int i = 0; i < scene->body_count; i++) {
        const BodyDef *body = &scene->bodies[i];
        if (body->fixed) continue;
        moving++;
        starting += body->velocity.x != 0 || body->velocity.y != 0;
    }
    return (scene_has_launch(scene) && moving > 0) || (starting > 0 && starting < moving);
}

VerdictRun verdict_run_of(const Scene *scene, const Method *method) {
    VerdictRun run = {.gravity = scene->gravity,
                      .dt = scene->dt,
                      .bomb = scene_has_launch(scene) ? scene->body_count : -1,
                      .finds_contacts = method->kind->description->whole_scenes};
    const char *text = run.finds_contacts ? settings_get(&method->settings, "skin") : NULL;
    if (text != NULL && !parse_float(text, &run.skin)) run.skin = 0;
    return run;
}

static Pose pose_of(const Body *body) { return (Pose){body->position.x, body->position.y, body->angle}; }

double depth_of(const WatchedBody *a, const WatchedBody *b, double within) {
    if (way_between(&a->last, &b->last) > a->corner + b->corner + within) return -INFINITY;
    const Box of_a = box_of(a, &a->last), of_b = box_of(b, &b->last);
    return overlap_depth(&of_a, &of_b);
}

double way_past(const WatchedBody *a, const WatchedBody *b) {
    const double x = a->last.x - a->before.x - (b->last.x - b->before.x),
                 y = a->last.y - a->before.y - (b->last.y - b->before.y);
    return sqrt(x * x + y * y) + fabs(turn_between(a->last.angle, a->before.angle)) * a->corner +
           fabs(turn_between(b->last.angle, b->before.angle)) * b->corner;
}

bool bodies_touch(const VerdictWatch *watch, const WatchedBody *a, const WatchedBody *b) {
    const double gap = way_past(a, b) + touch_share * fmin(a->side, b->side) + 2 * (double)watch->run.skin;
    return depth_of(a, b, gap) > -gap;
}

bool find_near(VerdictWatch *watch, double down, Error *error) {
    ContactFinder *finder = &watch->finder;
    if (!contact_finder_reserve(finder, watch->body_count, error)) return false;
    for (int i = 0; i < watch->body_count; i++) {
        const WatchedBody *body = &watch->bodies[i];
        const Pose *a = &body->before, *b = &body->last;
        const double x = -watch->up_x * down, y = -watch->up_y * down;
        const double r = body->corner * (1 + touch_share) + (double)watch->run.skin;
        finder->bounds[i] = (Bounds){
            vec2((float)(fmin(a->x, b->x) + fmin(x, 0) - r), (float)(fmin(a->y, b->y) + fmin(y, 0) - r)),
            vec2((float)(larger(a->x, b->x) + larger(x, 0) + r), (float)(larger(a->y, b->y) + larger(y, 0) + r))};
        finder->fixed[i] = body->is_static;
    }
    return contact_finder_pairs(finder, watch->body_count, error);
}

/* m: how far a box reaches along a direction, from its middle. */
static double reach_along(const Box *box, Vec2 way) {
    return fabs((double)vec2_dot(box->rotation.column1, way)) * (double)box->half.x +
           fabs((double)vec2_dot(box->rotation.column2, way)) * (double)box->half.y;
}

/* m: how far a box moves along a direction until it touches another; INFINITY: it never does. Along each axis of a face
   they overlap from one way to another. */
static double way_until(const Box *box, const Box *other, Vec2 direction) {
    const double rounding = 2e-3 * fmin((double)box->half.x, (double)box->half.y); /* m: neighbours do not touch */
    const Vec2 axes[] = {box->rotation.column1, box->rotation.column2, other->rotation.column1,
                         other->rotation.column2};
    double first = 0, last = INFINITY;
    for (int k = 0; k < 4; k++) {
        const double reach = reach_along(box, axes[k]) + reach_along(other, axes[k]) - rounding;
        const double speed = vec2_dot(axes[k], direction),
                     apart = vec2_dot(axes[k], vec2_sub(other->position, box->position));
        const double ahead = speed < 0 ? -apart : apart;
        if (fabs(speed) < 1e-6 && fabs(apart) > reach) return INFINITY;
        if (fabs(speed) < 1e-6) continue;
        first = larger(first, (ahead - reach) / fabs(speed));
        last = fmin(last, (ahead + reach) / fabs(speed));
    }
    return first <= last ? first : INFINITY;
}

/* m: the height of a body before the last step: static ones are below all, none is above all. */
static double rank_of(const VerdictWatch *watch, int i) {
    return i < 0 ? INFINITY : watch->bodies[i].is_static ? -INFINITY : height_of(watch, &watch->bodies[i].before);
}

/* The bodies without a carrier get one, by their poses before the last step. What starts at rest may move down by
   `way`, m. First each finds what it would touch; then they are carried from the static bodies on, to and fro, so that
   a tower that is listed from either end is quick. */
static bool find_carriers(VerdictWatch *watch, double way, Error *error) {
    if (watch->pull == 0) return true;
    if (!find_near(watch, larger(way, fall_share * watch->largest), error)) return false;
    const size_t count = 2 * watch->finder.pairs.count;
    const Vec2 down = vec2((float)-watch->up_x, (float)-watch->up_y);
    bool more = true;
    for (int i = 0; i < watch->body_count; i++) watch->bodies[i].link = -1;
    for (int pass = 0; more; pass++) {
        more = pass == 0;
        for (size_t n = 0; n < count; n++) {
            const size_t k = pass % 2 == 0 ? n : count - 1 - n;
            const BodyPair pair = watch->finder.pairs.pairs[k / 2];
            const int i = k % 2 == 0 ? pair.a : pair.b, j = k % 2 == 0 ? pair.b : pair.a;
            WatchedBody *body = &watch->bodies[i];
            const WatchedBody *other = &watch->bodies[j];
            if (body->is_static || body->is_bomb || body->carrier >= 0 || other->is_bomb) continue;
            if (pass == 0 && rank_of(watch, j) < rank_of(watch, i)) {
                const Box box = box_of(body, &body->before), under = box_of(other, &other->before);
                const double gap = way_until(&box, &under, down), alike = 0.1 * body->side;
                if (gap > larger(body->starts ? 0 : way, fall_share * body->side)) continue;
                if (body->link < 0 || gap < body->gap - alike ||
                    (gap < body->gap + alike && rank_of(watch, j) < rank_of(watch, body->link)))
                    body->link = j, body->gap = gap;
            } else if (pass > 0 && (other->is_static || other->carrier >= 0)) {
                if (body->link < 0 && bodies_touch(watch, body, other)) body->link = j, body->gap = 0;
                if (body->link != j) continue;
                body->carrier = j;
                body->carrier_up = height_of(watch, &other->before);
                body->gaps = body->gap + (other->is_static ? 0 : other->gaps);
                body->reference = body->before;
                watch->order[watch->carried++] = i;
                more = true;
            }
        }
    }
    return true;
}

static void set_unit(VerdictWatch *watch) {
    watch->unit = watch->pull > 0      ? sqrt(2 * unit_sizes * watch->mean / watch->pull)
                  : watch->fastest > 0 ? unit_sizes * watch->mean / watch->fastest
                                       : 0;
}

/* Adds bodies. What is added later brings energy, which the frame that follows counts; the bomb, once it strikes. */
static bool add_bodies(VerdictWatch *watch, const Body *bodies, int count, int frame, Error *error) {
    if (!array_reserve((void **)&watch->bodies, &watch->capacity, (size_t)count, sizeof *watch->bodies) ||
        !array_reserve((void **)&watch->order, &watch->order_capacity, (size_t)count, sizeof *watch->order))
        return error_memory(error, "verdict");
    const Vec2 upwards = vec2((float)watch->up_x, (float)watch->up_y), across = vec2(upwards.y, -upwards.x);
    /* By then what goes so fast has gone as far as it would have to fall. */
    const double slowest = fall_share * watch->mean / watch->unit;
    for (int i = watch->body_count; i < count; i++) {
        const Body *from = &bodies[i];
        WatchedBody *body = &watch->bodies[i];
        const Box box = box_make(from->position, from->size, from->angle);
        const Pose pose = pose_of(from);
        const double w = from->size.x, h = from->size.y, up = height_of(watch, &pose);
        *body = (WatchedBody){.box = from->size,
                              .size = size_of(from),
                              .side = fmin(w, h),
                              .corner = sqrt(w * w + h * h) / 2,
                              .last = pose,
                              .before = pose,
                              .place = pose,
                              .reference = pose,
                              .since = frame,
                              .stays = {INT_MAX, INT_MAX},
                              .carrier = -1,
                              .held = frame,
                              .level = up,
                              .level_since = frame,
                              .is_static = from->inv_mass == 0,
                              .is_bomb = i == watch->run.bomb};
        watch->thinnest = fmin(watch->thinnest, body->side);
        if (body->is_static) {
            const double at = across_of(watch, &pose), reach = reach_along(&box, across);
            watch->floor = fmin(watch->floor, up - reach_along(&box, upwards));
            watch->low = fmin(watch->low, at - reach);
            watch->high = larger(watch->high, at + reach);
            continue;
        }
        if (isinf(watch->lowest)) watch->lowest = up;
        const double per_kg =
            body_energy(from, vec2(0, 0)) * (double)from->inv_mass + watch->pull * (up - watch->lowest);
        const double speed = vec2_distance(from->velocity, vec2(0, 0)), spin = from->angular_velocity;
        body->mass = 1 / (double)from->inv_mass;
        body->energy = body->mass * (per_kg + watch->pull * watch->lowest);
        body->starts = frame == 0 && !body->is_bomb && speed + fabs(spin) * body->corner > slowest;
        watch->smallest = fmin(watch->smallest, body->side);
        watch->largest = larger(watch->largest, body->size);
        watch->liveliest = larger(watch->liveliest, per_kg);
        watch->weight += body->mass * watch->pull;
        watch->lift += body->mass * watch->pull * body->size;
        if (energy_counts(watch, body)) count_energy(watch, body);
    }
    watch->body_count = count;
    return true;
}

bool verdict_watch_begin(VerdictWatch *watch, const VerdictRun *run, const Body *bodies, int count, Error *error) {
    const double x = run->gravity.x, y = run->gravity.y, pull = sqrt(x * x + y * y);
    *watch = (VerdictWatch){.run = *run,
                            .worst = {.body = -1, .other = -1, .unit = "m/s"},
                            .pull = pull,
                            .up_x = pull > 0 ? -x / pull : 0,
                            .up_y = pull > 0 ? -y / pull : 1,
                            .smallest = INFINITY,
                            .thinnest = INFINITY,
                            .floor = INFINITY,
                            .low = INFINITY,
                            .high = -INFINITY,
                            .lowest = INFINITY,
                            .kept = INFINITY,
                            .met = -1};
    double sizes = 0;
    int moving = 0, starting = 0;
    for (int i = 0; i < count; i++) {
        if (bodies[i].inv_mass == 0) continue;
        const Pose pose = pose_of(&bodies[i]);
        watch->lowest = fmin(watch->lowest, height_of(watch, &pose));
        if (i == run->bomb) continue;
        sizes += size_of(&bodies[i]);
        moving++;
        watch->fastest = larger(watch->fastest, vec2_distance(bodies[i].velocity, vec2(0, 0)));
    }
    watch->mean = moving > 0 ? sizes / moving : 1;
    set_unit(watch);
    if (!add_bodies(watch, bodies, count, 0, error)) return false;
    for (int i = 0; i < count; i++) starting += watch->bodies[i].starts;
    watch->struck = (run->bomb >= 0 && moving > 0) || (starting > 0 && starting < moving);
    return find_carriers(watch, unit_sizes * watch->mean, error) &&
           (!run->finds_contacts || contact_finder_find(&watch->finder, bodies, count, run->skin, error));
}

/* Bodies come behind what carries them. */
static void judge_falls(VerdictWatch *watch) {
    for (int k = 0; k < watch->carried; k++) {
        const int i = watch->order[k];
        if (i >= watch->body_count) continue;
        WatchedBody *body = &watch->bodies[i];
        const WatchedBody *below = &watch->bodies[body->carrier];
        const double drop = height_of(watch, &body->reference) - height_of(watch, &body->last);
        const double limit = fall_share * body->side;
        bool fell = fabs(turn_between(body->last.angle, body->reference.angle)) > fall_turn;
        if (!fell && drop > limit + body->gaps) {
            const double sag = below->is_static ? 0 : body->carrier_up - height_of(watch, &below->last);
            fell = below->fell > 0 || drop - sag - larger(0, depth_of(body, below, 0)) > limit + body->gap;
        }
        body->fell = !fell ? 0 : body->fell > 0 ? body->fell : watch->frame;
    }
    if (watch->pull == 0 || isinf(watch->floor)) return;
    for (int i = 0; i < watch->body_count; i++) {
        WatchedBody *body = &watch->bodies[i];
        if (body->is_static) continue;
        const double up = height_of(watch, &body->last), across = across_of(watch, &body->last);
        body->left = up + body->corner < watch->floor ||
                     (body->held != watch->frame &&
                      (across + body->corner < watch->held[0] || across - body->corner > watch->held[1]));
        if (body->left && body->fell == 0) body->fell = watch->frame;
        if (!body->left && body->carrier < 0) body->fell = 0;
    }
}

/* Gives the bodies their new poses. Returns what a corner has moved at most, m. */
static double move_bodies(VerdictWatch *watch, const VerdictStep *step) {
    double farthest = 0;
    watch->held[0] = watch->low;
    watch->held[1] = watch->high;
    for (int i = 0; i < step->body_count; i++) {
        WatchedBody *body = &watch->bodies[i];
        if (body->is_static) continue;
        const Pose pose = pose_of(&step->bodies[i]);
        const double x = pose.x - body->place.x, y = pose.y - body->place.y;
        const double free = place_share * body->size - fabs(turn_between(pose.angle, body->place.angle)) * body->corner;
        if (free < 0 || x * x + y * y > free * free) {
            body->stays[0] = body->stays[1];
            body->stays[1] = step->frame - body->since;
            body->since = step->frame;
            body->place = pose;
        }
        farthest = larger(farthest, way_between(&pose, &body->last) +
                                        fabs(turn_between(pose.angle, body->last.angle)) * body->corner);
        body->before = body->last;
        body->last = pose;
        if (body->held != step->frame) continue;
        const double across = across_of(watch, &pose);
        watch->held[0] = -larger(-watch->held[0], body->corner - across);
        watch->held[1] = larger(watch->held[1], across + body->corner);
    }
    return farthest;
}

bool verdict_watch_step(VerdictWatch *watch, const VerdictStep *given, Error *error) {
    const VerdictRun *run = &watch->run;
    VerdictStep step = *given;
    if (run->finds_contacts) {
        step.contacts = watch->finder.set.contacts;
        step.contact_count = watch->finder.set.contact_count;
    }
    if (watch->worst.verdict >= VERDICT_NON_FINITE) return true;
    watch->frame = step.frame;
    if (!check_finite(watch, &step)) return true;
    while (watch->body_count > step.body_count) /* what is removed takes its energy along */
        if (energy_counts(watch, &watch->bodies[--watch->body_count]))
            watch->brought -= watch->bodies[watch->body_count].energy;
    if (!check_contacts(watch, &step, error)) return false;
    const int had = watch->body_count;
    if (!add_bodies(watch, step.bodies, step.body_count, step.frame, error)) return false;
    const double farthest = move_bodies(watch, &step);
    watch->fastest = larger(watch->fastest, farthest / (double)run->dt);
    set_unit(watch);
    for (int i = 0; watch->met < 0 && run->bomb >= 0 && run->bomb < had && i < had; i++) {
        WatchedBody *body = &watch->bodies[i], *bomb = &watch->bodies[run->bomb];
        if (body->is_static || body == bomb || !bodies_touch(watch, body, bomb)) continue;
        watch->met = step.frame - 1;
        count_energy(watch, bomb);
        if (!find_carriers(watch, 0, error)) return false;
    }
    if (farthest > pass_share / 2 * watch->smallest && !check_passes(watch, error)) return false;
    check_energy(watch, &step);
    judge_falls(watch);
    if (!check_hanging(watch, error)) return false;
    if (watch->rested_frame == 0 && step.frame == steps_of(watch, VERDICT_DRIFT_UNITS)) {
        watch->rested_frame = step.frame;
        watch->rested = watch->energy;
        for (int i = 0; i < watch->body_count; i++) watch->bodies[i].rested = watch->bodies[i].last;
    }
    return !run->finds_contacts || contact_finder_find(&watch->finder, step.bodies, step.body_count, run->skin, error);
}

bool verdict_watch_observe(void *watch, int frame, const World *world, Error *error) {
    const ContactProblem *problem = world_problem(world);
    const VerdictStep step = {.frame = frame,
                              .body_count = world_body_count(world),
                              .contact_count = problem->contact_count,
                              .bodies = world_bodies(world),
                              .contacts = problem->contacts};
    fallbacks_add(&((VerdictWatch *)watch)->fallbacks, &world_solution(world)->fallbacks);
    return verdict_watch_step(watch, &step, error);
}

void verdict_watch_failed(VerdictWatch *watch, int frame, const Error *failure) {
    static const char before[] = "adapter failed: ", behind[] = ", in step ";
    if (watch->worst.verdict >= VERDICT_NON_FINITE) return;
    const bool adapter = failure->failure == FAILURE_ADAPTER;
    watch->frame = frame;
    verdict_note(watch, adapter ? VERDICT_ADAPTER_FAILED : VERDICT_NON_FINITE, -1, watch->speed, "m/s");
    if (!adapter) return;
    const char *text = strstr(failure->message, before); /* without the place, which is that of the verdict */
    text = text != NULL ? text + strlen(before) : failure->message;
    size_t length = strlen(text);
    for (const char *at = text; (at = strstr(at, behind)) != NULL; at++) length = (size_t)(at - text);
    const size_t fits = utf8_cut(text, VERDICT_REASON_SIZE - 1);
    snprintf(watch->worst.reason, VERDICT_REASON_SIZE, "%.*s", (int)(length < fits ? length : fits), text);
}

double verdict_watch_units(const VerdictWatch *watch, double units) {
    return steps_of(watch, units) * (double)watch->run.dt;
}

bool verdict_watch_is_final(const VerdictWatch *watch) { return watch->worst.verdict >= VERDICT_EXPLODES; }

bool verdict_watch_fell(const VerdictWatch *watch, int i) {
    const WatchedBody *body = &watch->bodies[i];
    return i < watch->body_count && !body->is_static && !body->is_bomb && body->fell > 0;
}

/* Counts, rest and figures; then, of a sound run, the word. */
VerdictReading verdict_watch_end(const VerdictWatch *watch) {
    VerdictReading reading = watch->worst;
    VerdictCount *count = &reading.count;
    const int least = steps_of(watch, rest_units);
    const bool after = watch->rested_frame > 0 && watch->frame > watch->rested_frame;
    int dropped = 0, starting = 0, last = -1;
    count->body = -1;
    reading.drift = after ? 0 : NAN;
    for (int i = 0; i < watch->body_count; i++) {
        const WatchedBody *body = &watch->bodies[i];
        if (after) reading.drift = larger(reading.drift, way_between(&body->rested, &body->last));
        if (body->is_static || body->is_bomb) continue;
        count->bodies++;
        dropped += body->carrier < 0;
        starting += body->starts;
        count->fell += body->fell > 0;
        count->left += body->left;
        if (body->fell > 0 && (count->body < 0 || body->fell < count->first))
            count->first = body->fell, count->body = i;
        const double up = height_of(watch, &body->last) - height_of(watch, &body->reference);
        const double way = hypot(across_of(watch, &body->last) - across_of(watch, &body->reference), larger(0, up));
        if (body->fell == 0 && body->carrier >= 0 && way > moved_share * body->size) {
            count->moved++;
            count->farthest = larger(count->farthest, way);
        }
        const int stay = watch->frame - body->since, shorter = (int)fmin(body->stays[0], body->stays[1]);
        const bool known = body->stays[0] != INT_MAX && body->stays[1] != INT_MAX;
        reading.moving |= stay < least || (known && stay <= 2 * shorter);
        if (last < 0 || body->since > watch->bodies[last].since) last = i;
    }
    reading.struck = watch->struck;
    reading.since = last >= 0 ? watch->bodies[last].since : 0;
    reading.too_short = watch->frame < least && reading.since == 0 && count->bodies > 0;
    reading.fallbacks = watch->fallbacks;
    reading.deepest = watch->deepest;
    reading.excess = energy_is_judged(watch) ? larger(watch->excess, 0) : NAN;
    reading.gained = after ? watch->energy - watch->rested : NAN;
    if (reading.verdict >= VERDICT_HANGS) return reading;
    reading.value = watch->speed;
    reading.frame = reading.moving || reading.too_short ? watch->frame : reading.since;
    if (count->fell > 0) {
        const bool by_itself = watch->run.bomb >= 0 && starting == 0 && (watch->met < 0 || count->first <= watch->met);
        const bool few = 2 * count->fell < count->bodies - dropped;
        reading.verdict = by_itself || !watch->struck || few ? VERDICT_FALLS : VERDICT_COLLAPSES;
        reading.frame = count->first;
        reading.body = count->body;
        reading.value = count->fell;
        reading.unit = "boxes";
    } else if (watch->struck && dropped < count->bodies) {
        reading.verdict = VERDICT_STANDS;
        if (reading.frame < watch->met) reading.frame = watch->met;
    } else {
        reading.verdict = reading.too_short ? VERDICT_TOO_SHORT : reading.moving ? VERDICT_MOVES : VERDICT_SETTLES;
        if (reading.moving) reading.body = last;
    }
    return reading;
}
