/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/sweeps.h"

#include "common/array.h"
#include "solvers/sweeps_kernels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    SWEEPS_AT_ONCE = 16,      /* sweeps in one schedule; more are this one again */
    VISITS_AT_ONCE = 1 << 12, /* visits in one schedule: it should stay in the cache */
    LEVEL_PAYS = 3            /* visits a level from which on lanes are faster than one by one */
};

void sweeps_free(Sweeps *sweeps) {
    SweepSchedule *schedules[] = {&sweeps->whole, &sweeps->rest};
    for (int i = 0; i < 2; i++) {
        free(schedules[i]->levels);
        free(schedules[i]->filled);
        free(schedules[i]->open);
    }
    free(sweeps->bodies);
    free(sweeps->pairs);
    free(sweeps->ends);
    free(sweeps->scheduled);
    free(sweeps->moves);
    free(sweeps->quiet_since);
    free(sweeps->changed_at);
    free(sweeps->ready);
    *sweeps = (Sweeps){0};
}

bool sweeps_can(SweepKernel kernel) {
    return kernel == SWEEP_ONE_BY_ONE || (kernel == SWEEP_AVX2 && sweeps_have_avx2());
}

static bool reserve(Sweeps *sweeps, const ContactProblem *problem) {
    size_t bodies = (size_t)problem->body_count + 1, pairs = (size_t)problem->contact_count + 1;
    if (bodies <= sweeps->ready_capacity && pairs <= sweeps->scheduled_capacity) return true;
    return array_reserve((void **)&sweeps->bodies, &sweeps->body_capacity, bodies, sizeof *sweeps->bodies) &&
           array_reserve((void **)&sweeps->moves, &sweeps->moves_capacity, bodies, sizeof *sweeps->moves) &&
           array_reserve((void **)&sweeps->ready, &sweeps->ready_capacity, bodies, sizeof *sweeps->ready) &&
           array_reserve((void **)&sweeps->pairs, &sweeps->pair_capacity, pairs, sizeof *sweeps->pairs) &&
           array_reserve((void **)&sweeps->quiet_since, &sweeps->quiet_capacity, pairs, sizeof *sweeps->quiet_since) &&
           array_reserve((void **)&sweeps->changed_at, &sweeps->changed_capacity, bodies, sizeof *sweeps->changed_at) &&
           array_reserve((void **)&sweeps->ends, &sweeps->ends_capacity, pairs, sizeof *sweeps->ends) &&
           array_reserve((void **)&sweeps->scheduled, &sweeps->scheduled_capacity, pairs, sizeof *sweeps->scheduled);
}

static bool is_negative_zero(float x) { return x == 0.0f && signbit(x); }

/* Can an impulse change the velocity? Without mass only where it is -0, which may become 0. */
static bool moves(const ProblemBody *body) {
    return body->inv_mass != 0.0f || body->inv_inertia != 0.0f || is_negative_zero(body->velocity.x) ||
           is_negative_zero(body->velocity.y) || is_negative_zero(body->angular_velocity);
}

/* Can both be points of one SweepPair? */
static bool share_surface(const ContactPoint *first, const ContactPoint *second) {
    return first->a == second->a && first->b == second->b &&
           memcmp(&first->normal, &second->normal, sizeof first->normal) == 0 &&
           memcmp(&first->friction, &second->friction, sizeof first->friction) == 0;
}

static void load_bodies(Sweeps *sweeps, const ContactProblem *problem) {
    sweeps->body_count = problem->body_count;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        sweeps->bodies[i] = (SweepBody){body->velocity.x, body->velocity.y, body->angular_velocity, body->inv_mass};
        sweeps->moves[i] = moves(body);
    }
    sweeps->bodies[problem->body_count] = (SweepBody){0};
}

/* Where neither moves, a counts as moving: the visits of one pair must not share a level. */
static SweepEnds ends_of(const Sweeps *sweeps, int a, int b) {
    bool moves_a = sweeps->moves[a] || !sweeps->moves[b];
    return (SweepEnds){moves_a ? a : ~a, sweeps->moves[b] ? b : ~b};
}

/* Member by member: a record is written once and not copied. */
static void load_point(SweepPair *pair, int k, const ContactPoint *contact, float extra) {
    SweepPoint *point = &pair->points[k];
    pair->sums[k].normal = contact->warm_normal;
    pair->sums[k].tangent = contact->warm_tangent;
    point->arm_a = contact->arm_a;
    point->arm_b = contact->arm_b;
    point->mass_normal = contact->mass_normal;
    point->mass_tangent = contact->mass_tangent;
    point->bias = contact->bias;
    point->extra = extra;
}

static void load_pairs(Sweeps *sweeps, const ContactProblem *problem) {
    static const ContactPoint none = {0};
    sweeps->pair_count = 0;
    for (int i = 0; i < problem->contact_count;) {
        const ContactPoint *contact = &problem->contacts[i], *next = contact + 1;
        bool two = i + 1 < problem->contact_count && share_surface(contact, next);
        SweepPair *pair = &sweeps->pairs[sweeps->pair_count];
        pair->normal = contact->normal;
        pair->friction = contact->friction;
        pair->inv_inertia_a = problem->bodies[contact->a].inv_inertia;
        load_point(pair, 0, contact, problem->bodies[contact->b].inv_inertia);
        load_point(pair, 1, two ? next : &none, two ? -1.0f : 0.0f);
        sweeps->ends[sweeps->pair_count++] = ends_of(sweeps, contact->a, contact->b);
        i += two ? 2 : 1;
    }
    sweeps->pairs[sweeps->pair_count] = (SweepPair){0};
}

bool sweeps_begin(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem) {
    if (!reserve(sweeps, problem)) return false;
    sweeps->kernel = kernel;
    load_bodies(sweeps, problem);
    load_pairs(sweeps, problem);
    sweeps_warm_start(sweeps);
    return true;
}

/* Makes both schedules, unless those of the step before are for the same pairs. */
static bool reschedule(Sweeps *sweeps, int at_once, int rest) {
    size_t size = (size_t)sweeps->pair_count * sizeof *sweeps->ends;
    if (sweeps->scheduled_count == sweeps->pair_count && memcmp(sweeps->scheduled, sweeps->ends, size) == 0 &&
        sweeps->scheduled_bodies == sweeps->body_count && sweeps->whole.sweeps == at_once &&
        sweeps->rest.sweeps == rest)
        return true;
    sweeps->scheduled_count = 0;
    if (!sweeps_schedule(&sweeps->whole, sweeps, at_once) || !sweeps_schedule(&sweeps->rest, sweeps, rest))
        return false;
    memcpy(sweeps->scheduled, sweeps->ends, size);
    sweeps->scheduled_count = sweeps->pair_count;
    sweeps->scheduled_bodies = sweeps->body_count;
    return true;
}

/* The number of sweeps in one schedule: equal parts of them all, if possible. */
static int sweeps_at_once(int pair_count, int count) {
    int most = VISITS_AT_ONCE / pair_count;
    if (most > SWEEPS_AT_ONCE) most = SWEEPS_AT_ONCE;
    if (most < 1) return 1;
    return count / ((count + most - 1) / most);
}

bool sweeps_run(Sweeps *sweeps, int count) {
    if (sweeps->pair_count == 0) return true;
    int at_once = sweeps_at_once(sweeps->pair_count, count);
    if (sweeps->kernel != SWEEP_ONE_BY_ONE && !reschedule(sweeps, at_once, count % at_once)) return false;
    bool narrow = LEVEL_PAYS * sweeps->whole.level_count > at_once * sweeps->pair_count;
    if (sweeps->kernel == SWEEP_ONE_BY_ONE || narrow) {
        sweeps_run_one_by_one(sweeps, count);
        return true;
    }
    for (int done = 0; done + at_once <= count; done += at_once) sweeps_run_avx2(sweeps, &sweeps->whole);
    sweeps_run_avx2(sweeps, &sweeps->rest);
    return true;
}

bool sweeps_end(const Sweeps *sweeps, ContactSolution *solution) {
    bool finite = true;
    for (int i = 0; i < sweeps->body_count; i++) {
        const SweepBody *body = &sweeps->bodies[i];
        solution->velocities[i] = (BodyVelocity){vec2(body->x, body->y), body->spin};
        finite &= isfinite(body->x) && isfinite(body->y) && isfinite(body->spin);
    }
    for (int i = 0, contact = 0; i < sweeps->pair_count; i++) {
        const SweepPair *pair = &sweeps->pairs[i];
        solution->impulses[contact++] = pair->sums[0];
        if (pair->points[1].extra < 0.0f) solution->impulses[contact++] = pair->sums[1];
    }
    return finite;
}
