/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Watches a run: places, rest, what carries what, what fell. */
#include "runs/verdict.h"

#include "base/base.h"
#include "engine/engine.h"
#include "runs/runs.h"
#include "runs/verdict_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A body moves within its place by this share of its size: a pixel of a box that is drawn with 50. */
static const double place_share = 0.02;
/* Half a side lower, a box has lost its layer. At 30 degrees a square's centre has risen by nine tenths of what turns
   it over. */
static const double fall_share = 0.5, fall_turn = 30 * M_PI / 180;
static const double rest_share = 0.5;   /* of the pace before: constant gliding has all of it */
static const double moved_share = 0.1;  /* of a size: seen at a glance */
static const double touch_share = 0.03; /* of a side: less is not seen */
static const double unit_sizes = 5;     /* a box of 1 m: one second */

const char *const verdict_words[VERDICTS + 2] = {
    "settles", "stands", "moves",   "too short", "undecided",  "falls",          "collapses",
    "hangs",   "sinks",  "tunnels", "explodes",  "non-finite", "adapter failed", "not applicable"};

const char *verdict_name(Verdict verdict) { return verdict_words[verdict]; }

bool verdict_holds(Verdict verdict) { return verdict <= VERDICT_MOVES; }

bool verdict_sound(Verdict verdict) { return verdict < VERDICT_HANGS; }

static double size_of(const Body *body) { return sqrt((double)body->size.x * (double)body->size.y); }

void verdict_watch_free(VerdictWatch *watch) {
    free(watch->bodies);
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

double way_past(const WatchedBody *a, const WatchedBody *b) {
    const Vec2 of_a = vec2_sub(a->last.at, a->before.at), of_b = vec2_sub(b->last.at, b->before.at);
    return vec2_distance(of_a, of_b) + turn_between(&a->last, &a->before) * a->corner +
           turn_between(&b->last, &b->before) * b->corner;
}

/* m: how deep two bodies are in each other; negative: apart, -INFINITY: by more than `within`, m. */
static double depth_of(const WatchedBody *a, const WatchedBody *b, double within) {
    if (vec2_distance(a->last.at, b->last.at) > a->corner + b->corner + within) return -INFINITY;
    const Box of_a = box_of(a, &a->last), of_b = box_of(b, &b->last);
    return overlap_depth(&of_a, &of_b);
}

bool bodies_touch(const VerdictWatch *watch, const WatchedBody *a, const WatchedBody *b) {
    const double gap = way_past(a, b) + touch_share * fmin(a->side, b->side) + 2 * (double)watch->run.skin;
    return depth_of(a, b, gap) > -gap;
}

bool find_near(VerdictWatch *watch, double way, Error *error) {
    ContactFinder *finder = &watch->finder;
    if (!contact_finder_reserve(finder, watch->body_count, error)) return false;
    for (int i = 0; i < watch->body_count; i++) {
        const WatchedBody *body = &watch->bodies[i];
        const float down = (float)larger(way, fall_share * body->side);
        const Vec2 a = body->before.at, b = vec2_sub(body->last.at, vec2_scale(down, watch->up));
        const float r = (float)(body->corner * (1 + touch_share)) + watch->run.skin;
        finder->bounds[i] =
            (Bounds){vec2(fminf(a.x, b.x) - r, fminf(a.y, b.y) - r), vec2(fmaxf(a.x, b.x) + r, fmaxf(a.y, b.y) + r)};
        finder->fixed[i] = body->is_static;
    }
    return contact_finder_pairs(finder, watch->body_count, error);
}

/* m: how far a body moves down until it touches another; INFINITY: it never does. */
static double gap_above(const VerdictWatch *watch, const WatchedBody *body, const WatchedBody *other) {
    const double rounding = 1e-3 * body->side; /* m: neighbours do not touch */
    const Box box = box_of(body, &body->last), under = box_of(other, &other->last);
    const OverlapSpan span = overlap_span(&under, &box, vec2_negate(watch->up), rounding, false);
    return span.from < span.to && span.to >= 0 ? larger(span.from, 0) : INFINITY;
}

/* What carries the bodies that nothing has carried so far, from their poses of now on. What starts at rest may move
   down by `way`, m. On what nothing carries, nothing is carried either. */
static bool find_carriers(VerdictWatch *watch, double way, Error *error) {
    if (watch->pull == 0) return true;
    if (!find_near(watch, way, error)) return false;
    for (int i = 0; i < watch->body_count; i++) {
        WatchedBody *body = &watch->bodies[i];
        if (isinf(body->gaps)) body->start = body->last, body->carrier = -1, body->gap = INFINITY;
    }
    for (size_t k = 0; k < 2 * watch->finder.pairs.count; k++) {
        const BodyPair pair = watch->finder.pairs.pairs[k / 2];
        const int i = k % 2 == 0 ? pair.a : pair.b, j = k % 2 == 0 ? pair.b : pair.a;
        WatchedBody *body = &watch->bodies[i];
        const WatchedBody *other = &watch->bodies[j];
        const bool lower = other->is_static || height_of(watch, &other->last) < height_of(watch, &body->last);
        if (isfinite(body->gaps) || body->is_static || body->is_bomb || other->is_bomb || !lower) continue;
        const double gap = gap_above(watch, body, other);
        if (gap > larger(body->starts ? 0 : way, fall_share * body->side) || gap >= body->gap) continue;
        body->gap = gap;
        body->carrier = j;
    }
    for (int i = 0; i < watch->body_count; i++) {
        double gaps = 0;
        for (int k = i; k >= 0 && !watch->bodies[k].is_static; k = watch->bodies[k].carrier)
            gaps += watch->bodies[k].gap;
        watch->bodies[i].gaps = gaps;
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
    if (!array_reserve((void **)&watch->bodies, &watch->capacity, (size_t)count, sizeof *watch->bodies))
        return error_memory(error, "verdict");
    /* By then what goes so fast has gone as far as it would have to fall. */
    const double slowest = fall_share * watch->mean / watch->unit;
    for (int i = watch->body_count; i < count; i++) {
        const Body *from = &bodies[i];
        WatchedBody *body = &watch->bodies[i];
        const Pose pose = pose_of(from);
        const double speed = vec2_distance(from->velocity, vec2(0, 0)), spin = from->angular_velocity;
        *body = (WatchedBody){.box = from->size,
                              .size = size_of(from),
                              .side = fmin((double)from->size.x, (double)from->size.y),
                              .corner = vec2_distance(from->size, vec2(0, 0)) / 2,
                              .last = pose,
                              .before = pose,
                              .place = {pose, frame},
                              .lately = {{pose, frame}, {pose, frame}},
                              .start = pose,
                              .carrier = -1,
                              .gap = INFINITY,
                              .gaps = INFINITY,
                              .is_static = from->inv_mass == 0,
                              .is_bomb = i == watch->run.bomb};
        watch->smallest = fmin(watch->smallest, body->side);
        if (body->is_static) {
            const Box box = box_of(body, &pose);
            watch->floor = fmin(watch->floor, height_of(watch, &pose) - box_reach(&box, watch->up));
            continue;
        }
        if (isinf(watch->lowest)) watch->lowest = height_of(watch, &pose);
        body->mass = 1 / (double)from->inv_mass;
        body->inertia = 1 / (double)from->inv_inertia;
        body->energy = body_energy(from, watch->run.gravity);
        body->starts = frame == 0 && !body->is_bomb && speed + fabs(spin) * body->corner > slowest;
        watch->liveliest = larger(watch->liveliest, body->energy / body->mass - watch->pull * watch->lowest);
        watch->weight += body->mass * watch->pull;
        if (energy_counts(watch, body)) count_energy(watch, body);
    }
    watch->body_count = count;
    return true;
}

bool verdict_watch_begin(VerdictWatch *watch, const VerdictRun *run, const Body *bodies, int count, Error *error) {
    const double pull = vec2_distance(run->gravity, vec2(0, 0));
    *watch = (VerdictWatch){.run = *run,
                            .worst = {.body = -1, .other = -1, .unit = "m/s"},
                            .pull = pull,
                            .up = pull > 0 ? vec2_scale((float)(-1 / pull), run->gravity) : vec2(0, 1),
                            .smallest = INFINITY,
                            .floor = INFINITY,
                            .lowest = INFINITY,
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
    const double way = unit_sizes * watch->mean; /* m: what starts at rest falls so far in a unit */
    return find_carriers(watch, way, error) &&
           (!run->finds_contacts || contact_finder_find(&watch->finder, bodies, count, run->skin, error));
}

/* Gives the bodies their new poses. False if one is not finite. */
static bool move_bodies(VerdictWatch *watch, const VerdictStep *step, double *farthest) {
    const int half = steps_of(watch, long_units);
    *farthest = 0;
    for (int i = 0; i < step->body_count; i++) {
        WatchedBody *body = &watch->bodies[i];
        const Body *now = &step->bodies[i];
        const double sum = (double)now->position.x + now->position.y + now->angle + now->velocity.x + now->velocity.y +
                           now->angular_velocity;
        if (!isfinite(sum)) {
            verdict_note(watch, VERDICT_NON_FINITE, i, watch->speed, "m/s");
            return false;
        }
        if (body->is_static) continue;
        body->before = body->last;
        body->last = pose_of(now);
        *farthest = larger(*farthest, way_of(body, &body->before));
        const Place now_here = {body->last, step->frame};
        if (way_of(body, &body->place.pose) > place_share * body->size) {
            body->stays[0] = body->stays[1];
            body->stays[1] = step->frame - body->place.frame;
            body->place = body->lately[0] = body->lately[1] = now_here;
        } else if (step->frame % half == 0) {
            body->lately[1] = body->lately[0];
            body->lately[0] = now_here;
        }
    }
    return true;
}

/* A body that is listed before its carrier falls with it in the next step. */
static bool has_fallen(const VerdictWatch *watch, const WatchedBody *body) {
    if (body->left) return true;
    if (isinf(body->gaps)) return false;
    if (turn_between(&body->last, &body->start) > fall_turn) return true;
    const WatchedBody *below = &watch->bodies[body->carrier];
    const double limit = fall_share * body->side;
    const double drop = height_of(watch, &body->start) - height_of(watch, &body->last);
    if (drop <= limit + body->gaps) return false;
    if (below->fell > 0) return true;
    const double sag = height_of(watch, &below->start) - height_of(watch, &below->last);
    return drop - sag - larger(0, depth_of(body, below, 0)) > limit + body->gap;
}

static void judge_falls(VerdictWatch *watch) {
    for (int i = 0; i < watch->body_count; i++) {
        WatchedBody *body = &watch->bodies[i];
        if (body->is_static) continue;
        body->left = watch->pull > 0 && height_of(watch, &body->last) + body->corner < watch->floor;
        body->fell = !has_fallen(watch, body) ? 0 : body->fell > 0 ? body->fell : watch->frame;
    }
}

bool verdict_watch_step(VerdictWatch *watch, const VerdictStep *given, Error *error) {
    const VerdictRun *run = &watch->run;
    VerdictStep step = *given;
    double farthest;
    if (run->finds_contacts) {
        step.contacts = watch->finder.set.contacts;
        step.contact_count = watch->finder.set.contact_count;
    }
    if (watch->worst.verdict >= VERDICT_NON_FINITE) return true;
    watch->frame = step.frame;
    while (watch->body_count > step.body_count) /* what is removed takes its energy along */
        if (energy_counts(watch, &watch->bodies[--watch->body_count]))
            watch->brought -= watch->bodies[watch->body_count].energy;
    if (!check_contacts(watch, &step, error)) return false;
    const int had = watch->body_count;
    if (!add_bodies(watch, step.bodies, step.body_count, step.frame, error)) return false;
    if (!move_bodies(watch, &step, &farthest)) return true;
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
    if (!check_hanging(watch, &step, error)) return false;
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

bool verdict_watch_is_final(const VerdictWatch *watch) { return watch->worst.verdict >= VERDICT_EXPLODES; }

bool verdict_watch_fell(const VerdictWatch *watch, int i) {
    const WatchedBody *body = &watch->bodies[i];
    return i < watch->body_count && !body->is_static && !body->is_bomb && body->fell > 0;
}

/* Whether a body has just taken its place, or goes on at the pace of the two places before. */
static bool is_moving(const VerdictWatch *watch, const WatchedBody *body) {
    if (watch->frame - body->place.frame < steps_of(watch, long_units)) return true;
    const double shorter = fmin(body->stays[0], body->stays[1]), steps = watch->frame - body->lately[1].frame;
    return way_of(body, &body->lately[1].pose) * shorter > rest_share * place_share * body->size * steps;
}

/* Counts, rest and figures; then, of a sound run, the word. */
VerdictReading verdict_watch_end(const VerdictWatch *watch) {
    VerdictReading reading = watch->worst;
    VerdictCount *count = &reading.count;
    const int least = steps_of(watch, long_units);
    const bool after = watch->rested_frame > 0 && watch->frame > watch->rested_frame;
    int dropped = 0, last = -1;
    count->body = -1;
    reading.drift = after ? 0 : NAN;
    for (int i = 0; i < watch->body_count; i++) {
        const WatchedBody *body = &watch->bodies[i];
        if (after) reading.drift = larger(reading.drift, vec2_distance(body->rested.at, body->last.at));
        if (body->is_static || body->is_bomb) continue;
        count->bodies++;
        dropped += isinf(body->gaps);
        count->fell += body->fell > 0;
        count->left += body->left;
        if (body->fell > 0 && (count->body < 0 || body->fell < count->first))
            count->first = body->fell, count->body = i;
        const Vec2 moved = vec2_sub(body->last.at, body->start.at);
        const double way = hypot((double)vec2_cross(moved, watch->up), larger(0, (double)vec2_dot(moved, watch->up)));
        if (body->fell == 0 && isfinite(body->gaps) && way > moved_share * body->size) {
            count->moved++;
            count->farthest = larger(count->farthest, way);
        }
        reading.moving |= is_moving(watch, body);
        if (last < 0 || body->place.frame > watch->bodies[last].place.frame) last = i;
    }
    reading.struck = watch->struck;
    reading.since = last >= 0 ? watch->bodies[last].place.frame : 0;
    reading.too_short = watch->frame < least && reading.since == 0 && count->bodies > 0;
    reading.fallbacks = watch->fallbacks;
    reading.deepest = watch->deepest;
    reading.excess = energy_is_judged(watch) ? larger(watch->excess, 0) : NAN;
    reading.steps = watch->frame;
    reading.energy = watch->energy;
    reading.gained = after ? watch->energy - watch->rested : NAN;
    reading.by_itself = count->fell > 0 && watch->run.bomb >= 0 && (watch->met < 0 || count->first <= watch->met);
    if (reading.verdict >= VERDICT_HANGS) return reading;
    reading.value = watch->speed;
    reading.frame = reading.moving || reading.too_short ? watch->frame : reading.since;
    if (count->fell > 0) {
        const bool few = 2 * count->fell < count->bodies - dropped;
        reading.verdict = reading.by_itself || !watch->struck || few ? VERDICT_FALLS : VERDICT_COLLAPSES;
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
