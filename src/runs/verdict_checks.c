/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/internal.h"
#include "runs/runs.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>

/* m: height along the direction opposite to gravity. */
static double height(const Body *body, Vec2 gravity, double pull) {
    return -((double)body->position.x * gravity.x + (double)body->position.y * gravity.y) / pull;
}

/* Adds the potential energy of new bodies. The first dynamic bodies determine the lowest height. */
static void add_potential(EnergyBalance *balance, const Body *bodies, int count) {
    const Vec2 gravity = balance->gravity;
    double pull = vec2_distance(gravity, vec2(0, 0)), lowest = INFINITY;
    if (pull == 0) return;
    for (int i = 0; i < count; i++)
        if (bodies[i].inv_mass != 0) lowest = fmin(lowest, height(&bodies[i], gravity, pull));
    if (isinf(balance->lowest)) balance->lowest = lowest;
    for (int i = 0; i < count; i++) {
        if (bodies[i].inv_mass == 0) continue;
        balance->potential += fmax(0, height(&bodies[i], gravity, pull) - balance->lowest) * pull / bodies[i].inv_mass;
        balance->weight += pull / bodies[i].inv_mass;
    }
    balance->available = fmax(balance->available, balance->potential);
}

void energy_balance_begin(EnergyBalance *balance, Vec2 gravity, const Body *bodies, int count) {
    *balance = (EnergyBalance){.gravity = gravity, .lowest = INFINITY, .body_count = count};
    balance->energy = balance->level = balance->brought = bodies_energy(bodies, count, gravity);
    balance->kinetic = bodies_energy(bodies, count, vec2(0, 0));
    add_potential(balance, bodies, count);
}

/* Adds a frame. Bodies may be appended, or the last ones removed, but not both in one step. */
static void energy_balance_step(EnergyBalance *balance, const Body *bodies, int count) {
    const int had = balance->body_count;
    double energy = bodies_energy(bodies, count, balance->gravity);
    if (count > had) {
        const double joined = bodies_energy(bodies + had, count - had, balance->gravity);
        balance->level += joined;
        balance->brought += joined;
        balance->kinetic += bodies_energy(bodies + had, count - had, vec2(0, 0));
        add_potential(balance, bodies + had, count - had);
    }
    /* The energy of removed bodies is no longer known: the step that removes them counts as one without losses. */
    if (count < had) {
        balance->level += energy - balance->energy;
        balance->brought += energy - balance->energy;
    }
    balance->level = fmax(balance->level, energy);
    balance->available = fmax(balance->available, balance->level - energy);
    balance->energy = energy;
    balance->body_count = count;
}

void energy_log_free(EnergyLog *log) {
    free(log->energy);
    *log = (EnergyLog){0};
}

bool energy_log_begin(EnergyLog *log, Vec2 gravity, int frames, const Body *bodies, int count, Error *error) {
    if (!array_reserve((void **)&log->energy, &log->capacity, (size_t)frames + 1, sizeof *log->energy))
        return error_memory(error, "energy log");
    log->frames = frames;
    energy_balance_begin(&log->balance, gravity, bodies, count);
    log->energy[0] = log->balance.energy;
    return true;
}

void energy_log_step(EnergyLog *log, int frame, const Body *bodies, int count) {
    energy_balance_step(&log->balance, bodies, count);
    log->energy[frame] = log->balance.energy;
}

static bool observe(void *context, int frame, const World *world, Error *error) {
    (void)error;
    energy_log_step(context, frame, world_bodies(world), world_body_count(world));
    return true;
}

bool energy_log_run(EnergyLog *log, const Scene *scene, const Method *method, Error *error) {
    World *start = scene_world(scene, error);
    bool ok = start != NULL &&
              energy_log_begin(log, scene->gravity, scene->frames, world_bodies(start), world_body_count(start), error);
    world_destroy(start);
    return ok && simulate_observed(scene, method, &(StepObserver){observe, log}, error);
}

static const double degrees = 57.29577951308232; /* in a radian */

void verdict_note(VerdictWatch *watch, Verdict verdict, int body, double value, const char *unit) {
    if (verdict > watch->worst.verdict)
        watch->worst =
            (VerdictReading){.verdict = verdict, .frame = watch->frame, .body = body, .value = value, .unit = unit};
}

int verdict_steps(double seconds, float dt) {
    long steps = lround(seconds / (double)dt);
    return steps > 1 ? (int)steps : 1;
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

static int most_kinetic(const VerdictStep *step) {
    int most = -1;
    double energy = 0;
    for (int i = 0; i < step->body_count; i++) {
        double kinetic = body_energy(&step->bodies[i], vec2(0, 0));
        if (kinetic <= energy) continue;
        energy = kinetic;
        most = i;
    }
    return most;
}

static void end_second(VerdictWatch *watch, double kept) {
    watch->kept = kept;
    watch->peak_steps = 0;
}

/* J: bound (b) of verdict_watch_step(). */
static double converged_energy(const VerdictRun *run, int frame) {
    const int second = verdict_steps(VERDICT_ENERGY_TIME, run->dt);
    const int from = frame > second ? frame - second : 0;
    const int to = run->converged->frames - frame > second ? frame + second : run->converged->frames;
    double most = -INFINITY;
    for (int i = from; i <= to; i++) most = fmax(most, run->converged->energy[i]);
    return most;
}

/* The contacts of the first step are those of the start. Bodies that overlap there gain energy as they are pushed
   apart. */
static bool overlaps_at_start(const VerdictStep *step) {
    for (int i = 0; i < step->contact_count; i++)
        if (-(double)step->contacts[i].separation > VERDICT_START_OVERLAP) return true;
    return false;
}

/* J: what is no gain of another engine: what its skins may lift, and what gravity does in a step. */
static double tolerated_energy(const VerdictWatch *watch) {
    const EnergyBalance *own = &watch->own;
    const double dt = (double)watch->run.dt, gravity = sqrt((double)vec2_dot(watch->run.gravity, watch->run.gravity));
    const double step = watch->run.other_engine ? own->weight * gravity * dt * dt / 2 : 0;
    if (!isfinite(watch->smallest)) return step;
    return step + 2 * (double)watch->run.skin * (own->weight + own->potential / watch->smallest);
}

/* J: what exceeds the bounds of verdict_watch_step(); 0 if nothing does. Bound (b) searches two seconds of the
   converged run; evaluated only if (a) is exceeded, which is rare. */
static double excess_beside(const VerdictWatch *watch, int frame) {
    const EnergyLog *converged = watch->run.converged;
    const double allowed =
        VERDICT_ENERGY_SHARE * fmax(converged->balance.available, VERDICT_LEAST_AVAILABLE) + tolerated_energy(watch);
    if (watch->energy <= watch->kept + allowed) return 0;
    const double bound = fmax(watch->kept, converged_energy(&watch->run, frame));
    return watch->energy > bound + allowed ? watch->energy - bound : 0;
}

/* The same without a converged run. */
static double excess_alone(const VerdictWatch *watch) {
    const double tolerated = tolerated_energy(watch);
    const EnergyBalance *own = &watch->own;
    const double least = fmax(VERDICT_LEAST_LIFT * own->weight, VERDICT_LEAST_AVAILABLE);
    const double available = fmax(fmax(own->available, own->potential + own->kinetic), least);
    if (watch->energy > watch->brought + VERDICT_ENERGY_SHARE * available + tolerated)
        return watch->energy - watch->brought;
    return watch->energy > watch->kept + VERDICT_REGAIN_SHARE * available + tolerated ? watch->energy - watch->kept : 0;
}

void check_energy(VerdictWatch *watch, const VerdictStep *step) {
    const VerdictRun *run = &watch->run;
    const double before = watch->own.brought;
    energy_balance_step(&watch->own, step->bodies, step->body_count);
    const double energy = watch->energy = watch->own.energy, change = watch->own.brought - before;
    watch->brought += change;
    watch->excess = fmax(watch->excess, energy - watch->own.brought);
    if (step->body_count > watch->body_count) {
        watch->kept += change;
        watch->peak += change;
    }
    if (step->body_count < watch->body_count) end_second(watch, energy);
    if (step->frame == 1 && run->converged == NULL && overlaps_at_start(step)) watch->kept = watch->brought = INFINITY;
    const double gained = run->converged != NULL ? excess_beside(watch, step->frame) : excess_alone(watch);
    if (gained > 0 && !run->no_energy) verdict_note(watch, VERDICT_EXPLODES, most_kinetic(step), gained, "J");
    watch->peak = watch->peak_steps++ > 0 ? fmax(watch->peak, energy) : energy;
    if (watch->peak_steps < verdict_steps(VERDICT_ENERGY_TIME, run->dt)) return;
    end_second(watch, fmin(watch->kept, watch->peak));
    if (isinf(watch->brought)) watch->brought = watch->peak;
}

/* Clips the interval `part` of t to -half < start + t step < half. */
static void clip(double part[2], double start, double step, double half) {
    if (step == 0) {
        if (fabs(start) >= half) part[1] = part[0];
        return;
    }
    double in = (-half - start) / step, out = (half - start) / step;
    const double first = in < out ? in : out, last = in < out ? out : in;
    if (first > part[0]) part[0] = first;
    if (last < part[1]) part[1] = last;
}

/* Whether a step from `start` stays on one side of -half .. half. Decides most steps without a division. */
static bool stays_beside(double start, double step, double half) {
    return (start >= half && start + step >= half) || (start <= -half && start + step <= -half);
}

/* Whether the segment between two points (or the point, if they are equal) intersects the interior of the box. In the
   box's axes and in double, so that it is exact far from the origin too. */
static bool passes(const WatchedStatic *fixed, const Body *box, Vec2 from, Vec2 to) {
    const double c = fixed->cosine, s = fixed->sine;
    double x = (double)from.x - box->position.x, y = (double)from.y - box->position.y;
    double step_x = (double)to.x - from.x, step_y = (double)to.y - from.y;
    const double along = c * x + s * y, step_along = c * step_x + s * step_y, half_along = 0.5 * (double)box->size.x;
    const double up = c * y - s * x, step_up = c * step_y - s * step_x, half_up = 0.5 * (double)box->size.y;
    if (stays_beside(up, step_up, half_up) || stays_beside(along, step_along, half_along)) return false;
    double part[2] = {0, 1};
    clip(part, along, step_along, half_along);
    clip(part, up, step_up, half_up);
    return part[0] < part[1];
}

static bool passes_any(const VerdictWatch *watch, const VerdictStep *step, Vec2 from, Vec2 to) {
    for (int i = 0; i < watch->static_count; i++)
        if (passes(&watch->statics[i], &step->bodies[watch->statics[i].body], from, to)) return true;
    return false;
}

void check_tunnels(VerdictWatch *watch, const VerdictStep *step) {
    for (int i = 0; i < step->body_count; i++) {
        WatchedBody *watched = &watch->bodies[i];
        const Vec2 now = step->bodies[i].position;
        if (step->bodies[i].inv_mass == 0) continue;
        if (passes_any(watch, step, watched->outside, now)) {
            if (passes_any(watch, step, now, now)) continue;
            verdict_note(watch, VERDICT_TUNNELS, i, vec2_distance(watched->last, now) / (double)watch->run.dt, "m/s");
        }
        watched->outside = now;
    }
}

/* A contact's body may have been removed at the end of the step. */
static bool exists(const VerdictStep *step, const ContactPoint *contact) { return contact->b < step->body_count; }

void check_depth(VerdictWatch *watch, const VerdictStep *step) {
    const ContactPoint *deepest = NULL;
    double share = 1;
    for (int i = 0; i < step->contact_count; i++) {
        const ContactPoint *contact = &step->contacts[i];
        if (exists(step, contact)) watch->deepest = fmax(watch->deepest, -(double)contact->separation);
        if (!exists(step, contact) || -(double)contact->separation <= VERDICT_SINK_LEAST) continue;
        double side = fmin(smaller_side(&step->bodies[contact->a]), smaller_side(&step->bodies[contact->b]));
        double found = -(double)contact->separation / fmax(VERDICT_SINK_SHARE * side, VERDICT_SINK_LEAST);
        if (found <= share) continue;
        share = found;
        deepest = contact;
    }
    watch->deep = deepest != NULL ? watch->deep + 1 : 0;
    if (watch->deep < verdict_steps(VERDICT_SINK_TIME, watch->run.dt)) return;
    int body = step->bodies[deepest->b].inv_mass != 0 ? deepest->b : deepest->a;
    verdict_note(watch, VERDICT_SINKS, body, -(double)deepest->separation, "m");
}

/* A body is meant to stay where it was before the step of its first contact. */
static void note_contact(VerdictWatch *watch, int index) {
    WatchedBody *body = &watch->bodies[index];
    if (body->touched) return;
    body->touched = true;
    body->stood = body->last;
    body->stood_angle = body->last_angle;
    watch->touched_count++;
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

/* One pass: the order of contacts is mostly that from below, so that one is enough. */
static bool add_sag(const VerdictWatch *watch, const VerdictStep *step) {
    bool more = false;
    for (int i = 0; i < step->contact_count; i++) {
        BodyPair pair;
        if (!carries(step, &step->contacts[i], watch->run.gravity, &pair)) continue;
        const double sag = watch->bodies[pair.a].sag + mean_depth(step, i);
        if (sag <= watch->bodies[pair.b].sag) continue;
        watch->bodies[pair.b].sag = sag;
        more = true;
    }
    return more;
}

/* How much lower contacts let bodies be. A body in the air keeps its sag. */
static void find_sag(const VerdictWatch *watch, const VerdictStep *step) {
    enum { PASSES = 100 };
    BodyPair pair;
    for (int i = 0; i < step->contact_count; i++)
        if (carries(step, &step->contacts[i], watch->run.gravity, &pair)) watch->bodies[pair.b].sag = 0;
    for (int pass = 0; pass < PASSES && add_sag(watch, step); pass++) continue;
}

/* Finds how much lower each body is. Sag counts from half the limit on: most piles have none to look for. */
static void find_lower(const VerdictWatch *watch, const VerdictStep *step) {
    const double pull = vec2_distance(watch->run.gravity, vec2(0, 0));
    bool any = false;
    for (int i = 0; i < step->body_count; i++) {
        WatchedBody *body = &watch->bodies[i];
        const bool moves = step->bodies[i].inv_mass != 0 && body->touched && pull > 0;
        body->lower = moves ? descent(body->stood, step->bodies[i].position, watch->run.gravity) / pull : 0;
        any |= moves && body->lower > VERDICT_FALL_SHARE / 2 * smaller_side(&step->bodies[i]);
    }
    if (any) find_sag(watch, step);
}

void check_falls(VerdictWatch *watch, const VerdictStep *step) {
    for (int i = 0; i < step->contact_count && watch->touched_count < step->body_count; i++) {
        if (!exists(step, &step->contacts[i])) continue;
        note_contact(watch, step->contacts[i].a);
        note_contact(watch, step->contacts[i].b);
    }
    const bool judged = judges_falls(watch, step->bomb);
    find_lower(watch, step);
    for (int i = 0; i < step->body_count; i++) {
        const Body *body = &step->bodies[i];
        WatchedBody *watched = &watch->bodies[i];
        if (body->inv_mass == 0 || !watched->touched) continue;
        const double turned = fabs((double)body->angle - watched->stood_angle) * degrees;
        const bool is_lower = watched->lower - watched->sag > VERDICT_FALL_SHARE * smaller_side(body);
        const bool is_turned = turned > VERDICT_FALL_ANGLE;
        watched->fallen = is_lower || is_turned;
        if (judged && is_lower) verdict_note(watch, VERDICT_FALLS, i, watched->lower, "m");
        if (judged && is_turned) verdict_note(watch, VERDICT_FALLS, i, turned, "deg");
    }
}

void check_creep(VerdictWatch *watch, const VerdictStep *step) {
    const VerdictRun *run = &watch->run;
    if (step->frame < verdict_steps(VERDICT_CREEP_FROM, run->dt)) return;
    if ((run->frames - step->frame) % verdict_steps(1, run->dt) != 0) return;
    int farthest = -1;
    double most = VERDICT_CREEP_DISTANCE;
    for (int i = 0; i < step->body_count; i++) {
        WatchedBody *watched = &watch->bodies[i];
        Vec2 *sample = &watched->sample[watched->samples % VERDICT_CREEP_SECONDS], now = step->bodies[i].position;
        double way = watched->samples >= VERDICT_CREEP_SECONDS ? vec2_distance(*sample, now) : 0;
        *sample = now;
        watched->samples++;
        if (way <= most || (i == step->bomb && !run->stands)) continue;
        most = way;
        farthest = i;
    }
    if (farthest >= 0 && (run->stands || step->frame == run->frames))
        verdict_note(watch, VERDICT_CREEPS, farthest, most, "m");
}

void check_calm(VerdictWatch *watch, const VerdictStep *step) {
    int moving = 0;
    for (int i = 0; i < step->body_count; i++) moving += step->bodies[i].inv_mass != 0;
    double kinetic = bodies_energy(step->bodies, step->body_count, vec2(0, 0));
    watch->kinetic = moving > 0 ? kinetic / moving : 0;
    watch->calm++;
    if (watch->kinetic < VERDICT_CALM_ENERGY) return;
    watch->calm = 0;
    watch->kinetic_not_calm = watch->kinetic;
}
