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
static const double regain_share = 0.05; /* a stack that sank under its weight is pushed up again */
static const double burst_factor = 5;    /* a heavy body's elastic blow gives a light one 4 times its energy per kg */
static const double least_share = 0.1;   /* of a size: at least what lifts all bodies so far is available */
static const double deep_share = 0.25;   /* of a side: an impact's penetration is less, or is corrected sooner */
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

/* J: most energy of the converged run within a unit of this frame; -INFINITY: it says nothing of the frame. */
static double converged_energy(const VerdictWatch *watch) {
    const EnergyLog *log = watch->run.converged;
    if (log == NULL) return -INFINITY;
    const int end = log->unconverged > 0 ? log->unconverged : log->frames + 1, unit = steps_of(watch, 1);
    double most = -INFINITY;
    if (watch->frame >= end) return most;
    for (int i = watch->frame > unit ? watch->frame - unit : 0; i < end && i <= watch->frame + unit; i++)
        most = larger(most, log->energy[i]);
    return most;
}

void check_energy(VerdictWatch *watch, const VerdictStep *step) {
    const double dt = (double)watch->run.dt;
    const EnergyLog *log = watch->run.converged;
    const double liveliest = log != NULL ? larger(watch->liveliest, log->liveliest) : watch->liveliest; /* J/kg */
    const double noise = rounding * watch->farthest / dt;                                               /* m/s */
    const double burst = burst_factor * (liveliest + watch->pull * watch->largest) + noise * noise;
    double sum = 0, all = 0, most = 0; /* J */
    int hottest = -1;
    watch->speed = 0;
    for (int i = 0; i < step->body_count; i++) {
        WatchedBody *body = &watch->bodies[i];
        const Body *now = &step->bodies[i];
        if (body->is_static) continue;
        const double vx = now->velocity.x, vy = now->velocity.y, spin = now->angular_velocity;
        const double speed = sqrt(vx * vx + vy * vy), up = height_of(watch, &body->last);
        const double own = (body->mass * speed * speed + body->inertia * spin * spin) / 2;
        body->energy = own + body->mass * watch->pull * up;
        all += body->energy;
        if (energy_counts(watch, body)) sum += body->energy;
        watch->speed = larger(watch->speed, speed);
        watch->farthest = larger(watch->farthest, (double)larger(fabsf(body->last.at.x), fabsf(body->last.at.y)));
        if (own > most) most = own, hottest = i;
        if (energy_is_judged(watch) && own + body->mass * (watch->pull * (up - watch->lowest) - burst) > 0)
            verdict_note(watch, VERDICT_EXPLODES, i, speed, "m/s");
    }
    watch->energy = all;
    const double gained = sum - watch->brought;
    watch->excess = larger(watch->excess, gained);
    watch->least = fmin(watch->least, gained);
    const double available = larger(watch->available - watch->least, least_share * watch->lift);
    /* Free of charge: what gravity does in a step, rounding, and a lift by skins. */
    const double skin = 2 * (double)watch->run.skin * (watch->weight + available / watch->smallest);
    const double free = skin + watch->weight * watch->pull * dt * dt / 2 +
                        rounding * (watch->weight * watch->farthest * sqrt(step->frame) + fabs(watch->brought));
    const double over = larger(gained - larger(gain_share * available, free),
                               gained - (watch->kept + larger(regain_share * available, free)));
    if (over > 0 && energy_is_judged(watch) && all > converged_energy(watch) + larger(gain_share * available, free))
        verdict_note(watch, VERDICT_EXPLODES, hottest, gained > 0 ? gained : gained - watch->kept, "J");
    watch->peak = step->frame == watch->unit_began + 1 ? gained : larger(watch->peak, gained);
    if (step->frame < watch->unit_began + steps_of(watch, 1)) return;
    watch->kept = fmin(watch->kept, watch->peak);
    watch->unit_began = step->frame;
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
    for (int k = 0; k < 2; k++)
        if (at[0][k] * at[1][k] < 0 && fabs(at[0][k]) > reach[0][k] - half && fabs(at[1][k]) > reach[1][k] - half &&
            fabs(at[0][!k] + at[1][!k]) < reach[0][!k] + reach[1][!k] - 2 * half)
            return turn_between(&a->last, of_a) < M_PI / 3;
    return false;
}

/* Since the step `since`, before which they had these poses. */
static void check_pass(VerdictWatch *watch, BodyPair pair, const Pose *of_a, const Pose *of_b, int since) {
    const WatchedBody *a = &watch->bodies[pair.a], *b = &watch->bodies[pair.b];
    if (watch->worst.verdict >= VERDICT_TUNNELS) return;
    if (!has_passed(a, b, of_a, of_b) && !has_passed(b, a, of_b, of_a)) return;
    const double way = larger(vec2_distance(a->last.at, of_a->at), vec2_distance(b->last.at, of_b->at));
    verdict_note(watch, VERDICT_TUNNELS, b->is_static ? pair.a : pair.b,
                 way / ((watch->frame - since + 1) * (double)watch->run.dt), "m/s");
    watch->worst.other = b->is_static ? pair.b : pair.a;
}

bool check_passes(VerdictWatch *watch, Error *error) {
    if (!find_near(watch, 0, error)) return false;
    for (size_t k = 0; k < watch->finder.pairs.count; k++) {
        const BodyPair pair = watch->finder.pairs.pairs[k];
        const WatchedBody *a = &watch->bodies[pair.a], *b = &watch->bodies[pair.b];
        if (way_past(a, b) > pass_share * fmin(a->side, b->side))
            check_pass(watch, pair, &a->before, &b->before, watch->frame);
    }
    return true;
}

/* The deep pair of these bodies; a new one if they were not too deep before. NULL if memory is short. */
static DeepPair *deep_pair(VerdictWatch *watch, BodyPair pair) {
    for (int i = 0; i < watch->deep_count; i++)
        if (watch->deep[i].pair.a == pair.a && watch->deep[i].pair.b == pair.b) return &watch->deep[i];
    const size_t wanted = (size_t)watch->deep_count + 1;
    if (!array_reserve((void **)&watch->deep, &watch->deep_capacity, wanted, sizeof *watch->deep)) return NULL;
    watch->deep[watch->deep_count] = (DeepPair){.pair = pair,
                                                .since = watch->frame,
                                                .of_a = watch->bodies[pair.a].before,
                                                .of_b = watch->bodies[pair.b].before};
    return &watch->deep[watch->deep_count++];
}

bool check_contacts(VerdictWatch *watch, const VerdictStep *step, Error *error) {
    const double shallow = fmin(watch->deepest, deep_share * watch->thinnest); /* m: it is no news */
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
            check_pass(watch, deep->pair, &deep->of_a, &deep->of_b, deep->since);
    }
    watch->deep_count = kept;
    return true;
}

/* The body that i touches, and that which it touches, to the last. */
static int end_of(const VerdictWatch *watch, int i) {
    while (watch->bodies[i].link != i) i = watch->bodies[i].link = watch->bodies[watch->bodies[i].link].link;
    return i;
}

static void join(VerdictWatch *watch, int i, int j) {
    const int a = end_of(watch, i), b = end_of(watch, j);
    watch->bodies[watch->bodies[a].is_static ? b : a].link = watch->bodies[a].is_static ? a : b;
}

/* The first body that rests on nothing; -1: none. */
static int hanging(const VerdictWatch *watch, int longest) {
    for (int i = 0; i < watch->body_count; i++)
        if (watch->frame - watch->bodies[i].since >= longest && !watch->bodies[end_of(watch, i)].is_static) return i;
    return -1;
}

/* Contacts tell of almost all bodies that they do not hang. */
bool check_hanging(VerdictWatch *watch, const VerdictStep *step, Error *error) {
    const int longest = steps_of(watch, long_units);
    if (watch->pull == 0 || isinf(watch->floor) || watch->frame % longest != 0) return true;
    for (int i = 0; i < watch->body_count; i++) watch->bodies[i].link = i;
    for (int k = 0; k < step->contact_count; k++)
        if (step->contacts[k].b < watch->body_count) join(watch, step->contacts[k].a, step->contacts[k].b);
    if (hanging(watch, longest) < 0) return true;
    if (!find_near(watch, 0, error)) return false;
    for (size_t k = 0; k < watch->finder.pairs.count; k++) {
        const BodyPair pair = watch->finder.pairs.pairs[k];
        if (bodies_touch(watch, &watch->bodies[pair.a], &watch->bodies[pair.b])) join(watch, pair.a, pair.b);
    }
    const int body = hanging(watch, longest);
    if (body >= 0) verdict_note(watch, VERDICT_HANGS, body, longest * (double)watch->run.dt, "s");
    return true;
}
