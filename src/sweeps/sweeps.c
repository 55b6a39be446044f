/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sweeps/sweeps.h"

#include "common/array.h"
#include "sweeps/sweeps_kernels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    COLOURED_AT_ONCE = 2,     /* sweeps in a coloured schedule: more would share few levels */
    VISITS_AT_ONCE = 1 << 12, /* visits in one schedule, which should stay in the cache */
    LEVEL_PAYS = 3            /* visits per level from which on lanes are faster */
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

/* Makes both schedules, unless those of the last step are for the same pairs. turns: with momentum extrapolation. */
static bool reschedule(Sweeps *sweeps, int at_once, int rest, bool turns) {
    size_t size = (size_t)sweeps->pair_count * sizeof *sweeps->ends;
    if (sweeps->scheduled_count == sweeps->pair_count && memcmp(sweeps->scheduled, sweeps->ends, size) == 0 &&
        sweeps->scheduled_bodies == sweeps->body_count && sweeps->whole.sweeps == at_once &&
        (rest == 0 || sweeps->rest.sweeps == rest) && sweeps->scheduled_turns == turns)
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

/* The number of sweeps in one schedule: an equal part of all sweeps, if possible. With momentum extrapolation an even
   number if the schedule is run more than once: each run begins in the same half of the bodies and sums. */
static int sweeps_at_once(const Sweeps *sweeps, int count, bool turns) {
    const int limit = sweeps->coloured ? COLOURED_AT_ONCE : SWEEPS_AT_ONCE;
    int most = VISITS_AT_ONCE / sweeps->pair_count;
    if (most > limit) most = limit;
    if (most < 1) most = 1;
    if (sweeps->block > 0) count = sweeps->block;
    if (count <= most) return count;
    int equal = count / ((count + most - 1) / most);
    return turns ? equal + equal % 2 : equal;
}

/* True to use lanes: the processor has them and enough visits share a level. */
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
    if (done < count) sweeps_run_avx2(sweeps, &sweeps->rest, turns ? factors + done : NULL);
    return true;
}

bool sweeps_run_blocks(Sweeps *sweeps, int count) {
    if (sweeps->pair_count == 0) return true;
    int at_once = sweeps_at_once(sweeps, count, false);
    if (!reschedule(sweeps, at_once, count % at_once, false)) return false;
    int done = 0;
    for (; done + at_once <= count; done += at_once) sweeps_run_blocks_avx2(sweeps, &sweeps->whole);
    if (done < count) sweeps_run_blocks_avx2(sweeps, &sweeps->rest);
    return true;
}

bool sweeps_run(Sweeps *sweeps, int count) { return sweeps->pair_count == 0 || run(sweeps, NULL, count); }

/* Both halves are equal: before the first sweep there is no change to extrapolate. */
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

/* The bodies of the last sweep's half become the first half; the sums stay in place. */
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
        if (sweep_pair_points(pair) == 2) impulses[1] = pair->sums[1];
    }
    return finite;
}
