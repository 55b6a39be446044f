/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether the physics of a run is sound: finite, no energy from nothing, nothing in or through another, nothing that
   hangs in the air. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/runs.h"
#include "runs/verdict.h"
#include "runs/verdict_internal.h"
#include "scenes/scenes.h"

#include <math.h>

/* Of the energy that is available to be lost: what the solver's penetrations store and release again is less. */
static const double gain_share = 0.01;
static const double burst_factor = 5;  /* a heavy body's elastic blow gives a light one 4 times its energy per kg */
static const double least_share = 0.1; /* of a size: at least what lifts all bodies so far is available */
static const double deep_share = 0.25; /* of a side: an impact's penetration is less, or is corrected sooner */
/* float32 rounds a position by 6e-8 of it; its steps add up like a random walk. */
static const double rounding = 1e-6;

void verdict_note(VerdictWatch *watch, Verdict verdict, int body, double value, const char *unit) {
    if (verdict <= watch->worst.verdict) return;
    watch->worst = (VerdictReading){
        .verdict = verdict, .frame = watch->frame, .body = body, .value = value, .unit = unit, .other = -1};
}

void count_energy(VerdictWatch *watch, const WatchedBody *body) {
    watch->brought += body->energy;
    watch->available += body->energy - body->mass * watch->pull * watch->lowest;
}

void check_energy(VerdictWatch *watch, const VerdictStep *step) {
    const double dt = (double)watch->run.dt;
    const double noise = rounding * watch->farthest / dt;                                               /* m/s */
    const double burst = burst_factor * (watch->liveliest + watch->pull * watch->mean) + noise * noise; /* J/kg */
    double gained = -watch->brought, most = 0;                                                          /* J */
    int hottest = -1;
    watch->speed = watch->energy = 0;
    for (int i = 0; i < step->body_count; i++) {
        WatchedBody *body = &watch->bodies[i];
        const Body *now = &step->bodies[i];
        if (body->is_static) continue;
        const double vx = now->velocity.x, vy = now->velocity.y, spin = now->angular_velocity;
        const double speed = sqrt(vx * vx + vy * vy), up = height_of(watch, &body->last);
        const double own = (body->mass * speed * speed + body->inertia * spin * spin) / 2;
        body->energy = own + body->mass * watch->pull * up;
        watch->energy += body->energy;
        if (energy_counts(watch, body)) gained += body->energy;
        watch->speed = larger(watch->speed, speed);
        watch->farthest = larger(watch->farthest, (double)larger(fabsf(body->last.at.x), fabsf(body->last.at.y)));
        if (own > most) most = own, hottest = i;
        if (energy_is_judged(watch) &&
            own + body->mass * (watch->pull * (up - watch->lowest) - burst) > watch->run.allowed)
            verdict_note(watch, VERDICT_EXPLODES, i, speed, "m/s");
    }
    watch->excess = larger(watch->excess, gained);
    watch->least = fmin(watch->least, gained);
    const double available = larger(watch->available - watch->least, least_share * watch->weight * watch->mean);
    /* Free of charge: what gravity does in a step, rounding, and a lift by skins. */
    const double skin = 2 * (double)watch->run.skin * (watch->weight + available / watch->smallest);
    const double free = skin + watch->weight * watch->pull * dt * dt / 2 +
                        rounding * (watch->weight * watch->farthest * sqrt(step->frame) + fabs(watch->brought));
    if (energy_is_judged(watch) && gained > larger(gain_share * available, free) + watch->run.allowed)
        verdict_note(watch, VERDICT_EXPLODES, hottest, gained, "J");
}

/* Whether b has gone through a since they had these poses: along an axis of a it was on one side and is on the other,
   by no more than half of the smaller side deep; along the other axis it was in a by more than that. What turned by 60
   degrees has other sides. */
static bool has_passed(const WatchedBody *a, const WatchedBody *b, const Pose *of_a, const Pose *of_b) {
    const double half = pass_share * fmin(a->side, b->side);
    double at[2][2], reach[2][2]; /* m: before and now, along both axes */
    for (int now = 0; now < 2; now++) {
        const Box one = box_of(a, now ? &a->last : of_a), other = box_of(b, now ? &b->last : of_b);
        const Mat22 to_a = mat22_transpose(one.rotation), turn = mat22_abs(mat22_product(to_a, other.rotation));
        const Vec2 way = mat22_multiply(to_a, vec2_sub(other.position, one.position));
        const Vec2 halves = vec2_add(one.half, mat22_multiply(turn, other.half));
        at[now][0] = way.x, reach[now][0] = halves.x;
        at[now][1] = way.y, reach[now][1] = halves.y;
    }
    for (int k = 0; k < 2; k++) {
        if (at[0][k] * at[1][k] >= 0) continue;
        const double share = at[0][k] / (at[0][k] - at[1][k]); /* of the way, where the two are side by side */
        const double aside = at[0][!k] + share * (at[1][!k] - at[0][!k]);
        const double within = reach[0][!k] + share * (reach[1][!k] - reach[0][!k]) - half;
        if (fabs(at[0][k]) > reach[0][k] - half && fabs(at[1][k]) > reach[1][k] - half && fabs(aside) < within)
            return turn_between(&a->last, of_a) < M_PI / 3;
    }
    return false;
}

/* Whether two bodies are through each other now. */
static void check_pass(VerdictWatch *watch, const DeepPair *deep) {
    const BodyPair pair = deep->pair;
    const WatchedBody *a = &watch->bodies[pair.a], *b = &watch->bodies[pair.b];
    const Pose *of_a = &deep->of_a, *of_b = &deep->of_b;
    if (watch->worst.verdict >= VERDICT_TUNNELS) return;
    if (!has_passed(a, b, of_a, of_b) && !has_passed(b, a, of_b, of_a)) return;
    const double way = larger(vec2_distance(a->last.at, of_a->at), vec2_distance(b->last.at, of_b->at));
    verdict_note(watch, VERDICT_TUNNELS, b->is_static ? pair.a : pair.b,
                 way / ((watch->frame - deep->since + 1) * (double)watch->run.dt), "m/s");
    watch->worst.other = b->is_static ? pair.b : pair.a;
}

/* Two bodies as they were before the last step. */
static DeepPair pair_before(const VerdictWatch *watch, BodyPair pair) {
    return (DeepPair){pair, watch->frame, watch->frame, watch->bodies[pair.a].before, watch->bodies[pair.b].before};
}

bool check_passes(VerdictWatch *watch, Error *error) {
    if (!find_near(watch, 0, error)) return false;
    for (size_t k = 0; k < watch->finder.pairs.count; k++) {
        const BodyPair pair = watch->finder.pairs.pairs[k];
        const WatchedBody *a = &watch->bodies[pair.a], *b = &watch->bodies[pair.b];
        const DeepPair before = pair_before(watch, pair);
        if (way_past(a, b) > pass_share * fmin(a->side, b->side)) check_pass(watch, &before);
    }
    return true;
}

/* The deep pair of these bodies; a new one if they were not too deep before. NULL if memory is short. */
static DeepPair *deep_pair(VerdictWatch *watch, BodyPair pair) {
    for (int i = 0; i < watch->deep_count; i++)
        if (watch->deep[i].pair.a == pair.a && watch->deep[i].pair.b == pair.b) return &watch->deep[i];
    const size_t wanted = (size_t)watch->deep_count + 1;
    if (!array_reserve((void **)&watch->deep, &watch->deep_capacity, wanted, sizeof *watch->deep)) return NULL;
    watch->deep[watch->deep_count] = pair_before(watch, pair);
    return &watch->deep[watch->deep_count++];
}

bool check_contacts(VerdictWatch *watch, const VerdictStep *step, Error *error) {
    const double shallow = fmin(watch->deepest, deep_share * watch->smallest); /* m: it is no news */
    for (int i = 0; i < step->contact_count; i++) {
        const ContactPoint *contact = &step->contacts[i];
        const double depth = -(double)contact->separation;
        if (depth <= shallow || contact->b >= watch->body_count) continue;
        const WatchedBody *a = &watch->bodies[contact->a], *b = &watch->bodies[contact->b];
        watch->deepest = larger(watch->deepest, depth);
        if (depth <= deep_share * fmin(a->side, b->side)) continue;
        DeepPair *deep = deep_pair(watch, (BodyPair){contact->a, contact->b});
        if (deep == NULL) return error_memory(error, "verdict");
        deep->seen = step->frame;
        if (step->frame - deep->since > steps_of(watch, long_units))
            verdict_note(watch, VERDICT_SINKS, b->is_static ? contact->a : contact->b, depth, "m");
    }
    int kept = 0;
    for (int i = 0; i < watch->deep_count; i++) {
        const DeepPair *deep = &watch->deep[i];
        if (deep->pair.b >= watch->body_count) continue;
        if (deep->seen == step->frame)
            watch->deep[kept++] = *deep;
        else if (deep->since > 1)
            check_pass(watch, deep);
    }
    watch->deep_count = kept;
    return true;
}

/* What touches a held body is held, too. True: one was not so far. */
static bool hold(WatchedBody *a, WatchedBody *b) {
    if (a->held == b->held) return false;
    return a->held = b->held = true;
}

/* The first body that keeps its place and is not held; -1: none. */
static int hanging(const VerdictWatch *watch, int longest) {
    for (int i = 0; i < watch->body_count; i++)
        if (!watch->bodies[i].held && watch->frame - watch->bodies[i].place.frame >= longest) return i;
    return -1;
}

/* Static bodies are held. Contacts tell of almost all bodies that they do not hang. */
bool check_hanging(VerdictWatch *watch, const VerdictStep *step, Error *error) {
    const int longest = steps_of(watch, long_units);
    WatchedBody *bodies = watch->bodies;
    if (watch->pull == 0 || isinf(watch->floor) || watch->frame % longest != 0) return true;
    for (int i = 0; i < watch->body_count; i++) bodies[i].held = bodies[i].is_static;
    for (bool more = true; more;) {
        more = false;
        for (const ContactPoint *at = step->contacts; at < step->contacts + step->contact_count; at++)
            more |= at->b < watch->body_count && hold(&bodies[at->a], &bodies[at->b]);
    }
    if (hanging(watch, longest) < 0) return true;
    if (!find_near(watch, 0, error)) return false;
    for (bool more = true; more;) {
        more = false;
        const PairList *near = &watch->finder.pairs;
        for (const BodyPair *pair = near->pairs; pair < near->pairs + near->count; pair++)
            more |= bodies_touch(watch, &bodies[pair->a], &bodies[pair->b]) && hold(&bodies[pair->a], &bodies[pair->b]);
    }
    const int body = hanging(watch, longest);
    if (body >= 0) verdict_note(watch, VERDICT_HANGS, body, longest * (double)watch->run.dt, "s");
    return true;
}
