/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/verdict_checks.h"

#include "study/world_measures.h"

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

double verdict_distance(Vec2 a, Vec2 b) { return hypot((double)a.x - b.x, (double)a.y - b.y); }
static double smaller_side(const Body *body) { return fminf(body->size.x, body->size.y); }

bool check_finite(VerdictWatch *watch, const VerdictStep *step) {
    double speed = 0;
    for (int i = 0; i < step->body_count; i++) {
        const Body *body = &step->bodies[i];
        if (!isfinite(body->position.x) || !isfinite(body->position.y) || !isfinite(body->angle) ||
            !isfinite(body->velocity.x) || !isfinite(body->velocity.y) || !isfinite(body->angular_velocity)) {
            verdict_note(watch, VERDICT_NON_FINITE, i, watch->speed, "m/s");
            return false;
        }
        speed = fmax(speed, verdict_distance(body->velocity, vec2(0, 0)));
    }
    watch->speed = speed;
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

void check_energy(VerdictWatch *watch, const VerdictStep *step) {
    const VerdictRun *run = &watch->run;
    double energy = bodies_energy(step->bodies, step->body_count, run->gravity);
    watch->energy = energy;
    int joined = step->body_count - watch->body_count;
    double brought = joined > 0 ? bodies_energy(step->bodies + watch->body_count, joined, run->gravity) : 0;
    watch->kept += brought;
    watch->peak += brought;
    if (joined < 0) end_second(watch, energy);
    double allowed = VERDICT_ENERGY_SHARE * fmax(run->converged->available, VERDICT_LEAST_AVAILABLE);
    /* Bound (b) searches two seconds of the converged run; evaluated only if (a) is exceeded, which is rare. */
    if (energy > watch->kept + allowed) {
        double bound = fmax(watch->kept, converged_energy(run, step->frame));
        if (energy > bound + allowed) verdict_note(watch, VERDICT_EXPLODES, most_kinetic(step), energy - bound, "J");
    }
    watch->peak = watch->peak_steps++ > 0 ? fmax(watch->peak, energy) : energy;
    if (watch->peak_steps >= verdict_steps(VERDICT_ENERGY_TIME, run->dt))
        end_second(watch, fmin(watch->kept, watch->peak));
}

/* Clips the interval `part` of t to -half < start + t step < half. */
static void clip(double part[2], double start, double step, double half) {
    if (step == 0) {
        if (fabs(start) >= half) part[1] = part[0];
        return;
    }
    double in = (-half - start) / step, out = (half - start) / step;
    part[0] = fmax(part[0], fmin(in, out));
    part[1] = fmin(part[1], fmax(in, out));
}

/* Whether the segment between two points (or the point, if they are equal) intersects the interior of the box. In the
   box's axes and in double, so that it is exact far from the origin too. */
static bool passes(const Body *box, Vec2 from, Vec2 to) {
    double c = cos((double)box->angle), s = sin((double)box->angle);
    double x = (double)from.x - box->position.x, y = (double)from.y - box->position.y;
    double step_x = (double)to.x - from.x, step_y = (double)to.y - from.y;
    double part[2] = {0, 1};
    clip(part, c * x + s * y, c * step_x + s * step_y, 0.5 * (double)box->size.x);
    clip(part, c * y - s * x, c * step_y - s * step_x, 0.5 * (double)box->size.y);
    return part[0] < part[1];
}

static bool passes_any(const VerdictStep *step, Vec2 from, Vec2 to) {
    for (int i = 0; i < step->body_count; i++)
        if (step->bodies[i].inv_mass == 0 && passes(&step->bodies[i], from, to)) return true;
    return false;
}

void check_tunnels(VerdictWatch *watch, const VerdictStep *step) {
    for (int i = 0; i < step->body_count; i++) {
        WatchedBody *watched = &watch->bodies[i];
        const Vec2 now = step->bodies[i].position;
        if (step->bodies[i].inv_mass == 0 || passes_any(step, now, now)) continue;
        if (passes_any(step, watched->outside, now))
            verdict_note(watch, VERDICT_TUNNELS, i, verdict_distance(watched->last, now) / (double)watch->run.dt,
                         "m/s");
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
        if (!exists(step, contact)) continue;
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
static void note_contact(WatchedBody *body) {
    if (body->touched) return;
    body->touched = true;
    body->stood = body->last;
    body->stood_angle = body->last_angle;
}

/* m: descent along gravity. */
static double lowered(Vec2 from, Vec2 to, Vec2 gravity) {
    double pull = hypot((double)gravity.x, (double)gravity.y);
    if (pull == 0) return 0;
    return (((double)to.x - from.x) * gravity.x + ((double)to.y - from.y) * gravity.y) / pull;
}

void check_falls(VerdictWatch *watch, const VerdictStep *step) {
    if (!watch->run.stands) return;
    for (int i = 0; i < step->contact_count; i++) {
        if (!exists(step, &step->contacts[i])) continue;
        note_contact(&watch->bodies[step->contacts[i].a]);
        note_contact(&watch->bodies[step->contacts[i].b]);
    }
    for (int i = 0; i < step->body_count; i++) {
        const Body *body = &step->bodies[i];
        const WatchedBody *watched = &watch->bodies[i];
        if (body->inv_mass == 0 || !watched->touched) continue;
        double lower = lowered(watched->stood, body->position, watch->run.gravity);
        double turned = fabs((double)body->angle - watched->stood_angle) * degrees;
        if (lower > VERDICT_FALL_SHARE * smaller_side(body)) verdict_note(watch, VERDICT_FALLS, i, lower, "m");
        if (turned > VERDICT_FALL_ANGLE) verdict_note(watch, VERDICT_FALLS, i, turned, "deg");
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
        double way = watched->samples >= VERDICT_CREEP_SECONDS ? verdict_distance(*sample, now) : 0;
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
