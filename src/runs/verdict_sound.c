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
static const double regain_share = 0.05;  /* a stack that sank under its weight is pushed up again */
static const double burst_factor = 5;     /* a heavy body's elastic blow gives a light one 4 times its energy per kg */
static const double least_share = 0.1;    /* of a size: at least what lifts all bodies so far is available */
static const double overlap_share = 0.02; /* of a side: such overlaps at the start are pushed apart */
static const double shallow_share =
    0.3; /* of the smaller side: hardly deeper are those that were too deep, and are not */
static const double deep_units = 0.5, hang_units = 0.5;
static const double hang_share = 0.15; /* of g t^2: three heights of a free flight, t apart, differ by a third of it */
/* float32 rounds a position by 6e-8 of it; its steps add up like a random walk. */
static const double rounding = 1e-6;

void verdict_note(VerdictWatch *watch, Verdict verdict, int body, double value, const char *unit) {
    if (verdict <= watch->worst.verdict) return;
    watch->worst = (VerdictReading){
        .verdict = verdict, .frame = watch->frame, .body = body, .value = value, .unit = unit, .other = -1};
}

bool check_finite(VerdictWatch *watch, const VerdictStep *step) {
    double most = 0; /* m^2/s^2 */
    for (int i = 0; i < step->body_count; i++) {
        const Body *body = &step->bodies[i];
        const double x = body->velocity.x, y = body->velocity.y, spin = body->angular_velocity;
        const double sum = x + y + spin + (double)body->position.x + (double)body->position.y + (double)body->angle;
        if (!isfinite(sum)) {
            verdict_note(watch, VERDICT_NON_FINITE, i, watch->speed, "m/s");
            return false;
        }
        most = larger(most, x * x + y * y);
    }
    watch->speed = sqrt(most);
    return true;
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
    const double burst = burst_factor * (liveliest + watch->pull * watch->largest);
    double sum = 0, all = 0, most = 0, kinetic = 0; /* J */
    int hottest = -1, moving = 0;
    for (int i = 0; i < step->body_count; i++) {
        WatchedBody *body = &watch->bodies[i];
        const Body *now = &step->bodies[i];
        if (body->is_static) continue;
        const double vx = now->velocity.x, vy = now->velocity.y, spin = now->angular_velocity;
        const double own = (body->mass * (vx * vx + vy * vy) + spin * spin / (double)now->inv_inertia) / 2;
        const double up = height_of(watch, &body->last);
        body->energy = own + body->mass * watch->pull * up;
        kinetic += own;
        moving++;
        all += body->energy;
        if (energy_counts(watch, body)) sum += body->energy;
        watch->farthest = larger(watch->farthest, larger(fabs(body->last.x), fabs(body->last.y)));
        if (own > most) most = own, hottest = i;
        if (energy_is_judged(watch) && own + body->mass * (watch->pull * (up - watch->lowest) - burst) > 0 &&
            own / body->mass > rounding * watch->farthest * rounding * watch->farthest / (dt * dt))
            verdict_note(watch, VERDICT_EXPLODES, i, sqrt(vx * vx + vy * vy), "m/s");
    }
    watch->energy = all;
    watch->kinetic = moving > 0 ? kinetic / moving : 0;
    const double gained = sum - watch->brought;
    const int unit = steps_of(watch, 1);
    if (isinf(watch->judged_from) && step->frame >= unit) watch->judged_from = gained, watch->unit_began = step->frame;
    watch->excess = larger(watch->excess, gained);
    watch->least = fmin(watch->least, gained);
    const double available = larger(watch->available - watch->least, least_share * watch->lift);
    /* Free of charge: what gravity does in a step, rounding, and a lift by skins. */
    const double skin =
        isfinite(watch->smallest) ? 2 * (double)watch->run.skin * (watch->weight + available / watch->smallest) : 0;
    const double free = skin + watch->weight * watch->pull * dt * dt / 2 +
                        rounding * (watch->weight * watch->farthest * sqrt(step->frame) + fabs(watch->brought));
    const double over = larger(gained - (watch->judged_from + larger(gain_share * available, free)),
                               gained - (watch->kept + larger(regain_share * available, free)));
    if (over > 0 && energy_is_judged(watch) && all > converged_energy(watch) + larger(gain_share * available, free))
        verdict_note(watch, VERDICT_EXPLODES, hottest, gained > watch->judged_from ? gained : gained - watch->kept,
                     "J");
    watch->peak = step->frame == watch->unit_began + 1 ? gained : larger(watch->peak, gained);
    if (step->frame < watch->unit_began + unit) return;
    if (isfinite(watch->judged_from)) watch->kept = fmin(watch->kept, watch->peak);
    watch->unit_began = step->frame;
}

/* Whether b has gone through a: along an axis of a it was on one side and is on the other, by no more than `beside` of
   the smaller side deep; along the other axis it was in a by more than `pass_share` of it. What turned by 60 degrees
   has other sides. */
static bool has_passed(const WatchedBody *a, const WatchedBody *b, const Pose of_a[2], const Pose of_b[2],
                       double beside) {
    const double side = fmin(a->side, b->side), limit = pass_share * side, w = (double)b->box.x, h = (double)b->box.y;
    double at[2][2], reach[2][2]; /* m: before and now, along both axes */
    for (int now = 0; now < 2; now++) {
        const double c = cos(of_a[now].angle), s = sin(of_a[now].angle), turn = of_b[now].angle - of_a[now].angle;
        const double p = fabs(cos(turn)), q = fabs(sin(turn));
        const double x = of_b[now].x - of_a[now].x, y = of_b[now].y - of_a[now].y;
        at[now][0] = c * x + s * y, reach[now][0] = ((double)a->box.x + p * w + q * h) / 2;
        at[now][1] = c * y - s * x, reach[now][1] = ((double)a->box.y + q * w + p * h) / 2;
    }
    for (int k = 0; k < 2; k++)
        if (at[0][k] * at[1][k] < 0 && fabs(at[0][k]) > reach[0][k] - beside * side &&
            fabs(at[1][k]) > reach[1][k] - beside * side &&
            fabs(at[0][!k] + at[1][!k]) < reach[0][!k] + reach[1][!k] - 2 * limit)
            return fabs(turn_between(of_a[1].angle, of_a[0].angle)) < M_PI / 3;
    return false;
}

static void check_pass(VerdictWatch *watch, int a, int b, const Pose of_a[2], const Pose of_b[2], double beside,
                       double speed) {
    const WatchedBody *one = &watch->bodies[a], *other = &watch->bodies[b];
    if (watch->worst.verdict >= VERDICT_TUNNELS) return;
    if (!has_passed(one, other, of_a, of_b, beside) && !has_passed(other, one, of_b, of_a, beside)) return;
    verdict_note(watch, VERDICT_TUNNELS, other->is_static ? a : b, speed, "m/s");
    watch->worst.other = other->is_static ? b : a;
}

bool check_passes(VerdictWatch *watch, Error *error) {
    if (!find_near(watch, 0, error)) return false;
    for (size_t k = 0; k < watch->finder.pairs.count; k++) {
        const BodyPair pair = watch->finder.pairs.pairs[k];
        const WatchedBody *a = &watch->bodies[pair.a], *b = &watch->bodies[pair.b];
        if (way_past(a, b) <= pass_share * fmin(a->side, b->side)) continue;
        const double way = larger(way_between(&a->last, &a->before), way_between(&b->last, &b->before));
        check_pass(watch, pair.a, pair.b, (Pose[2]){a->before, a->last}, (Pose[2]){b->before, b->last}, pass_share,
                   way / (double)watch->run.dt);
    }
    return true;
}

bool check_contacts(VerdictWatch *watch, const VerdictStep *step, Error *error) {
    const int half = steps_of(watch, deep_units), longest = half > 4 ? half : 4;
    const double shallow = fmin(watch->deepest, deep_share * watch->thinnest); /* m: it is no news */
    for (int i = 0; i < step->contact_count; i++) {
        const ContactPoint *contact = &step->contacts[i];
        const double depth = -(double)contact->separation;
        if (contact->b >= watch->body_count) continue;
        WatchedBody *a = &watch->bodies[contact->a], *b = &watch->bodies[contact->b];
        a->held = b->held = a->is_static || b->is_static ? step->frame : a->held > b->held ? a->held : b->held;
        if (depth <= shallow) continue;
        watch->deepest = larger(watch->deepest, depth);
        const double side = a->side < b->side ? a->side : b->side;
        if (step->frame == 1 && depth > overlap_share * side) watch->judged_from = INFINITY;
        if (depth <= deep_share * side) continue;
        DeepPair *pair = watch->deep, *end = watch->deep + watch->deep_count;
        while (pair < end && (pair->a != contact->a || pair->b != contact->b)) pair++;
        if (pair == end) {
            if (!array_reserve((void **)&watch->deep, &watch->deep_capacity, (size_t)watch->deep_count + 1,
                               sizeof *watch->deep))
                return error_memory(error, "verdict");
            pair = &watch->deep[watch->deep_count++];
            *pair = (DeepPair){contact->a, contact->b, step->frame, 0, 0, {a->before}, {b->before}};
        }
        pair->seen = step->frame;
        pair->deepest = larger(pair->deepest, depth);
        if (step->frame - pair->since > longest)
            verdict_note(watch, VERDICT_SINKS, b->is_static ? pair->a : pair->b, depth, "m");
    }
    int kept = 0;
    for (int i = 0; i < watch->deep_count; i++) {
        DeepPair *pair = &watch->deep[i];
        if (pair->b >= watch->body_count) continue;
        pair->of_a[1] = watch->bodies[pair->a].last;
        pair->of_b[1] = watch->bodies[pair->b].last;
        if (pair->seen == step->frame)
            watch->deep[kept++] = *pair;
        else if (pair->since > 1 &&
                 pair->deepest > pass_share * fmin(watch->bodies[pair->a].side, watch->bodies[pair->b].side))
            check_pass(watch, pair->a, pair->b, pair->of_a, pair->of_b, shallow_share, watch->speed);
    }
    watch->deep_count = kept;
    return true;
}

/* The body that i hangs on, and that on another, to the last. */
static int end_of(const VerdictWatch *watch, int i) {
    while (watch->bodies[i].link != i) i = watch->bodies[i].link = watch->bodies[watch->bodies[i].link].link;
    return i;
}

bool check_hanging(VerdictWatch *watch, Error *error) {
    const int longest = steps_of(watch, hang_units), often = steps_of(watch, hang_units / 4);
    const double time = hang_units / 2 * watch->unit, limit = hang_share * watch->pull * time * time;
    if (watch->pull == 0 || isinf(watch->floor) || watch->frame % often != 0) return true;
    bool hangs = false;
    for (int i = 0; i < watch->body_count; i++) {
        WatchedBody *body = &watch->bodies[i];
        const double up = height_of(watch, &body->last);
        body->link = i;
        if (fabs(up - body->level) > limit) body->level = up, body->level_since = watch->frame;
        hangs |= !body->is_static && watch->frame - body->level_since >= longest && watch->frame - body->held > longest;
    }
    if (!hangs) return true;
    if (!find_near(watch, 0, error)) return false;
    for (size_t k = 0; k < watch->finder.pairs.count; k++) {
        const BodyPair pair = watch->finder.pairs.pairs[k];
        if (!bodies_touch(watch, &watch->bodies[pair.a], &watch->bodies[pair.b])) continue;
        const int a = end_of(watch, pair.a), b = end_of(watch, pair.b);
        watch->bodies[watch->bodies[a].is_static ? b : a].link = watch->bodies[a].is_static ? a : b;
    }
    for (int i = 0; i < watch->body_count; i++) {
        const WatchedBody *body = &watch->bodies[i];
        if (!watch->bodies[end_of(watch, i)].is_static && watch->frame - body->level_since >= longest &&
            watch->frame - body->held > longest)
            verdict_note(watch, VERDICT_HANGS, i, hang_units * watch->unit, "s");
    }
    return true;
}
