/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The checks of a step of which a verdict is made: finite, depth, falls, energy. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/runs_internal.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>

static const double degrees = 57.29577951308232; /* in a radian */

bool verdict_note(VerdictWatch *watch, Verdict verdict, int body, double value, const char *unit) {
    if (verdict <= watch->worst.verdict) return false;
    watch->worst = (VerdictReading){
        .verdict = verdict, .frame = watch->frame, .body = body, .value = value, .unit = unit, .other = -1};
    return true;
}

int falls_in_steps(const VerdictWatch *watch, double falls) {
    const long steps = lround(falls * watch->fall);
    return steps > 1 ? (int)steps : 1;
}

double verdict_size(const Body *body) { return sqrt((double)body->size.x * (double)body->size.y); }

double smaller_size(const VerdictStep *step, const ContactPoint *contact) {
    return fmin(verdict_size(&step->bodies[contact->a]), verdict_size(&step->bodies[contact->b]));
}

double smaller_side(const Body *body) { return body->size.x < body->size.y ? body->size.x : body->size.y; }

bool check_finite(VerdictWatch *watch, const VerdictStep *step) {
    double most = 0; /* m^2/s^2 */
    int fastest = -1;
    for (int i = 0; i < step->body_count; i++) {
        const Body *body = &step->bodies[i];
        if (!isfinite(body->position.x) || !isfinite(body->position.y) || !isfinite(body->angle) ||
            !isfinite(body->velocity.x) || !isfinite(body->velocity.y) || !isfinite(body->angular_velocity)) {
            verdict_note(watch, VERDICT_NON_FINITE, i, watch->speed, "m/s");
            return false;
        }
        const double x = body->velocity.x, y = body->velocity.y, square = x * x + y * y;
        if (square <= most) continue;
        most = square;
        fastest = i;
    }
    watch->speed = fastest >= 0 ? vec2_distance(step->bodies[fastest].velocity, vec2(0, 0)) : 0;
    return true;
}

/* A contact's body may have been removed at the end of the step. */
static bool exists(const VerdictStep *step, const ContactPoint *contact) { return contact->b < step->body_count; }

/* m: the depth that is sinking. */
static double depth_limit(const VerdictStep *step, const ContactPoint *contact) {
    const double side = fmin(smaller_side(&step->bodies[contact->a]), smaller_side(&step->bodies[contact->b]));
    return fmin(VERDICT_SINK_SHARE * smaller_size(step, contact), VERDICT_SINK_HALF * side);
}

void check_depth(VerdictWatch *watch, const VerdictStep *step) {
    const ContactPoint *deepest = NULL;
    double share = 1;
    for (int i = 0; i < step->contact_count; i++) {
        const ContactPoint *contact = &step->contacts[i];
        const double depth = -(double)contact->separation;
        if (!exists(step, contact)) continue;
        watch->deepest = fmax(watch->deepest, depth);
        const double found = depth / depth_limit(step, contact);
        if (found <= share) continue;
        share = found;
        deepest = contact;
    }
    watch->deep = deepest != NULL ? watch->deep + 1 : 0;
    if (watch->deep < falls_in_steps(watch, VERDICT_SINK_TIME)) return;
    int body = step->bodies[deepest->b].inv_mass != 0 ? deepest->b : deepest->a;
    verdict_note(watch, VERDICT_SINKS, body, -(double)deepest->separation, "m");
}

/* Descent along gravity times its length, m^2/s^2. */
static double descent(Vec2 from, Vec2 to, Vec2 gravity) {
    return ((double)to.x - from.x) * gravity.x + ((double)to.y - from.y) * gravity.y;
}

static bool judges_falls(const VerdictWatch *watch, int bomb) {
    return watch->run.stands || (watch->run.until_bomb && (bomb < 0 || !watch->bodies[bomb].touched));
}

/* The bodies that a contact joins: `a` from below carries b. False for one at the side. */
static bool carries(const VerdictStep *step, const ContactPoint *contact, Vec2 gravity, BodyPair *pair) {
    const float along = vec2_dot(contact->normal, gravity), across = vec2_cross(contact->normal, gravity);
    *pair = along < 0 ? (BodyPair){contact->a, contact->b} : (BodyPair){contact->b, contact->a};
    return exists(step, contact) && fabsf(along) > fabsf(across);
}

/* m: mean depth at both ends of a face, whose points are adjacent. A box that tilts on an edge sags by half of the
   depth there. */
static double mean_depth(const VerdictStep *step, int i) {
    const ContactPoint *point = &step->contacts[i];
    const bool two = i + 1 < step->contact_count && point[1].a == point->a && point[1].b == point->b;
    return (fmax(0, -(double)point->separation) + (two ? fmax(0, -(double)point[1].separation) : 0)) / 2;
}

/* Gives the body above the sag of the one below and of what is between them. */
static bool raise_sag(const VerdictWatch *watch, int below, int above, double depth) {
    const double sag = watch->bodies[below].sag + depth;
    if (sag <= watch->bodies[above].sag) return false;
    watch->bodies[above].sag = sag;
    return true;
}

/* One pass: the order of contacts and bodies is mostly that from below, so that one is enough. */
static bool add_sag(const VerdictWatch *watch, const VerdictStep *step) {
    bool more = false;
    BodyPair pair;
    for (int i = 0; i < step->contact_count; i++)
        if (carries(step, &step->contacts[i], watch->run.gravity, &pair))
            more |= raise_sag(watch, pair.a, pair.b, mean_depth(step, i));
    for (int i = 0; i < step->body_count; i++) {
        const WatchedBody *body = &watch->bodies[i];
        if (!body->held && body->below >= 0 && body->below < step->body_count)
            more |= raise_sag(watch, body->below, i, 0);
    }
    return more;
}

/* How much lower contacts let bodies be. A body in the air keeps its sag, and follows that of the body which carried it
   last: the upper boxes of a pile that gives way fall with it before they touch again. */
static void find_sag(const VerdictWatch *watch, const VerdictStep *step) {
    enum { PASSES = 100 };
    for (int i = 0; i < step->body_count; i++)
        if (watch->bodies[i].held) watch->bodies[i].sag = 0;
    for (int pass = 0; pass < PASSES && add_sag(watch, step); pass++) continue;
}

/* Finds how much lower each body is. Sag counts from half the limit on: most piles have none to look for. */
static void find_lower(const VerdictWatch *watch, const VerdictStep *step) {
    const double pull = vec2_distance(watch->run.gravity, vec2(0, 0));
    bool any = false;
    for (int i = 0; i < step->body_count; i++) {
        WatchedBody *body = &watch->bodies[i];
        const bool moves = step->bodies[i].inv_mass != 0 && body->landed && pull > 0;
        body->lower = moves ? descent(body->stood, step->bodies[i].position, watch->run.gravity) / pull : 0;
        any |= moves && body->lower > VERDICT_FALL_SHARE / 2 * smaller_side(&step->bodies[i]);
    }
    if (any) find_sag(watch, step);
}

/* A body is meant to stay where it was before the step in which it landed. */
static bool land(const VerdictStep *step, int on, int i, VerdictWatch *watch) {
    WatchedBody *body = &watch->bodies[i];
    if (body->landed || (step->bodies[on].inv_mass != 0 && !watch->bodies[on].landed)) return false;
    const double pull = vec2_distance(watch->run.gravity, vec2(0, 0));
    const double drop = pull > 0 ? descent(body->stood, body->last, watch->run.gravity) / pull : 0;
    body->dropped = drop > VERDICT_FALL_SHARE * smaller_side(&step->bodies[i]);
    body->stood = body->last;
    body->stood_angle = body->last_angle;
    return body->landed = true;
}

/* A body lands by a contact with one that has landed or is static, but not by one from above, which does not carry
   it. */
static bool land_all(VerdictWatch *watch, const VerdictStep *step) {
    bool more = false;
    for (int i = 0; i < step->contact_count; i++) {
        BodyPair pair;
        if (!exists(step, &step->contacts[i])) continue;
        const bool upright = carries(step, &step->contacts[i], watch->run.gravity, &pair);
        more |= land(step, pair.a, pair.b, watch);
        if (!upright) more |= land(step, pair.b, pair.a, watch);
    }
    return more;
}

/* What the bomb strikes before it has landed does not stand, nor does the bomb. */
static void strike_in_the_air(VerdictWatch *watch, const VerdictStep *step) {
    for (int i = 0; i < step->contact_count; i++) {
        const ContactPoint *contact = &step->contacts[i];
        if (!exists(step, contact) || (contact->a != step->bomb && contact->b != step->bomb)) continue;
        WatchedBody *body = &watch->bodies[contact->a == step->bomb ? contact->b : contact->a];
        body->stands &= body->landed;
    }
    watch->bodies[step->bomb].stands = false;
}

static void note_contacts(VerdictWatch *watch, const VerdictStep *step) {
    BodyPair pair;
    for (int i = 0; i < step->body_count; i++) watch->bodies[i].held = false;
    for (int i = 0; i < step->contact_count; i++) {
        if (!exists(step, &step->contacts[i])) continue;
        const bool upright = carries(step, &step->contacts[i], watch->run.gravity, &pair);
        watch->bodies[pair.a].touched = watch->bodies[pair.b].touched = true;
        if (!upright) continue;
        watch->bodies[pair.b].held = true;
        watch->bodies[pair.b].below = pair.a;
    }
    while (land_all(watch, step)) continue;
    if (step->bomb >= 0) strike_in_the_air(watch, step);
}

/* What drops into place stands where it comes to rest, or where it is when the bomb strikes. */
static bool arrives(const VerdictWatch *watch, const VerdictStep *step, int i) {
    WatchedBody *body = &watch->bodies[i];
    if (!body->dropped || body->arrived || (step->bomb >= 0 && watch->bodies[step->bomb].touched)) return false;
    body->stood = step->bodies[i].position;
    body->stood_angle = step->bodies[i].angle;
    body->fell = 0;
    return true;
}

void check_falls(VerdictWatch *watch, const VerdictStep *step) {
    note_contacts(watch, step);
    for (int i = 0; i < step->body_count; i++) {
        WatchedBody *body = &watch->bodies[i];
        if (body->landed || body_height(&step->bodies[i], watch->run.gravity) >= watch->floor) continue;
        body->landed = true; /* nothing to land on */
        body->stands = false;
    }
    const bool judged = judges_falls(watch, step->bomb);
    find_lower(watch, step);
    for (int i = 0; i < step->body_count; i++) {
        const Body *body = &step->bodies[i];
        WatchedBody *watched = &watch->bodies[i];
        if (body->inv_mass == 0 || !watched->landed || arrives(watch, step, i)) continue;
        const double turned = fabs((double)body->angle - watched->stood_angle) * degrees;
        const bool is_lower = watched->lower - watched->sag > VERDICT_FALL_SHARE * smaller_side(body);
        const bool is_turned = turned > VERDICT_FALL_ANGLE;
        if (!is_lower && !is_turned)
            watched->fell = 0;
        else if (watched->fell == 0)
            watched->fell = step->frame;
        watched->left = is_lower && body_height(body, watch->run.gravity) < watch->floor;
        if (judged && is_lower) verdict_note(watch, VERDICT_FALLS, i, watched->lower, "m");
        if (judged && is_turned) verdict_note(watch, VERDICT_FALLS, i, turned, "deg");
    }
}

void check_creep(VerdictWatch *watch, const VerdictStep *step) {
    const VerdictRun *run = &watch->run;
    if (run->struck != NULL || step->frame < falls_in_steps(watch, VERDICT_CREEP_FROM)) return;
    if ((run->frames - step->frame) % falls_in_steps(watch, 1) != 0) return;
    int farthest = -1;
    double most = VERDICT_CREEP_SHARE;
    for (int i = 0; i < step->body_count; i++) {
        WatchedBody *watched = &watch->bodies[i];
        Vec2 *sample = &watched->sample[watched->samples % VERDICT_CREEP_FALLS], now = step->bodies[i].position;
        const double way = watched->samples >= VERDICT_CREEP_FALLS ? vec2_distance(*sample, now) / watched->size : 0;
        *sample = now;
        watched->samples++;
        if (way <= most || way > VERDICT_CREEP_MOST || (i == step->bomb && !run->stands)) continue;
        most = way;
        farthest = i;
    }
    if (farthest >= 0 && (run->stands || step->frame == run->frames))
        verdict_note(watch, VERDICT_CREEPS, farthest, most * watch->bodies[farthest].size, "m");
}

static bool carry(WatchedBody *from, WatchedBody *to) {
    if (!from->carried || to->carried) return false;
    return to->carried = true;
}

/* Which bodies contacts carry, from static ones on. Passes go up and down the list of contacts, so that few are enough
   for a pile that is listed from either end. */
static void find_carried(const VerdictWatch *watch, const VerdictStep *step) {
    bool more = true;
    for (int i = 0; i < step->body_count; i++) watch->bodies[i].carried = step->bodies[i].inv_mass == 0;
    for (int pass = 0; more; pass++) {
        more = false;
        for (int k = 0; k < step->contact_count; k++) {
            const ContactPoint *contact = &step->contacts[pass % 2 == 0 ? k : step->contact_count - 1 - k];
            if (!exists(step, contact)) continue;
            WatchedBody *a = &watch->bodies[contact->a], *b = &watch->bodies[contact->b];
            more |= carry(a, b) || carry(b, a);
        }
    }
}

/* The part of the limit that the kinetic energy of a body is, and its speed, m/s, if it had all of that energy along a
   line. */
static double unrest(const VerdictWatch *watch, const Body *body, double *speed) {
    const double energy = body_energy(body, vec2(0, 0)) * body->inv_mass; /* m^2/s^2 */
    *speed = sqrt(2 * energy);
    return energy / (VERDICT_CALM_SHARE * watch->pull * verdict_size(body));
}

/* Whether a body must come to rest: in a struck scene those that stood, unless they have left it. */
static bool must_rest(const VerdictWatch *watch, int i) {
    return watch->run.struck == NULL || (watch->bodies[i].stands && !watch->bodies[i].left);
}

void check_calm(VerdictWatch *watch, const VerdictStep *step) {
    const bool carried = vec2_dot(watch->run.gravity, watch->run.gravity) > 0;
    const int longest = falls_in_steps(watch, VERDICT_AIR_TIME);
    int moving = 0;
    double most = 0;
    watch->restless[0] = -1;
    watch->unrest[0] = 0;
    if (carried) find_carried(watch, step);
    for (int i = 0; i < step->body_count; i++) {
        WatchedBody *watched = &watch->bodies[i];
        const Body *body = &step->bodies[i];
        if (body->inv_mass == 0) continue;
        moving++;
        watched->air = !carried || watched->carried ? 0 : watched->air + 1;
        double speed, share = unrest(watch, body, &speed);
        if (share < 1 && watched->air > longest) { /* hangs in the air */
            share = 1;
            speed = 0;
        }
        watched->still = share < 1 && watched->air == 0 && watched->landed ? watched->still + 1 : 0;
        watched->arrived |= watched->still > longest;
        if (!must_rest(watch, i) || share < most || (share == most && watch->restless[0] >= 0)) continue;
        most = share;
        watch->restless[0] = i;
        watch->unrest[0] = speed;
    }
    const double kinetic = bodies_energy(step->bodies, step->body_count, vec2(0, 0));
    watch->kinetic = moving > 0 ? kinetic / moving : 0;
    watch->calm++;
    if (most < 1) return;
    watch->calm = 0;
    watch->restless[1] = watch->restless[0];
    watch->unrest[1] = watch->unrest[0];
}
