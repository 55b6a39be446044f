/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/sweeps.h"

#include "common/array.h"
#include "solvers/contact_velocity.h"
#include "solvers/sweeps_kernels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    COLOURED_AT_ONCE = 2,     /* sweeps in a schedule by colours: more would share few levels */
    VISITS_AT_ONCE = 1 << 12, /* visits in one schedule: it should stay in the cache */
    LEVEL_PAYS = 3            /* visits a level from which on lanes are faster than one by one */
};

void sweeps_free(Sweeps *sweeps) {
    SweepSchedule *schedules[] = {&sweeps->whole, &sweeps->rest};
    for (int i = 0; i < 2; i++) {
        free(schedules[i]->levels);
        free(schedules[i]->filled);
        free(schedules[i]->open);
        free(schedules[i]->turns);
        free(schedules[i]->body_turns);
        free(schedules[i]->unsorted);
        free(schedules[i]->turns_end);
    }
    free(sweeps->bodies);
    free(sweeps->pairs);
    free(sweeps->ends);
    free(sweeps->scheduled);
    free(sweeps->moves);
    free(sweeps->quiet_since);
    free(sweeps->changed_at);
    free(sweeps->ready);
    free(sweeps->seen);
    free(sweeps->sums);
    free(sweeps->first);
    colours_free(&sweeps->colours);
    *sweeps = (Sweeps){0};
}

bool sweeps_can(SweepKernel kernel) {
    return kernel == SWEEP_ONE_BY_ONE || (kernel == SWEEP_AVX2 && sweeps_have_avx2());
}

SweepKernel sweeps_best_kernel(void) { return sweeps_can(SWEEP_AVX2) ? SWEEP_AVX2 : SWEEP_ONE_BY_ONE; }

static bool reserve(Sweeps *sweeps, const ContactProblem *problem) {
    size_t bodies = (size_t)problem->body_count + 1, pairs = (size_t)problem->contact_count + 1;
    if (2 * bodies <= sweeps->body_capacity && bodies <= sweeps->ready_capacity && pairs <= sweeps->scheduled_capacity)
        return true;
    return array_reserve((void **)&sweeps->bodies, &sweeps->body_capacity, 2 * bodies, sizeof *sweeps->bodies) &&
           array_reserve((void **)&sweeps->moves, &sweeps->moves_capacity, bodies, sizeof *sweeps->moves) &&
           array_reserve((void **)&sweeps->ready, &sweeps->ready_capacity, bodies, sizeof *sweeps->ready) &&
           array_reserve((void **)&sweeps->first, &sweeps->first_capacity, pairs, sizeof *sweeps->first) &&
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
static void load_point(SweepPair *pair, int k, const ContactPoint *contact, float extra, bool warm, float relaxation) {
    SweepPoint *point = &pair->points[k];
    pair->sums[k].normal = warm ? contact->warm_normal : 0.0f;
    pair->sums[k].tangent = warm ? contact->warm_tangent : 0.0f;
    point->arm_a = contact->arm_a;
    point->arm_b = contact->arm_b;
    point->mass_normal = relaxation * contact->mass_normal;
    point->mass_tangent = relaxation * contact->mass_tangent;
    point->bias = contact->bias;
    point->extra = extra;
}

/* The pair that begins with the problem's contact number `first`; returns how many points it has. */
static int load_pair(Sweeps *sweeps, const ContactProblem *problem, int first, bool warm, float relaxation) {
    static const ContactPoint none = {0};
    const ContactPoint *contact = &problem->contacts[first], *next = contact + 1;
    const bool two = first + 1 < problem->contact_count && contact_shares_surface(contact, next);
    SweepPair *pair = &sweeps->pairs[sweeps->pair_count];
    pair->normal = contact->normal;
    pair->friction = contact->friction;
    pair->inv_inertia_a = problem->bodies[contact->a].inv_inertia;
    load_point(pair, 0, contact, problem->bodies[contact->b].inv_inertia, warm, relaxation);
    load_point(pair, 1, two ? next : &none, two ? -1.0f : 0.0f, warm, relaxation);
    sweeps->first[sweeps->pair_count] = first;
    sweeps->ends[sweeps->pair_count++] = ends_of(sweeps, contact->a, contact->b);
    return two ? 2 : 1;
}

/* visits: the order of contacts, the two of a pair together; or NULL, as they are given. */
static void load_pairs(Sweeps *sweeps, const ContactProblem *problem, const int32_t *visits, bool warm,
                       float relaxation) {
    sweeps->pair_count = 0;
    for (int i = 0; i < problem->contact_count;)
        i += load_pair(sweeps, problem, visits != NULL ? visits[i] : i, warm, relaxation);
    sweeps->pairs[sweeps->pair_count] = (SweepPair){0};
}

static bool begin(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem, const int32_t *visits, bool warm,
                  float relaxation) {
    if (!reserve(sweeps, problem)) return false;
    sweeps->kernel = kernel;
    sweeps->coloured = visits != NULL;
    load_bodies(sweeps, problem);
    load_pairs(sweeps, problem, visits, warm, relaxation);
    sweeps_warm_start(sweeps);
    return true;
}

bool sweeps_begin(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem, bool warm, float relaxation) {
    return begin(sweeps, kernel, problem, NULL, warm, relaxation);
}

bool sweeps_begin_coloured(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem) {
    return colours_order(&sweeps->colours, problem) &&
           begin(sweeps, kernel, problem, sweeps->colours.visits, true, 1.0f);
}

/* Makes both schedules, unless those of the step before are for the same pairs. turns: with extrapolation. */
static bool reschedule(Sweeps *sweeps, int at_once, int rest, bool turns) {
    size_t size = (size_t)sweeps->pair_count * sizeof *sweeps->ends;
    if (sweeps->scheduled_count == sweeps->pair_count && memcmp(sweeps->scheduled, sweeps->ends, size) == 0 &&
        sweeps->scheduled_bodies == sweeps->body_count && sweeps->whole.sweeps == at_once &&
        sweeps->rest.sweeps == rest && sweeps->scheduled_turns == turns)
        return true;
    sweeps->scheduled_count = 0;
    if (!sweeps_schedule(&sweeps->whole, sweeps, at_once, turns) ||
        !sweeps_schedule(&sweeps->rest, sweeps, rest, turns))
        return false;
    memcpy(sweeps->scheduled, sweeps->ends, size);
    sweeps->scheduled_count = sweeps->pair_count;
    sweeps->scheduled_bodies = sweeps->body_count;
    sweeps->scheduled_turns = turns;
    return true;
}

/* The number of sweeps in one schedule: equal parts of them all, if possible. With extrapolation an even one, where
   it is run more than once: each run begins in the same half of the bodies and sums. */
static int sweeps_at_once(const Sweeps *sweeps, int count, bool turns) {
    const int limit = sweeps->coloured ? COLOURED_AT_ONCE : SWEEPS_AT_ONCE;
    int most = VISITS_AT_ONCE / sweeps->pair_count;
    if (most > limit) most = limit;
    if (most < 1) most = 1;
    if (count <= most) return count;
    int equal = count / ((count + most - 1) / most);
    return turns ? equal + equal % 2 : equal;
}

/* By lanes, where the processor has them and enough visits share a level. */
static bool run(Sweeps *sweeps, const float *factors, int count) {
    bool turns = factors != NULL;
    int at_once = sweeps_at_once(sweeps, count, turns);
    if (sweeps->kernel != SWEEP_ONE_BY_ONE && !reschedule(sweeps, at_once, count % at_once, turns)) return false;
    bool narrow = LEVEL_PAYS * sweeps->whole.level_count > at_once * sweeps->pair_count;
    if (sweeps->kernel == SWEEP_ONE_BY_ONE || narrow) {
        sweeps_run_one_by_one(sweeps, factors, count);
        return true;
    }
    int done = 0;
    for (; done + at_once <= count; done += at_once)
        sweeps_run_avx2(sweeps, &sweeps->whole, turns ? factors + done : NULL);
    sweeps_run_avx2(sweeps, &sweeps->rest, turns ? factors + done : NULL);
    return true;
}

bool sweeps_begin_blocks(Sweeps *sweeps, const ContactProblem *problem) {
    if (!sweeps_begin(sweeps, sweeps_best_kernel(), problem, true, 1.0f)) return false;
    const ContactPoint *contact = problem->contacts;
    for (int i = 0; i < sweeps->pair_count; i++) {
        SweepPair *pair = &sweeps->pairs[i];
        bool two = pair->points[1].extra < 0.0f;
        pair->block = two ? block_make(contact, contact + 1, problem->bodies) : (Block){0};
        contact += two ? 2 : 1;
    }
    return true;
}

bool sweeps_run_blocks(Sweeps *sweeps, int count) {
    if (sweeps->pair_count == 0) return true;
    int at_once = sweeps_at_once(sweeps, count, false);
    if (!reschedule(sweeps, at_once, count % at_once, false)) return false;
    for (int done = 0; done + at_once <= count; done += at_once) sweeps_run_blocks_avx2(sweeps, &sweeps->whole);
    sweeps_run_blocks_avx2(sweeps, &sweeps->rest);
    return true;
}

bool sweeps_run(Sweeps *sweeps, int count) { return sweeps->pair_count == 0 || run(sweeps, NULL, count); }

/* Both halves alike: the first sweep has no change before it to go on by. */
static bool begin_turns(Sweeps *sweeps) {
    size_t half = (size_t)sweeps->pair_count + 1, bodies = (size_t)sweeps->body_count + 1;
    if (!array_reserve((void **)&sweeps->sums, &sweeps->sums_capacity, 4 * half, sizeof *sweeps->sums) ||
        !array_reserve((void **)&sweeps->seen, &sweeps->seen_capacity, bodies, sizeof *sweeps->seen))
        return false;
    memcpy(sweeps->bodies + bodies, sweeps->bodies, bodies * sizeof *sweeps->bodies);
    for (size_t i = 0; i < half; i++) memcpy(sweeps->sums + 2 * i, sweeps->pairs[i].sums, sizeof sweeps->pairs[i].sums);
    memcpy(sweeps->sums + 2 * half, sweeps->sums, 2 * half * sizeof *sweeps->sums);
    return true;
}

static void swap_halves(Sweeps *sweeps) {
    const size_t bodies = (size_t)sweeps->body_count + 1;
    for (size_t i = 0; i < bodies; i++) {
        const SweepBody first = sweeps->bodies[i];
        sweeps->bodies[i] = sweeps->bodies[bodies + i];
        sweeps->bodies[bodies + i] = first;
    }
}

/* The half that the last sweep worked in becomes the first; the sums of both stay where they are. */
static void end_turns(Sweeps *sweeps, int count) {
    const size_t half = (size_t)sweeps->pair_count + 1, last = (size_t)(count + 1) % 2;
    if (last == 1) swap_halves(sweeps);
    const ContactImpulse *sums = sweeps->sums + last * 2 * half;
    for (size_t i = 0; i < half; i++) memcpy(sweeps->pairs[i].sums, sums + 2 * i, sizeof sweeps->pairs[i].sums);
}

bool sweeps_run_momentum(Sweeps *sweeps, const float *factors, int count) {
    if (sweeps->pair_count == 0 || count == 0) return true;
    if (!begin_turns(sweeps) || !run(sweeps, factors, count)) return false;
    end_turns(sweeps, count);
    return true;
}

bool sweeps_continue_momentum(Sweeps *sweeps, const float *factors, int count) {
    if (sweeps->pair_count == 0) return true;
    swap_halves(sweeps);
    if (!run(sweeps, factors, count)) return false;
    end_turns(sweeps, count);
    return true;
}

bool sweeps_end(const Sweeps *sweeps, ContactSolution *solution) {
    bool finite = true;
    for (int i = 0; i < sweeps->body_count; i++) {
        const SweepBody *body = &sweeps->bodies[i];
        solution->velocities[i] = (BodyVelocity){vec2(body->x, body->y), body->spin};
        finite &= isfinite(body->x) && isfinite(body->y) && isfinite(body->spin);
    }
    for (int i = 0; i < sweeps->pair_count; i++) {
        const SweepPair *pair = &sweeps->pairs[i];
        ContactImpulse *impulses = &solution->impulses[sweeps->first[i]];
        impulses[0] = pair->sums[0];
        if (pair->points[1].extra < 0.0f) impulses[1] = pair->sums[1];
    }
    return finite;
}
