/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sweeps over many contacts at once: their schedule, the runs, and how a contact problem is packed for them.

   List scheduling assigns visits, in the order of the sweeps, to the first level that comes after all their
   dependencies and has a free slot. Visits of different sweeps share levels.

   The order of visits is the problem's, or that of colours. */
#include "methods/sweeps.h"

#include "base/base.h"
#include "engine/engine.h"
#include "methods/islands.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void colours_free(Colours *colours) {
    free(colours->arrays.memory);
    *colours = (Colours){0};
}

bool colours_order(Colours *colours, const ContactProblem *problem) {
    const size_t contacts = (size_t)problem->contact_count, bodies = (size_t)problem->body_count;
    int begin[COLOURS + 1] = {0}, pairs = 0, used = 0;
    if (!ARRAY_BLOCK_RESERVE(&colours->arrays, ARRAY_PART(colours->visits, contacts),
                             ARRAY_PART(colours->pairs, contacts + 1), ARRAY_PART(colours->colour, contacts),
                             ARRAY_PART(colours->taken, bodies)))
        return false;
    memset(colours->taken, 0, bodies * sizeof *colours->taken);
    for (int i = 0; i < problem->contact_count; i += contact_surface_points(problem, i)) colours->pairs[pairs++] = i;
    colours->pairs[pairs] = problem->contact_count;
    /* Each pair takes the lowest colour that neither of its moving bodies has yet. If all are taken: the last one,
       whose visits do not commute and keep their order. */
    for (int i = pairs - 1; i >= 0; i--) {
        const ContactPoint *contact = &problem->contacts[colours->pairs[i]];
        uint64_t *a = &colours->taken[contact->a], *b = &colours->taken[contact->b];
        const uint64_t open = ~(*a | *b);
        const int colour = open != 0 ? __builtin_ctzll(open) : COLOURS - 1;
        *a |= (uint64_t)problem_body_moves(&problem->bodies[contact->a]) << colour;
        *b |= (uint64_t)problem_body_moves(&problem->bodies[contact->b]) << colour;
        colours->colour[i] = (uint8_t)colour;
        used = colour < used ? used : colour + 1;
        begin[colour + 1] += colours->pairs[i + 1] - colours->pairs[i];
    }
    /* Counting sort by colour. */
    for (int i = 0; i < used; i++) begin[i + 1] += begin[i];
    for (int i = 0; i < pairs; i++) {
        int32_t *visit = &colours->visits[begin[colours->colour[i]]];
        begin[colours->colour[i]] += colours->pairs[i + 1] - colours->pairs[i];
        for (int first = colours->pairs[i]; first < colours->pairs[i + 1]; first++) *visit++ = first;
    }
    return true;
}

/* Appends an empty level. */
static bool add_level(SweepSchedule *schedule, const Sweeps *sweeps, bool turns) {
    size_t wanted = (size_t)schedule->level_count + 1;
    if (!array_reserve((void **)&schedule->levels, &schedule->level_capacity, wanted, sizeof *schedule->levels) ||
        !array_reserve((void **)&schedule->filled, &schedule->filled_capacity, wanted, sizeof *schedule->filled) ||
        !array_reserve((void **)&schedule->open, &schedule->open_capacity, wanted, sizeof *schedule->open))
        return false;
    if (turns) {
        if (!array_reserve((void **)&schedule->turns, &schedule->turn_capacity, wanted, sizeof *schedule->turns))
            return false;
        SweepTurns *slots = &schedule->turns[schedule->level_count];
        for (int i = 0; i < LEVEL_WIDTH; i++) {
            slots->from[i] = slots->to[i] = sweeps->pair_count * SUMS_FLOATS;
            slots->factor[i] = 0;
        }
    }
    SweepLevel *level = &schedule->levels[schedule->level_count];
    for (int i = 0; i < LEVEL_WIDTH; i++) {
        level->pair[i] = sweeps->pair_count * PAIR_FLOATS;
        level->a[i] = level->b[i] = sweeps->body_count * BODY_FLOATS;
    }
    schedule->filled[schedule->level_count] = 0;
    schedule->open[schedule->level_count] = schedule->level_count;
    schedule->level_count++;
    return true;
}

/* A body is extrapolated at its first visit in a sweep, when the previous sweep no longer changes it. */
static bool add_body_turn(SweepSchedule *schedule, Sweeps *sweeps, int32_t body, int32_t group, int32_t sweep) {
    if (sweeps->seen[body] > sweep) return true;
    sweeps->seen[body] = sweep + 1;
    size_t wanted = (size_t)schedule->body_turn_count + 1;
    if (!array_reserve((void **)&schedule->unsorted, &schedule->unsorted_capacity, wanted, sizeof *schedule->unsorted))
        return false;
    int32_t half = (sweeps->body_count + 1) * BODY_FLOATS, at = body * BODY_FLOATS;
    schedule->unsorted[schedule->body_turn_count++] = (SweepBodyTurn){.from = (1 - sweep % 2) * half + at,
                                                                      .to = sweep % 2 * half + at,
                                                                      .factor = sweep * sweeps->groups + group,
                                                                      .level = sweeps->ready[body]};
    return true;
}

/* Counting sort of the bodies' turns by level. */
static bool sort_body_turns(SweepSchedule *schedule) {
    size_t count = (size_t)schedule->body_turn_count, levels = (size_t)schedule->level_count;
    if (!ARRAY_BLOCK_RESERVE(&schedule->sorted, ARRAY_PART(schedule->body_turns, count),
                             ARRAY_PART(schedule->turns_end, levels + 1)))
        return false;
    int32_t *end = schedule->turns_end;
    memset(end, 0, (levels + 1) * sizeof *end);
    for (size_t i = 0; i < count; i++) end[schedule->unsorted[i].level + 1]++;
    for (size_t i = 0; i < levels; i++) end[i + 1] += end[i];
    for (size_t i = 0; i < count; i++) schedule->body_turns[end[schedule->unsorted[i].level]++] = schedule->unsorted[i];
    return true;
}

/* Schedules one visit after all its dependencies, in the first level that has room. False when memory is short. */
static bool add_visit(SweepSchedule *schedule, Sweeps *sweeps, int32_t pair, int32_t sweep, bool turns) {
    int32_t *ready = sweeps->ready;
    const SweepEnds ends = sweeps->ends[pair];
    const bool moves_a = ends.a >= 0, moves_b = ends.b >= 0;
    const int32_t a = sweep_body_at(ends.a), b = sweep_body_at(ends.b), group = sweeps->group[pair];
    if (turns && ((moves_a && !add_body_turn(schedule, sweeps, a, group, sweep)) ||
                  (moves_b && !add_body_turn(schedule, sweeps, b, group, sweep))))
        return false;
    int32_t level = moves_a ? ready[a] : 0;
    if (moves_b && ready[b] > level) level = ready[b];
    /* Path halving, as in union-find, skips full levels quickly. */
    int32_t *open = schedule->open;
    while (level < schedule->level_count && open[level] != level) {
        if (open[level] < schedule->level_count) open[level] = open[open[level]];
        level = open[level];
    }
    if (level == schedule->level_count && !add_level(schedule, sweeps, turns)) return false;
    const int32_t slot = schedule->filled[level]++;
    SweepLevel *to = &schedule->levels[level];
    to->pair[slot] = pair * PAIR_FLOATS;
    to->a[slot] = a * BODY_FLOATS;
    to->b[slot] = b * BODY_FLOATS;
    if (slot == LEVEL_WIDTH - 1) schedule->open[level] = level + 1;
    if (turns) { /* even sweeps use the first half of the bodies and sums, odd ones the second */
        const int32_t half = (sweeps->pair_count + 1) * SUMS_FLOATS, odd = sweep % 2;
        SweepTurns *slots = &schedule->turns[level];
        slots->from[slot] = (1 - odd) * half + pair * SUMS_FLOATS;
        slots->to[slot] = odd * half + pair * SUMS_FLOATS;
        slots->factor[slot] = sweep * sweeps->groups + group;
        to->a[slot] += odd * (sweeps->body_count + 1) * BODY_FLOATS;
        to->b[slot] += odd * (sweeps->body_count + 1) * BODY_FLOATS;
    }
    if (moves_a) ready[a] = level + 1;
    if (moves_b) ready[b] = level + 1;
    return true;
}

/* Makes the schedule of that many sweeps over the pairs; turns: with momentum extrapolation. False when memory is
   short. */
static bool make_schedule(SweepSchedule *schedule, Sweeps *sweeps, int count, bool turns) {
    schedule->sweeps = count;
    schedule->level_count = 0;
    schedule->body_turn_count = 0;
    memset(sweeps->ready, 0, (size_t)sweeps->body_count * sizeof *sweeps->ready);
    if (turns) memset(sweeps->seen, 0, (size_t)sweeps->body_count * sizeof *sweeps->seen);
    for (int sweep = 0; sweep < count; sweep++)
        for (int32_t i = 0; i < sweeps->pair_count; i++)
            if (!add_visit(schedule, sweeps, i, sweep, turns)) return false;
    return !turns || sort_body_turns(schedule);
}

enum {
    COLOURED_AT_ONCE = 2,     /* sweeps in a coloured schedule: more would share few levels */
    VISITS_AT_ONCE = 1 << 11, /* visits in one schedule: twice as many take up to 1.08 times as long */
    LEVEL_PAYS = 3            /* visits per level from which on lanes are faster */
};

static void free_schedule(SweepSchedule *schedule) {
    free(schedule->levels);
    free(schedule->filled);
    free(schedule->open);
    free(schedule->turns);
    free(schedule->unsorted);
    free(schedule->sorted.memory);
}

void sweeps_free(Sweeps *sweeps) {
    free_schedule(&sweeps->whole);
    free_schedule(&sweeps->rest);
    free(sweeps->scheduled);
    free(sweeps->arrays.memory);
    colours_free(&sweeps->colours);
    *sweeps = (Sweeps){0};
}

bool sweeps_can(SweepKernel kernel) {
    return kernel == SWEEP_ONE_BY_ONE || (kernel == SWEEP_LANES && sweeps_have_lanes());
}

SweepKernel sweeps_best_kernel(void) { return sweeps_can(SWEEP_LANES) ? SWEEP_LANES : SWEEP_ONE_BY_ONE; }

/* Makes both schedules, unless those of the last step are for the same pairs. turns: with momentum extrapolation. */
static bool reschedule(Sweeps *sweeps, int at_once, int rest, bool turns) {
    size_t size = (size_t)sweeps->pair_count * sizeof *sweeps->ends;
    if (sweeps->scheduled_count == sweeps->pair_count && memcmp(sweeps->scheduled, sweeps->ends, size) == 0 &&
        sweeps->scheduled_bodies == sweeps->body_count && sweeps->whole.sweeps == at_once &&
        (rest == 0 || sweeps->rest.sweeps == rest) && sweeps->scheduled_turns == turns &&
        (!turns || sweeps->scheduled_groups == sweeps->groups))
        return true;
    sweeps->scheduled_count = 0;
    if (!make_schedule(&sweeps->whole, sweeps, at_once, turns) || !make_schedule(&sweeps->rest, sweeps, rest, turns))
        return false;
    memcpy(sweeps->scheduled, sweeps->ends, size);
    sweeps->scheduled_count = sweeps->pair_count;
    sweeps->scheduled_bodies = sweeps->body_count;
    sweeps->scheduled_turns = turns;
    sweeps->scheduled_groups = sweeps->groups;
    return true;
}

/* By lanes if the processor has them and enough visits share a level. False when memory is short. */
static bool sweeps_run_schedule(Sweeps *sweeps, const float *factors, int count) {
    const bool turns = factors != NULL;
    /* Sweeps in one schedule: an equal part of all, if possible. With momentum extrapolation an even number if the
       schedule is run more than once: each run begins in the same half of the bodies and sums. */
    const int limit = sweeps->coloured ? COLOURED_AT_ONCE : SWEEPS_AT_ONCE;
    int most = VISITS_AT_ONCE / sweeps->pair_count, at_once = sweeps->block > 0 ? sweeps->block : count;
    most = most > limit ? limit : most < 1 ? 1 : most;
    if (at_once > most) {
        at_once /= (at_once + most - 1) / most;
        if (turns) at_once += at_once % 2;
    }
    if (sweeps->kernel != SWEEP_ONE_BY_ONE && !reschedule(sweeps, at_once, count % at_once, turns)) return false;
    bool narrow = LEVEL_PAYS * sweeps->whole.level_count > at_once * sweeps->pair_count;
    if (sweeps->kernel == SWEEP_ONE_BY_ONE || narrow) {
        sweeps_run_one_by_one(sweeps, factors, count);
        return true;
    }
    int done = 0;
    for (; done + at_once <= count; done += at_once)
        sweeps_run_lanes(sweeps, &sweeps->whole, turns ? factors + done * sweeps->groups : NULL);
    if (done < count) sweeps_run_lanes(sweeps, &sweeps->rest, turns ? factors + done * sweeps->groups : NULL);
    return true;
}

bool sweeps_run(Sweeps *sweeps, int count) {
    return sweeps->pair_count == 0 || sweeps_run_schedule(sweeps, NULL, count);
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
    const size_t half = (size_t)sweeps->pair_count + 1, bodies = (size_t)sweeps->body_count + 1;
    if (sweeps->pair_count == 0 || count == 0) return true;
    /* Both halves are equal: before the first sweep there is no change to extrapolate. */
    memcpy(sweeps->bodies + bodies, sweeps->bodies, bodies * sizeof *sweeps->bodies);
    for (size_t i = 0; i < half; i++) memcpy(sweeps->sums + 2 * i, sweeps->pairs[i].sums, sizeof sweeps->pairs[i].sums);
    memcpy(sweeps->sums + 2 * half, sweeps->sums, 2 * half * sizeof *sweeps->sums);
    if (!sweeps_run_schedule(sweeps, factors, count)) return false;
    end_turns(sweeps, count);
    return true;
}

bool sweeps_continue_momentum(Sweeps *sweeps, const float *factors, int count) {
    if (sweeps->pair_count == 0) return true;
    swap_halves(sweeps);
    if (!sweeps_run_schedule(sweeps, factors, count)) return false;
    end_turns(sweeps, count);
    return true;
}

/* body += factor * by */
static void add_velocity(SweepBody *body, const SweepBody *by, float factor) {
    body->x += factor * by->x;
    body->y += factor * by->y;
    body->spin += factor * by->spin;
}

void sweeps_refresh(Sweeps *sweeps, const ContactProblem *problem, const bool *chosen) {
    SweepBody *previous = sweeps->bodies + sweeps->body_count + 1;
    for (int i = 0; i < sweeps->body_count; i++) {
        if (chosen != NULL && !chosen[sweeps->group_of_body[i]]) continue;
        const ProblemBody *body = &problem->bodies[i];
        add_velocity(&previous[i], &sweeps->bodies[i], -1);
        sweeps->bodies[i] = (SweepBody){body->velocity.x, body->velocity.y, body->angular_velocity, body->inv_mass};
    }
    sweeps_push_sums(sweeps, chosen);
    for (int i = 0; i < sweeps->body_count; i++)
        if (chosen == NULL || chosen[sweeps->group_of_body[i]]) add_velocity(&previous[i], &sweeps->bodies[i], 1);
}

void sweeps_group(Sweeps *sweeps) {
    int32_t *parent = sweeps->ready, *number = sweeps->seen; /* of the next schedule */
    for (int32_t i = 0; i < sweeps->body_count; i++) parent[i] = i, number[i] = -1;
    sweeps->groups = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < sweeps->pair_count; i++) {
            const SweepPair *pair = &sweeps->pairs[i];
            const int32_t a = sweep_body_at(sweeps->ends[i].a), b = sweep_body_at(sweeps->ends[i].b);
            /* Whether the island goes on through a body: unlike in `ends`, not through one that does not move. */
            const bool through_a = sweeps->bodies[a].inv_mass > 0 || pair->inv_inertia_a > 0,
                       through_b = sweeps->bodies[b].inv_mass > 0 || pair->points[0].extra > 0;
            if (pass == 0) {
                if (through_a && through_b) parent[islands_root(parent, b)] = islands_root(parent, a);
                continue;
            }
            int32_t *group = &number[islands_root(parent, through_b ? b : a)];
            if (*group < 0) *group = sweeps->groups++;
            sweeps->group[i] = sweeps->group_of_body[a] = sweeps->group_of_body[b] = *group;
        }
}

void sweeps_keep(Sweeps *sweeps, const bool *chosen) {
    bool all = true;
    for (int k = 0; k < sweeps->groups; k++) all &= chosen[k];
    if (all) memcpy(sweeps->kept_bodies, sweeps->bodies, (size_t)sweeps->body_count * sizeof *sweeps->bodies);
    for (int i = 0; i < sweeps->pair_count; i++) {
        if (!chosen[sweeps->group[i]]) continue;
        const int32_t a = sweep_body_at(sweeps->ends[i].a), b = sweep_body_at(sweeps->ends[i].b);
        memcpy(&sweeps->kept_sums[2 * i], sweeps->pairs[i].sums, sizeof sweeps->pairs[i].sums);
        if (!all) sweeps->kept_bodies[a] = sweeps->bodies[a], sweeps->kept_bodies[b] = sweeps->bodies[b];
    }
}

/* Both halves: a change of 0 has no NaN, whatever was found in between. */
static void return_body(Sweeps *sweeps, int32_t end) {
    if (end < 0) return;
    sweeps->bodies[end] = sweeps->bodies[sweeps->body_count + 1 + end] = sweeps->kept_bodies[end];
}

void sweeps_return(Sweeps *sweeps, const bool *chosen) {
    const size_t half = 2 * ((size_t)sweeps->pair_count + 1);
    for (int i = 0; i < sweeps->pair_count; i++) {
        if (!chosen[sweeps->group[i]]) continue;
        const ContactImpulse *kept = &sweeps->kept_sums[2 * i];
        memcpy(sweeps->pairs[i].sums, kept, sizeof sweeps->pairs[i].sums);
        memcpy(&sweeps->sums[2 * i], kept, sizeof sweeps->pairs[i].sums);
        memcpy(&sweeps->sums[half + 2 * (size_t)i], kept, sizeof sweeps->pairs[i].sums);
        return_body(sweeps, sweeps->ends[i].a);
        return_body(sweeps, sweeps->ends[i].b);
    }
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

/* Packs a contact problem into records of bodies, and of pairs in the order of visits. */

static bool sweeps_reserve(Sweeps *sweeps, const ContactProblem *problem) {
    const size_t bodies = (size_t)problem->body_count + 1, pairs = (size_t)problem->contact_count + 1;
    return ARRAY_BLOCK_RESERVE(&sweeps->arrays, ARRAY_PART(sweeps->bodies, 2 * bodies),
                               ARRAY_PART(sweeps->pairs, pairs), ARRAY_PART(sweeps->first, pairs),
                               ARRAY_PART(sweeps->ends, pairs), ARRAY_PART(sweeps->sums, 4 * pairs),
                               ARRAY_PART(sweeps->group, pairs), ARRAY_PART(sweeps->group_of_body, bodies),
                               ARRAY_PART(sweeps->kept_bodies, bodies), ARRAY_PART(sweeps->kept_sums, 2 * pairs),
                               ARRAY_PART(sweeps->moves, bodies), ARRAY_PART(sweeps->quiet_since, pairs),
                               ARRAY_PART(sweeps->changed_at, bodies), ARRAY_PART(sweeps->ready, bodies),
                               ARRAY_PART(sweeps->seen, bodies)) &&
           array_reserve((void **)&sweeps->scheduled, &sweeps->scheduled_capacity, pairs, sizeof *sweeps->scheduled);
}

static bool is_negative_zero(float x) { return x == 0.0f && signbit(x); }

/* Member by member, so that a record is written once and not copied. */
static void load_point(SweepPair *pair, int k, const ContactPoint *contact, float extra, bool warm) {
    SweepPoint *point = &pair->points[k];
    pair->sums[k].normal = warm ? contact->warm_normal : 0.0f;
    pair->sums[k].tangent = warm ? contact->warm_tangent : 0.0f;
    point->arm_a = contact->arm_a;
    point->arm_b = contact->arm_b;
    point->mass_normal = contact->mass_normal;
    point->mass_tangent = contact->mass_tangent;
    point->bias = contact->bias;
    point->extra = extra;
}

/* Packs the pair that begins with contact `first` of the problem; returns its number of points. */
static int load_pair(Sweeps *sweeps, const ContactProblem *problem, int first, bool warm) {
    static const ContactPoint none = {0};
    const ContactPoint *contact = &problem->contacts[first], *next = contact + 1;
    const int points = contact_surface_points(problem, first);
    SweepPair *pair = &sweeps->pairs[sweeps->pair_count];
    pair->normal = contact->normal;
    pair->friction = contact->friction;
    pair->inv_inertia_a = problem->bodies[contact->a].inv_inertia;
    load_point(pair, 0, contact, problem->bodies[contact->b].inv_inertia, warm);
    load_point(pair, 1, points == 2 ? next : &none, points == 2 ? -1.0f : 0.0f, warm);
    sweeps->first[sweeps->pair_count] = first;
    sweeps->group[sweeps->pair_count] = 0;
    /* If neither moves, a counts as moving: visits of one pair must not share a level. */
    const bool moves_b = sweeps->moves[contact->b], moves_a = sweeps->moves[contact->a] || !moves_b;
    sweeps->ends[sweeps->pair_count++] =
        (SweepEnds){moves_a ? contact->a : ~contact->a, moves_b ? contact->b : ~contact->b};
    return points;
}

/* visits: the order of contacts, with those of a pair adjacent; NULL for the problem's order. */
static bool begin_sweeps(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem, const int32_t *visits,
                         bool warm) {
    if (!sweeps_reserve(sweeps, problem)) return false;
    sweeps->kernel = kernel;
    sweeps->coloured = visits != NULL;
    sweeps->groups = 1;
    sweeps->body_count = problem->body_count;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        sweeps->bodies[i] = (SweepBody){body->velocity.x, body->velocity.y, body->angular_velocity, body->inv_mass};
        /* An impulse can change the velocity of a static body only if it is -0, which may become 0. */
        sweeps->moves[i] = problem_body_moves(body) || is_negative_zero(body->velocity.x) ||
                           is_negative_zero(body->velocity.y) || is_negative_zero(body->angular_velocity);
        sweeps->group_of_body[i] = 0;
    }
    sweeps->bodies[problem->body_count] = (SweepBody){0};
    sweeps->pair_count = 0;
    for (int i = 0; i < problem->contact_count;) i += load_pair(sweeps, problem, visits != NULL ? visits[i] : i, warm);
    sweeps->pairs[sweeps->pair_count] = (SweepPair){0};
    sweeps_push_sums(sweeps, NULL);
    return true;
}

bool sweeps_begin(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem, bool warm) {
    return begin_sweeps(sweeps, kernel, problem, NULL, warm);
}

bool sweeps_begin_coloured(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem) {
    return colours_order(&sweeps->colours, problem) &&
           begin_sweeps(sweeps, kernel, problem, sweeps->colours.visits, true);
}
