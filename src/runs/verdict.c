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
static const double moved_share = 0.1;   /* of a size: seen at a glance */
static const double carrier_reach = 0.5; /* of a side; a gap beyond that is a drop */
static const double slow_share = 0.25;   /* of the speed of a fall by a body's size: it drops, and does not fly */
static const double start_share = 0.005; /* of a size in a unit: the body starts with a speed */
static const double start_poses = 0.5;   /* the same of differences of poses, which have the first step's impulses */
static const double unit_sizes = 5;      /* a box of 1 m: one second */

const char *const verdict_words[VERDICTS + 2] = {
    "settles", "agrees",    "stands",       "moves",          "too short",     "undecided",
    "falls",   "collapses", "too few fall", "too many fall",  "hangs",         "sinks",
    "tunnels", "explodes",  "non-finite",   "adapter failed", "not applicable"};

const char *verdict_name(Verdict verdict) { return verdict_words[verdict]; }

bool verdict_holds(Verdict verdict) { return verdict <= VERDICT_MOVES; }

bool verdict_sound(Verdict verdict) { return verdict < VERDICT_HANGS; }

double verdict_size(const Body *body) { return sqrt((double)body->size.x * (double)body->size.y); }

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

/* m: how far the box reaches along a direction, from its middle. */
static double reach_along(double x, double y, const WatchedBody *body, const Pose *pose) {
    const double c = cos(pose->angle), s = sin(pose->angle);
    return (fabs(c * x + s * y) * (double)body->box.x + fabs(c * y - s * x) * (double)body->box.y) / 2;
}

static double reach_up(const VerdictWatch *watch, const WatchedBody *body, const Pose *pose) {
    return reach_along(watch->up_x, watch->up_y, body, pose);
}

static double reach_across(const VerdictWatch *watch, const WatchedBody *body, const Pose *pose) {
    return reach_along(watch->up_y, -watch->up_x, body, pose);
}

static Vec2 moved_down(const VerdictWatch *watch, Vec2 from, double way) {
    return vec2_sub(from, vec2((float)(watch->up_x * way), (float)(watch->up_y * way)));
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
    for (int i = watch->body_count; i < count; i++) {
        const Body *from = &bodies[i];
        WatchedBody *body = &watch->bodies[i];
        const double x = from->position.x, y = from->position.y, w = from->size.x, h = from->size.y;
        const Pose pose = {x, y, from->angle};
        *body = (WatchedBody){.box = from->size,
                              .size = sqrt(w * h),
                              .side = fmin(w, h),
                              .corner = sqrt(w * w + h * h) / 2,
                              .last = pose,
                              .before = pose,
                              .prior = pose,
                              .place = pose,
                              .reference = pose,
                              .since = frame,
                              .stays = {INT_MAX, INT_MAX},
                              .carrier = -1,
                              .held = frame,
                              .is_static = from->inv_mass == 0,
                              .is_bomb = i == watch->run.bomb};
        const double up = height_of(watch, &pose);
        if (body->is_static) {
            const double across = across_of(watch, &pose), reach = reach_across(watch, body, &pose);
            watch->floor = fmin(watch->floor, up - reach_up(watch, body, &pose));
            watch->low = fmin(watch->low, across - reach);
            watch->high = larger(watch->high, across + reach);
            continue;
        }
        watch->smallest = fmin(watch->smallest, body->side);
        if (frame == 0) watch->lowest = fmin(watch->lowest, up);
    }
    for (int i = watch->body_count; i < count; i++)
        if (bodies[i].inv_mass != 0) energy_add_body(watch, &bodies[i], &watch->bodies[i]);
    watch->body_count = count;
    return true;
}

/* By how much body i must move down until it touches j; INFINITY: farther than `reach`. What separates two boxes is no
   more than the way until they touch. */
static double way_down(const VerdictWatch *watch, int i, int j, const Box *of_i, const Box *of_j, double reach) {
    enum { STEPS = 100 };
    const WatchedBody *body = &watch->bodies[i], *below = &watch->bodies[j];
    const double beside = fabs(across_of(watch, &body->last) - across_of(watch, &below->last));
    if (beside >= reach_across(watch, body, &body->last) + reach_across(watch, below, &below->last)) return INFINITY;
    Box box = *of_i;
    double way = 0;
    for (int k = 0; k < STEPS && way <= reach; k++) {
        const double apart = -overlap_depth(&box, of_j);
        if (apart <= 1e-3 * body->side) return way;
        way += apart;
        box.position = moved_down(watch, of_i->position, way);
    }
    return INFINITY;
}

/* Gives a body its carrier, behind it in the order. */
static void give_carrier(VerdictWatch *watch, int i, int carrier, double gap) {
    WatchedBody *body = &watch->bodies[i];
    const WatchedBody *below = &watch->bodies[carrier];
    body->carrier = carrier;
    body->gap = gap;
    body->gaps = gap + (below->is_static ? 0 : below->gaps);
    body->reference = body->last;
    body->carrier_up = height_of(watch, &below->last);
    watch->order[watch->carried++] = i;
}

typedef struct Below {
    int body, on; /* on: what it would touch first; -1: nothing */
    double gap;   /* m: until then */
    double up;    /* m: height of `on`, -INFINITY for a static body, which comes first; then of the body */
} Below;

static int by_height(const void *a, const void *b) {
    const Below *one = a, *other = b;
    return one->up != other->up ? (one->up > other->up ? 1 : -1) : one->body - other->body;
}

/* Whether i needs what j could give: a carrier. What flies sideways gets none. */
static bool may_carry(const VerdictWatch *watch, int j, int i) {
    const WatchedBody *body = &watch->bodies[i];
    return !body->is_static && !body->is_bomb && body->carrier < 0 && !watch->bodies[j].is_bomb &&
           fabs(across_of(watch, &body->last) - across_of(watch, &body->before)) <
               slow_share * sqrt(2 * watch->pull * body->size) * (double)watch->run.dt;
}

/* The bodies without a carrier get one: what they touch first if they move down by up to this way, m, or by half their
   side; or else what holds them from the side. Poses are the last ones. */
static bool find_carriers(VerdictWatch *watch, double way, Error *error) {
    const size_t count = (size_t)watch->body_count;
    SortAndSweep sweep = {0};
    PairList pairs = {0};
    Box *boxes = calloc(count + 1, sizeof *boxes);
    Bounds *bounds = malloc((count + 1) * sizeof *bounds);
    bool *fixed = malloc(count + 1);
    Below *below = calloc(count + 1, sizeof *below);
    bool ok = boxes != NULL && bounds != NULL && fixed != NULL && below != NULL;
    for (size_t i = 0; ok && i < count; i++) {
        const WatchedBody *body = &watch->bodies[i];
        boxes[i] = box_of(body, &body->last);
        bounds[i] = bounds_of_box(&boxes[i]);
        const Vec2 reach = moved_down(watch, vec2(0, 0), larger(way, carrier_reach * body->side));
        const float margin = (float)(touch_share * body->side);
        bounds[i].low = vec2_add(bounds[i].low, vec2(fminf(reach.x, 0) - margin, fminf(reach.y, 0) - margin));
        bounds[i].high = vec2_add(bounds[i].high, vec2(fmaxf(reach.x, 0) + margin, fmaxf(reach.y, 0) + margin));
        fixed[i] = body->is_static;
        below[i] = (Below){.body = (int)i, .on = -1, .gap = INFINITY};
    }
    ok = ok && sort_and_sweep_find(&sweep, &pairs, bounds, fixed, (int)count);
    for (size_t k = 0; ok && k < 2 * pairs.count; k++) {
        const BodyPair pair = pairs.pairs[k / 2];
        const int i = k % 2 == 0 ? pair.a : pair.b, j = k % 2 == 0 ? pair.b : pair.a;
        const WatchedBody *body = &watch->bodies[i], *other = &watch->bodies[j];
        const double up = other->is_static ? -INFINITY : height_of(watch, &other->last);
        if (!may_carry(watch, j, i) || up >= height_of(watch, &body->last)) continue;
        const double gap = way_down(watch, i, j, &boxes[i], &boxes[j], larger(way, carrier_reach * body->side));
        const double alike = 0.1 * body->side; /* gaps that differ by less are equal */
        if (isinf(gap) || gap > below[i].gap + alike) continue;
        if (below[i].on < 0 || gap < below[i].gap - alike || up < below[i].up) below[i] = (Below){i, j, gap, up};
    }
    for (size_t i = 0; ok && i < count; i++) below[i].up = height_of(watch, &watch->bodies[i].last);
    if (ok) qsort(below, count, sizeof *below, by_height);
    for (size_t k = 0; ok && k < count; k++) /* upwards */
        if (below[k].on >= 0 && (watch->bodies[below[k].on].is_static || watch->bodies[below[k].on].carrier >= 0))
            give_carrier(watch, below[k].body, below[k].on, below[k].gap);
    bool more = ok;
    for (int pass = 0; more; pass++) { /* sideways; to and fro, so that a row that is listed from either end is quick */
        more = false;
        for (size_t n = 0; n < 2 * pairs.count; n++) {
            const size_t k = pass % 2 == 0 ? n : 2 * pairs.count - 1 - n;
            const BodyPair pair = pairs.pairs[k / 2];
            const int i = k % 2 == 0 ? pair.a : pair.b, j = k % 2 == 0 ? pair.b : pair.a;
            const WatchedBody *other = &watch->bodies[j];
            if (!may_carry(watch, j, i) || (!other->is_static && other->carrier < 0)) continue;
            const double depth = overlap_depth(&boxes[i], &boxes[j]), side = fmin(watch->bodies[i].side, other->side);
            if (depth < -touch_share * side || depth > fall_share * side) continue;
            give_carrier(watch, i, j, 0);
            more = true;
        }
    }
    free(below);
    free(fixed);
    free(bounds);
    free(boxes);
    free(pairs.pairs);
    const bool too_many = sweep.too_many;
    sort_and_sweep_free(&sweep);
    if (too_many)
        return error_input(error, "verdict", "more than %d pairs of boxes overlap, or nearly", BROAD_PHASE_MAX_PAIRS);
    return ok || error_memory(error, "verdict");
}

bool verdict_watch_begin(VerdictWatch *watch, const VerdictRun *run, const Body *bodies, int count, Error *error) {
    const VerdictWatch old = *watch;
    const double x = run->gravity.x, y = run->gravity.y, pull = sqrt(x * x + y * y);
    *watch = (VerdictWatch){.run = *run,
                            .worst = {.body = -1, .other = -1, .unit = "m/s"},
                            .pull = pull,
                            .up_x = pull > 0 ? -x / pull : 0,
                            .up_y = pull > 0 ? -y / pull : 1,
                            .smallest = INFINITY,
                            .floor = INFINITY,
                            .low = INFINITY,
                            .high = -INFINITY,
                            .lowest = INFINITY,
                            .kept = INFINITY,
                            .met = -1,
                            .bodies = old.bodies,
                            .order = old.order,
                            .deep = old.deep,
                            .finder = old.finder,
                            .capacity = old.capacity,
                            .order_capacity = old.order_capacity,
                            .deep_capacity = old.deep_capacity};
    double sizes = 0;
    int moving = 0, starting = 0;
    for (int i = 0; i < count; i++) {
        if (bodies[i].inv_mass == 0 || i == run->bomb) continue;
        sizes += verdict_size(&bodies[i]);
        moving++;
        watch->fastest = larger(watch->fastest, vec2_distance(bodies[i].velocity, vec2(0, 0)));
    }
    watch->mean = moving > 0 ? sizes / moving : 1;
    set_unit(watch);
    if (!add_bodies(watch, bodies, count, 0, error)) return false;
    const double slowest = (run->poses_only ? start_poses : start_share) * watch->mean / larger(watch->unit, 1e-9);
    for (int i = 0; i < count; i++) {
        WatchedBody *body = &watch->bodies[i];
        body->starts = !body->is_static && !body->is_bomb && vec2_distance(bodies[i].velocity, vec2(0, 0)) > slowest;
        starting += body->starts;
    }
    watch->struck = (run->bomb >= 0 && moving > 0) || (starting > 0 && starting < moving);
    if (pull > 0 && !find_carriers(watch, 0, error)) return false;
    return !run->finds_contacts || contact_finder_find(&watch->finder, bodies, count, run->skin, error);
}

/* Whether a body is beside all static bodies, and all that chains of contacts join to them. */
static bool is_beside(const VerdictWatch *watch, const WatchedBody *body) {
    const double across = across_of(watch, &body->last), low = across - body->corner, high = across + body->corner;
    if (body->held == watch->frame || (high > watch->low && low < watch->high)) return false;
    bool all_lower = true, all_higher = true;
    for (int i = 0; i < watch->body_count; i++) {
        const WatchedBody *other = &watch->bodies[i];
        if (other->is_static || other->held != watch->frame) continue;
        const double at = across_of(watch, &other->last);
        all_lower &= at + other->corner < low;
        all_higher &= at - other->corner > high;
    }
    return (low > watch->high && all_lower) || (high < watch->low && all_higher);
}

/* Whether a body is lower than half its side below its reference, or has turned, or left the scene. Bodies come behind
   what carries them. */
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
            fell = drop - sag > limit + body->gap || below->fell > 0;
        }
        body->fell = !fell ? 0 : body->fell > 0 ? body->fell : watch->frame;
    }
    for (int i = 0; watch->pull > 0 && isfinite(watch->floor) && i < watch->body_count; i++) {
        WatchedBody *body = &watch->bodies[i];
        if (body->is_static) continue;
        const double up = height_of(watch, &body->last);
        body->gone = up < watch->floor && up + reach_up(watch, body, &body->last) < watch->floor;
        body->left = body->gone || is_beside(watch, body);
        if (body->left && body->fell == 0) body->fell = watch->frame;
        if (!body->left && body->carrier < 0) body->fell = 0;
    }
}

/* Whether the bomb may have touched a dynamic body in this step: afterwards their gap is no wider than they moved. */
static bool strikes(const VerdictWatch *watch, const VerdictStep *step) {
    const int bomb = watch->run.bomb;
    const Box box = box_make(step->bodies[bomb].position, step->bodies[bomb].size, step->bodies[bomb].angle);
    const WatchedBody *striker = &watch->bodies[bomb];
    for (int i = 0; i < watch->body_count && i < step->body_count; i++) {
        const WatchedBody *body = &watch->bodies[i];
        const Body *now = &step->bodies[i], *bomb_now = &step->bodies[bomb];
        if (body->is_static || i == bomb) continue;
        const double x = (double)now->position.x - body->last.x - ((double)bomb_now->position.x - striker->last.x),
                     y = (double)now->position.y - body->last.y - ((double)bomb_now->position.y - striker->last.y);
        const double way = sqrt(x * x + y * y) + fabs(turn_between(now->angle, body->last.angle)) * body->corner +
                           fabs(turn_between(bomb_now->angle, striker->last.angle)) * striker->corner;
        const double gap = way + touch_share * fmin(body->side, striker->side) + 2 * (double)watch->run.skin;
        if (vec2_distance(now->position, bomb_now->position) > body->corner + striker->corner + gap) continue;
        const Box other = box_make(now->position, now->size, now->angle);
        if (-overlap_depth(&box, &other) < gap) return true;
    }
    return false;
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
        if (watch->bodies[--watch->body_count].counted) watch->brought -= watch->bodies[watch->body_count].energy;
    const int had = watch->body_count;
    if (!add_bodies(watch, step.bodies, step.body_count, step.frame, error)) return false;
    if (watch->met < 0 && run->bomb >= 0 && run->bomb < had && strikes(watch, &step)) {
        /* The bomb brings its energy, and what drops is judged from here on: it would fall that far in a unit. */
        watch->met = step.frame - 1;
        energy_count(watch, &watch->bodies[run->bomb]);
        if (watch->pull > 0 && !find_carriers(watch, unit_sizes * watch->mean, error)) return false;
    }
    double farthest = 0; /* m: what a corner has moved in this step */
    for (int i = 0; i < step.body_count; i++) {
        WatchedBody *body = &watch->bodies[i];
        if (body->is_static) body->held = step.frame;
        if (body->is_static) continue;
        const Body *now = &step.bodies[i];
        const Pose pose = {now->position.x, now->position.y, now->angle};
        const double x = pose.x - body->place.x, y = pose.y - body->place.y;
        const double free = place_share * body->size - fabs(turn_between(pose.angle, body->place.angle)) * body->corner;
        if (free < 0 || x * x + y * y > free * free) {
            body->stays[0] = body->stays[1];
            body->stays[1] = step.frame - body->since;
            body->since = step.frame;
            body->place = pose;
        }
        const double turn = fabs(turn_between(pose.angle, body->last.angle));
        farthest = larger(farthest, way_between(&pose, &body->last) + turn * body->corner);
        body->prior = body->before;
        body->before = body->last;
        body->last = pose;
    }
    watch->fastest = larger(watch->fastest, farthest / (double)run->dt);
    set_unit(watch);
    if (!check_depth(watch, &step, error) ||
        (farthest > pass_share / 2 * watch->smallest && !check_passes(watch, error)))
        return false;
    check_energy(watch, &step);
    judge_falls(watch);
    if (step.frame % steps_of(watch, hang_units / HANG_CHECKS) == 0 && !check_hanging(watch, step.bodies, error))
        return false;
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
    static const char before[] = "adapter failed: ";
    if (watch->worst.verdict >= VERDICT_NON_FINITE) return;
    watch->frame = frame;
    if (failure->failure != FAILURE_ADAPTER) {
        verdict_note(watch, VERDICT_NON_FINITE, -1, watch->speed, "m/s");
        return;
    }
    verdict_note(watch, VERDICT_ADAPTER_FAILED, -1, watch->speed, "m/s");
    /* Without the place, which is that of the verdict. */
    const char *text = strstr(failure->message, before), *place = NULL;
    text = text != NULL ? text + strlen(before) : failure->message;
    for (const char *at = strstr(text, ", in step "); at != NULL; at = strstr(at + 1, ", in step ")) place = at;
    char whole[sizeof failure->message];
    snprintf(whole, sizeof whole, "%.*s", (int)(place != NULL ? (size_t)(place - text) : strlen(text)), text);
    snprintf(watch->worst.reason, VERDICT_REASON_SIZE, "%.*s", (int)utf8_cut(whole, VERDICT_REASON_SIZE - 1), whole);
}

double verdict_watch_units(const VerdictWatch *watch, double units) {
    return steps_of(watch, units) * (double)watch->run.dt;
}

bool verdict_watch_is_final(const VerdictWatch *watch) { return watch->worst.verdict >= VERDICT_EXPLODES; }

bool verdict_watch_fell(const VerdictWatch *watch, int i) {
    const WatchedBody *body = &watch->bodies[i];
    return i < watch->body_count && !body->is_static && !body->is_bomb && body->fell > 0;
}

VerdictReading verdict_watch_end(const VerdictWatch *watch) {
    VerdictReading reading = watch->worst;
    VerdictCount count = {.body = -1};
    const int least = steps_of(watch, rest_units);
    int dropped = 0, staying = 0, starting = 0, last = -1;
    bool still = true, moved = false;
    for (int i = 0; i < watch->body_count; i++) {
        const WatchedBody *body = &watch->bodies[i];
        if (body->is_static || body->is_bomb) continue;
        count.bodies++;
        dropped += body->carrier < 0;
        starting += body->starts;
        count.fell += body->fell > 0;
        count.left += body->left;
        if (body->fell > 0 && (count.body < 0 || body->fell < count.first)) count.first = body->fell, count.body = i;
        const double x = body->last.x - body->reference.x, y = body->last.y - body->reference.y;
        const double beside = x * watch->up_y - y * watch->up_x, above = larger(0, x * watch->up_x + y * watch->up_y);
        const double way = sqrt(beside * beside + above * above);
        if (body->fell == 0 && body->carrier >= 0 && way > moved_share * body->size) {
            count.moved++;
            count.farthest = larger(count.farthest, way);
        }
        if (body->gone) continue;
        const int stay = watch->frame - body->since,
                  shorter = body->stays[0] < body->stays[1] ? body->stays[0] : body->stays[1];
        const bool known = body->stays[0] != INT_MAX && body->stays[1] != INT_MAX;
        staying++;
        moved |= body->since > 0;
        still &= stay >= least && (!known || stay > 2 * shorter);
        if (last < 0 || body->since > watch->bodies[last].since) last = i;
    }
    reading.count = count;
    reading.struck = watch->struck;
    reading.too_short = watch->frame < least && !moved && staying > 0;
    reading.moving = !still;
    reading.since = last >= 0 ? watch->bodies[last].since : 0;
    reading.fallbacks = watch->fallbacks;
    reading.deepest = watch->deepest;
    reading.excess = energy_is_judged(watch) ? larger(watch->excess, 0) : NAN;
    reading.drift = reading.gained = NAN;
    if (watch->rested_frame > 0 && watch->frame > watch->rested_frame) {
        reading.drift = 0;
        reading.gained = watch->energy - watch->rested;
        for (int i = 0; i < watch->body_count; i++)
            reading.drift = larger(reading.drift, way_between(&watch->bodies[i].rested, &watch->bodies[i].last));
    }
    if (reading.verdict >= VERDICT_HANGS) return reading;
    reading.body = -1;
    reading.value = watch->speed;
    reading.unit = "m/s";
    if (count.fell > 0) {
        const bool by_itself = watch->run.bomb >= 0 && starting == 0 && (watch->met < 0 || count.first <= watch->met);
        reading.verdict =
            by_itself || !watch->struck || 2 * count.fell < count.bodies - dropped ? VERDICT_FALLS : VERDICT_COLLAPSES;
        reading.frame = count.first;
        reading.body = count.body;
        reading.value = count.fell;
        reading.unit = "boxes";
    } else if (watch->struck && dropped < count.bodies) {
        reading.verdict = VERDICT_STANDS;
        reading.frame = still && reading.since > watch->met ? reading.since
                        : still && watch->met > 0           ? watch->met
                                                            : watch->frame;
    } else {
        reading.verdict = reading.too_short ? VERDICT_TOO_SHORT : still ? VERDICT_SETTLES : VERDICT_MOVES;
        reading.frame = still && !reading.too_short ? reading.since : watch->frame;
        if (!still) reading.body = last;
    }
    return reading;
}
