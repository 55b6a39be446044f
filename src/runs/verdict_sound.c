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
#include <stdlib.h>
#include <string.h>

/* Of the energy that is available to be lost: what the solver's penetrations store and release again is less. */
static const double gain_share = 0.01;
static const double regain_share = 0.05;  /* a stack that sank under its weight is pushed up again */
static const double burst_factor = 5;     /* a heavy body's elastic blow gives a light one 4 times its energy per kg */
static const double least_share = 0.1;    /* of a size: at least what lifts all bodies so far is available */
static const double overlap_share = 0.02; /* of a side: such overlaps at the start are pushed apart */
static const double deep_share = 0.25;    /* of the smaller side; an impact's penetration is corrected sooner */
static const double deep_units = 0.5;
static const double hang_share = 0.15; /* of g t^2: a free flight's heights differ by half of it within 2 t */
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

/* Energy. */

void energy_add_body(VerdictWatch *watch, const Body *from, WatchedBody *body) {
    const double up = height_of(watch, &body->last);
    if (isinf(watch->lowest)) watch->lowest = up;
    const double per_kg = body_energy(from, vec2(0, 0)) * from->inv_mass + watch->pull * (up - watch->lowest);
    body->mass = 1 / (double)from->inv_mass;
    body->energy = body->mass * (per_kg + watch->pull * watch->lowest);
    watch->liveliest = larger(watch->liveliest, per_kg);
    watch->largest = larger(watch->largest, body->size);
    watch->mass += body->mass;
    watch->weight += body->mass * watch->pull;
    watch->lift += body->mass * watch->pull * body->size;
    if (!body->is_bomb) energy_count(watch, body);
}

void energy_count(VerdictWatch *watch, WatchedBody *body) {
    body->counted = true;
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
        if (body->counted) sum += body->energy;
        watch->farthest = larger(watch->farthest, larger(fabs(body->last.x), fabs(body->last.y)));
        if (own > most) most = own, hottest = i;
        if (energy_is_judged(watch) && own / body->mass + watch->pull * (up - watch->lowest) > burst &&
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
    const double fall = watch->pull * dt;
    const double free = skin + watch->mass * fall * fall / 2 +
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

/* Depth. */

/* Whether b was on one side of a before, and is on the other side now, along one of a's axes: beside it both times, and
   not farther along the other axis than it reaches. */
static bool changed_sides(const WatchedBody *a, const WatchedBody *b, const Pose poses[2][2]) {
    double at[2][2]; /* before and now, along both axes of a, in reaches */
    for (int now = 0; now < 2; now++) {
        const Pose *of_a = &poses[now][0], *of_b = &poses[now][1];
        const double c = cos(of_a->angle), s = sin(of_a->angle), x = of_b->x - of_a->x, y = of_b->y - of_a->y;
        const double p = fabs(cos(of_b->angle - of_a->angle)), q = fabs(sin(of_b->angle - of_a->angle));
        const double w = (double)b->box.x, h = (double)b->box.y;
        at[now][0] = 2 * (c * x + s * y) / ((double)a->box.x + p * w + q * h);
        at[now][1] = 2 * (c * y - s * x) / ((double)a->box.y + q * w + p * h);
    }
    for (int axis = 0; axis < 2; axis++)
        if (at[0][axis] * at[1][axis] < 0 && fmin(fabs(at[0][axis]), fabs(at[1][axis])) > 0.7 &&
            fabs(at[0][1 - axis] + at[1][1 - axis]) < 1.2)
            return true;
    return false;
}

static void note_pass(VerdictWatch *watch, int a, int b, double speed) {
    const bool first = watch->bodies[b].is_static;
    if (watch->worst.verdict >= VERDICT_TUNNELS) return;
    verdict_note(watch, VERDICT_TUNNELS, first ? a : b, speed, "m/s");
    watch->worst.other = first ? b : a;
}

bool check_depth(VerdictWatch *watch, const VerdictStep *step, Error *error) {
    /* Contacts are of the poses before the step. */
    for (int i = 0; i < step->contact_count; i++) {
        const ContactPoint *contact = &step->contacts[i];
        const double depth = -(double)contact->separation;
        if (contact->b >= watch->body_count) continue;
        WatchedBody *a = &watch->bodies[contact->a], *b = &watch->bodies[contact->b];
        a->held = b->held = a->held > b->held ? a->held : b->held;
        if (depth <= 0) continue;
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
            *pair = (DeepPair){.a = contact->a,
                               .b = contact->b,
                               .since = step->frame,
                               .entry_a = a->prior,
                               .entry_b = b->prior,
                               .turn_a = {a->prior.angle, a->prior.angle},
                               .turn_b = {b->prior.angle, b->prior.angle}};
        }
        pair->seen = step->frame;
        pair->deepest = larger(pair->deepest, depth);
        const int longest = steps_of(watch, deep_units);
        if (step->frame - pair->since > (longest > 4 ? longest : 4))
            verdict_note(watch, VERDICT_SINKS, b->is_static ? pair->a : pair->b, depth, "m");
    }
    int kept = 0;
    for (int i = 0; i < watch->deep_count; i++) {
        DeepPair *pair = &watch->deep[i];
        if (pair->b >= watch->body_count) continue;
        const WatchedBody *a = &watch->bodies[pair->a], *b = &watch->bodies[pair->b];
        const double of_a = a->before.angle, of_b = b->before.angle;
        pair->turn_a[0] = fmin(pair->turn_a[0], of_a), pair->turn_a[1] = larger(pair->turn_a[1], of_a);
        pair->turn_b[0] = fmin(pair->turn_b[0], of_b), pair->turn_b[1] = larger(pair->turn_b[1], of_b);
        if (pair->seen == step->frame) {
            watch->deep[kept++] = *pair;
        } else if (pair->since > 1 && pair->deepest > pass_share * fmin(a->side, b->side)) {
            const Pose ab[2][2] = {{pair->entry_a, pair->entry_b}, {a->before, b->before}},
                       ba[2][2] = {{pair->entry_b, pair->entry_a}, {b->before, a->before}};
            const double most = M_PI / 3; /* what turned farther has other sides */
            if ((pair->turn_a[1] - pair->turn_a[0] < most && changed_sides(a, b, ab)) ||
                (pair->turn_b[1] - pair->turn_b[0] < most && changed_sides(b, a, ba)))
                note_pass(watch, pair->a, pair->b, watch->speed);
        }
    }
    watch->deep_count = kept;
    return true;
}

/* Whether two bodies are deeper in each other on their way through this step than before and after it. */
static bool pass(const WatchedBody *a, const WatchedBody *b) {
    enum { MOST = 64 };
    const Pose by_a = {a->last.x - a->before.x, a->last.y - a->before.y, turn_between(a->last.angle, a->before.angle)},
               by_b = {b->last.x - b->before.x, b->last.y - b->before.y, turn_between(b->last.angle, b->before.angle)};
    const double x = by_a.x - by_b.x, y = by_a.y - by_b.y, side = fmin(a->side, b->side);
    const double way = sqrt(x * x + y * y) + fabs(by_a.angle) * a->corner + fabs(by_b.angle) * b->corner;
    if (way <= pass_share * side) return false;
    const int pieces = (int)fmin(MOST, ceil(4 * way / side));
    double ends = 0;
    for (int k = 0; k <= pieces; k++) { /* both ends first */
        const double part = k == 0 ? 0 : k == 1 ? 1 : (double)(k - 1) / pieces;
        const Pose at_a = {a->before.x + by_a.x * part, a->before.y + by_a.y * part,
                           a->before.angle + by_a.angle * part},
                   at_b = {b->before.x + by_b.x * part, b->before.y + by_b.y * part,
                           b->before.angle + by_b.angle * part};
        const Box box_a = box_of(a, &at_a), box_b = box_of(b, &at_b);
        const double depth = overlap_depth(&box_a, &box_b);
        if (k < 2)
            ends = larger(ends, depth);
        else if (depth > ends + pass_share * side)
            return true;
    }
    return false;
}

bool check_passes(VerdictWatch *watch, Error *error) {
    const size_t count = (size_t)watch->body_count;
    SortAndSweep *sweep = &watch->finder.broad_phase;
    Bounds *bounds = malloc((count + 1) * sizeof *bounds);
    bool *fixed = malloc(count + 1);
    bool ok = bounds != NULL && fixed != NULL;
    for (size_t i = 0; ok && i < count; i++) {
        const WatchedBody *body = &watch->bodies[i];
        const double r = body->corner;
        bounds[i] = (Bounds){
            vec2((float)(fmin(body->last.x, body->before.x) - r), (float)(fmin(body->last.y, body->before.y) - r)),
            vec2((float)(larger(body->last.x, body->before.x) + r), (float)(larger(body->last.y, body->before.y) + r))};
        fixed[i] = body->is_static;
    }
    ok = ok && sort_and_sweep_find(sweep, &watch->finder.pairs, bounds, fixed, (int)count);
    for (size_t k = 0; ok && k < watch->finder.pairs.count; k++) {
        const BodyPair pair = watch->finder.pairs.pairs[k];
        const WatchedBody *a = &watch->bodies[pair.a], *b = &watch->bodies[pair.b];
        if (pass(a, b))
            note_pass(watch, pair.a, pair.b,
                      larger(way_between(&a->last, &a->before), way_between(&b->last, &b->before)) /
                          (double)watch->run.dt);
    }
    free(fixed);
    free(bounds);
    return ok || sweep->too_many || error_memory(error, "verdict");
}

/* Hanging. */

static int root_of(const VerdictWatch *watch, int i) {
    while (watch->bodies[i].root != i) i = watch->bodies[i].root = watch->bodies[watch->bodies[i].root].root;
    return i;
}

/* Joins what touches, within a gap that a step's motion may be. A chain's root is a static body, if it has one. */
static bool find_chains(VerdictWatch *watch, const Body *bodies, Error *error) {
    const double widest = 0.25 * watch->smallest; /* m: the most that a step's motion may open */
    const float skin = watch->run.skin + (float)widest / 2;
    if (!contact_finder_find(&watch->finder, bodies, watch->body_count, skin, error)) return false;
    for (int i = 0; i < watch->body_count; i++) watch->bodies[i].root = i;
    for (int k = 0; k < watch->finder.set.contact_count; k++) {
        const ContactPoint *contact = &watch->finder.set.contacts[k];
        const WatchedBody *one = &watch->bodies[contact->a], *other = &watch->bodies[contact->b];
        const double moved = way_between(&one->last, &one->before) + way_between(&other->last, &other->before);
        const double gap = (double)contact->separation - 2 * (double)watch->run.skin;
        if (gap > touch_share * fmin(one->side, other->side) + moved) continue;
        const int a = root_of(watch, contact->a), b = root_of(watch, contact->b);
        if (watch->bodies[a].is_static)
            watch->bodies[b].root = a;
        else
            watch->bodies[a].root = b;
    }
    return true;
}

bool check_hanging(VerdictWatch *watch, const Body *bodies, Error *error) {
    if (watch->pull == 0 || isinf(watch->floor)) return true;
    const double time = hang_units / 2 * watch->unit, limit = hang_share * watch->pull * time * time;
    const int longest = steps_of(watch, hang_units);
    bool known = false;
    for (int i = 0; i < watch->body_count; i++) {
        WatchedBody *body = &watch->bodies[i];
        const double up = height_of(watch, &body->last);
        double high = up, low = up;
        for (int k = 0; k < HANG_CHECKS; k++) {
            high = larger(high, body->heights[k]);
            low = body->heights[k] < low ? body->heights[k] : low;
            body->heights[k] = k + 1 < HANG_CHECKS ? body->heights[k + 1] : up;
        }
        if (body->is_static || high - low > limit || watch->frame - body->held <= longest) continue;
        if (!known && !find_chains(watch, bodies, error)) return false;
        known = true;
        if (!watch->bodies[root_of(watch, i)].is_static)
            verdict_note(watch, VERDICT_HANGS, i, hang_units * watch->unit, "s");
    }
    return true;
}
