/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy of a run, and whether it has more than it can have. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/runs.h"
#include "runs/runs_internal.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

double body_height(const Body *body, Vec2 gravity) {
    const double pull = vec2_distance(gravity, vec2(0, 0));
    if (pull == 0) return 0;
    return -((double)body->position.x * gravity.x + (double)body->position.y * gravity.y) / pull;
}

/* Adds the potential energy of new bodies. The first dynamic bodies determine the lowest height. */
static void add_potential(EnergyBalance *balance, const Body *bodies, int count) {
    const Vec2 gravity = balance->gravity;
    double pull = vec2_distance(gravity, vec2(0, 0)), lowest = INFINITY;
    if (pull == 0) return;
    for (int i = 0; i < count; i++)
        if (bodies[i].inv_mass != 0) lowest = fmin(lowest, body_height(&bodies[i], gravity));
    if (isinf(balance->lowest)) balance->lowest = lowest;
    for (int i = 0; i < count; i++) {
        if (bodies[i].inv_mass == 0) continue;
        balance->potential += fmax(0, body_height(&bodies[i], gravity) - balance->lowest) * pull / bodies[i].inv_mass;
        balance->weight += pull / bodies[i].inv_mass;
        balance->lift += verdict_size(&bodies[i]) * pull / bodies[i].inv_mass;
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

/* J/kg, above a height. */
static double energy_per_kg(const Body *body, Vec2 gravity, double lowest) {
    const double pull = vec2_distance(gravity, vec2(0, 0));
    return body_energy(body, vec2(0, 0)) * body->inv_mass +
           (pull > 0 ? pull * (body_height(body, gravity) - lowest) : 0);
}

void energy_log_free(EnergyLog *log) {
    free(log->energy);
    *log = (EnergyLog){0};
}

bool energy_log_begin(EnergyLog *log, Vec2 gravity, int frames, const Body *bodies, int count, Error *error) {
    if (!array_reserve((void **)&log->energy, &log->capacity, (size_t)frames + 1, sizeof *log->energy))
        return error_memory(error, "energy log");
    log->frames = frames;
    log->unconverged = 0;
    log->fallbacks = (Fallbacks){0};
    log->liveliest = 0;
    energy_balance_begin(&log->balance, gravity, bodies, count);
    log->energy[0] = log->balance.energy;
    return true;
}

void energy_log_step(EnergyLog *log, int frame, const Body *bodies, int count) {
    energy_balance_step(&log->balance, bodies, count);
    log->energy[frame] = log->balance.energy;
    for (int i = 0; i < count; i++)
        if (bodies[i].inv_mass != 0)
            log->liveliest = fmax(log->liveliest, energy_per_kg(&bodies[i], log->balance.gravity, log->balance.lowest));
}

static bool verdict_energy_observe(void *context, int frame, const World *world, Error *error) {
    EnergyLog *log = context;
    (void)error;
    fallbacks_add(&log->fallbacks, &world_solution(world)->fallbacks);
    if (log->unconverged == 0 && log->fallbacks.not_converged > 0) log->unconverged = frame;
    if (log->unconverged == 0) energy_log_step(log, frame, world_bodies(world), world_body_count(world));
    return true;
}

bool energy_log_run(EnergyLog *log, const Scene *scene, const Method *method, Error *error) {
    World *start = scene_world(scene, error);
    bool ok = start != NULL &&
              energy_log_begin(log, scene->gravity, scene->frames, world_bodies(start), world_body_count(start), error);
    world_destroy(start);
    return ok && simulate_observed(scene, method, &(StepObserver){verdict_energy_observe, log}, error);
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

static void end_fall(VerdictWatch *watch, double kept) {
    watch->kept = kept;
    watch->peak_steps = 0;
}

/* Whether the run is judged beside a converged one in this frame. */
static bool is_beside(const VerdictRun *run, int frame) {
    return run->converged != NULL && (run->converged->unconverged == 0 || frame < run->converged->unconverged);
}

/* J: bound (b) of verdict_watch_step(). */
static double converged_energy(const VerdictRun *run, int frame, int fall) {
    const int from = frame > fall ? frame - fall : 0;
    const int first = run->converged->unconverged, last = first > 0 ? first - 1 : run->converged->frames;
    const int to = last - frame > fall ? frame + fall : last;
    double most = -INFINITY;
    for (int i = from; i <= to; i++) most = fmax(most, run->converged->energy[i]);
    return most;
}

/* The contacts of the first step are those of the start. Bodies that overlap there gain energy as they are pushed
   apart. */
static bool overlaps_at_start(const VerdictStep *step) {
    for (int i = 0; i < step->contact_count; i++) {
        const ContactPoint *contact = &step->contacts[i];
        if (contact->b < step->body_count &&
            -(double)contact->separation > VERDICT_START_OVERLAP * smaller_size(step, contact))
            return true;
    }
    return false;
}

/* J: most that a step's rounding to float32 can have added. A position is rounded by half of its last bit, and by no
   more than the body moves: what is at rest has no rounding. */
static double step_rounding(const VerdictWatch *watch, const VerdictStep *step) {
    const double half_bit = FLT_EPSILON / 2.0;
    const Vec2 gravity = watch->run.gravity;
    double sum = 0;
    for (int i = 0; i < step->body_count && i < watch->body_count; i++) {
        const Body *body = &step->bodies[i];
        const Vec2 now = body->position, last = watch->bodies[i].last, v = body->velocity;
        if (body->inv_mass == 0) continue;
        const double x = fmin(fabs((double)now.x - last.x), half_bit * fabs((double)now.x)),
                     y = fmin(fabs((double)now.y - last.y), half_bit * fabs((double)now.y));
        const double square = (double)v.x * v.x + (double)v.y * v.y;
        sum += (fabs((double)gravity.x) * x + fabs((double)gravity.y) * y + half_bit * square) / body->inv_mass;
    }
    return sum;
}

/* J: what gravity does in a step, m (g dt)^2 / 2. */
static double step_energy(const VerdictWatch *watch) {
    const double dt = (double)watch->run.dt, gravity = vec2_distance(watch->run.gravity, vec2(0, 0));
    return watch->own.weight * gravity * dt * dt / 2;
}

/* J: what is no gain: rounding; of another engine, what its skins may lift, and what gravity does in a step. */
static double tolerated_energy(const VerdictWatch *watch) {
    const EnergyBalance *own = &watch->own;
    const double step = watch->run.other_engine ? step_energy(watch) : 0;
    if (!isfinite(watch->smallest)) return step + watch->rounding;
    return step + watch->rounding + 2 * (double)watch->run.skin * (own->weight + own->potential / watch->smallest);
}

/* J: what exceeds the bounds of verdict_watch_step(); 0 if nothing does. Bound (b) searches two falls of the
   converged run; evaluated only if (a) is exceeded, which is rare. */
static double excess_beside(const VerdictWatch *watch, int frame) {
    const EnergyLog *converged = watch->run.converged;
    const double allowed =
        fmax(VERDICT_ENERGY_SHARE * fmax(converged->balance.available, VERDICT_LEAST_LIFT * watch->own.lift),
             step_energy(watch)) +
        tolerated_energy(watch);
    if (watch->energy <= watch->kept + allowed) return 0;
    const double bound =
        fmax(watch->kept, converged_energy(&watch->run, frame, falls_in_steps(watch, VERDICT_ENERGY_TIME)));
    return watch->energy > bound + allowed ? watch->energy - bound : 0;
}

/* The same without a converged run. */
static double excess_alone(const VerdictWatch *watch) {
    const double tolerated = tolerated_energy(watch);
    const EnergyBalance *own = &watch->own;
    const double available = fmax(fmax(own->available, own->potential + own->kinetic), VERDICT_LEAST_LIFT * own->lift);
    const double gain = fmax(VERDICT_ENERGY_SHARE * available, step_energy(watch)),
                 regain = fmax(VERDICT_REGAIN_SHARE * available, step_energy(watch));
    if (watch->energy > watch->brought + gain + tolerated) return watch->energy - watch->brought;
    return watch->energy > watch->kept + regain + tolerated ? watch->energy - watch->kept : 0;
}

void check_energy(VerdictWatch *watch, const VerdictStep *step) {
    const VerdictRun *run = &watch->run;
    const double before = watch->own.brought;
    energy_balance_step(&watch->own, step->bodies, step->body_count);
    const double energy = watch->energy = watch->own.energy, change = watch->own.brought - before;
    watch->brought += change;
    watch->excess = fmax(watch->excess, energy - watch->own.brought);
    watch->rounding += step_rounding(watch, step);
    if (step->body_count > watch->body_count) {
        watch->kept += change;
        watch->peak += change;
    }
    if (step->body_count < watch->body_count) end_fall(watch, energy);
    const bool alone = run->converged == NULL || run->converged->unconverged > 0;
    if (step->frame == 1 && alone && overlaps_at_start(step)) watch->kept = watch->brought = INFINITY;
    const double gained = is_beside(run, step->frame) ? excess_beside(watch, step->frame) : excess_alone(watch);
    if (gained > 0 && !run->no_energy) verdict_note(watch, VERDICT_EXPLODES, most_kinetic(step), gained, "J");
    watch->peak = watch->peak_steps++ > 0 ? fmax(watch->peak, energy) : energy;
    if (watch->peak_steps < falls_in_steps(watch, VERDICT_ENERGY_TIME)) return;
    end_fall(watch, fmin(watch->kept, watch->peak));
    if (isinf(watch->brought)) watch->brought = watch->peak;
}

void check_bursts(VerdictWatch *watch, const VerdictStep *step) {
    const VerdictRun *run = &watch->run;
    const double pull = vec2_distance(run->gravity, vec2(0, 0)), lowest = watch->own.lowest;
    if (!isfinite(watch->highest)) return;
    const double height = (pull > 0 ? watch->highest - lowest : 0) + watch->largest;
    const double own = watch->liveliest + watch->pull * height; /* J/kg */
    const double source = run->converged != NULL ? fmax(own, run->converged->liveliest) : own;
    for (int i = 0; i < step->body_count; i++) {
        const Body *body = &step->bodies[i];
        if (body->inv_mass == 0) continue;
        const double energy = energy_per_kg(body, run->gravity, lowest);
        if (energy > VERDICT_BURST * source + watch->rounding * body->inv_mass)
            verdict_note(watch, VERDICT_EXPLODES, i, (energy - source) / body->inv_mass, "J");
    }
}
