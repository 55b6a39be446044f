/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sweeps over many contacts at once: their schedule, the runs, and how a contact problem is packed for them.

   List scheduling assigns visits, in the order of the sweeps, to the first level that comes after all their
   dependencies and has a free slot. Visits of different sweeps share levels. */
#include "methods/sweeps.h"

#include "base/base.h"
#include "engine/engine.h"
#include "methods/islands.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* The first level from this one on that has room. Path halving, as in union-find, skips full levels quickly. */
static int32_t find_open(SweepSchedule *schedule, int32_t level) {
    int32_t *open = schedule->open;
    while (level < schedule->level_count && open[level] != level) {
        if (open[level] < schedule->level_count) open[level] = open[open[level]];
        level = open[level];
    }
    return level;
}

/* Assigns one visit to *level and returns its slot. False when memory is short. */
static bool sweeps_place(SweepSchedule *schedule, const Sweeps *sweeps, int32_t pair, int32_t a, int32_t b, bool turns,
                         int32_t *level, int32_t *slot) {
    *level = find_open(schedule, *level);
    if (*level == schedule->level_count && !add_level(schedule, sweeps, turns)) return false;
    *slot = schedule->filled[*level]++;
    schedule->levels[*level].pair[*slot] = pair * PAIR_FLOATS;
    schedule->levels[*level].a[*slot] = a * BODY_FLOATS;
    schedule->levels[*level].b[*slot] = b * BODY_FLOATS;
    if (*slot == LEVEL_WIDTH - 1) schedule->open[*level] = *level + 1;
    return true;
}

/* Even sweeps use the first half of the bodies and sums, odd ones the second. */
static void place_turns(SweepSchedule *schedule, const Sweeps *sweeps, int32_t pair, int32_t sweep, int32_t level,
                        int32_t slot) {
    int32_t half = (sweeps->pair_count + 1) * SUMS_FLOATS, body_half = (sweeps->body_count + 1) * BODY_FLOATS;
    SweepTurns *turns = &schedule->turns[level];
    turns->from[slot] = (1 - sweep % 2) * half + pair * SUMS_FLOATS;
    turns->to[slot] = sweep % 2 * half + pair * SUMS_FLOATS;
    turns->factor[slot] = sweep * sweeps->groups + sweeps->group[pair];
    schedule->levels[level].a[slot] += sweep % 2 * body_half;
    schedule->levels[level].b[slot] += sweep % 2 * body_half;
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

/* Schedules one visit after all its dependencies. */
static bool add_visit(SweepSchedule *schedule, Sweeps *sweeps, int32_t pair, int32_t sweep, bool turns) {
    int32_t *ready = sweeps->ready;
    SweepEnds ends = sweeps->ends[pair];
    bool moves_a = ends.a >= 0, moves_b = ends.b >= 0;
    int32_t a = moves_a ? ends.a : ~ends.a, b = moves_b ? ends.b : ~ends.b;
    const int32_t group = sweeps->group[pair];
    if (turns && ((moves_a && !add_body_turn(schedule, sweeps, a, group, sweep)) ||
                  (moves_b && !add_body_turn(schedule, sweeps, b, group, sweep))))
        return false;
    int32_t level = moves_a ? ready[a] : 0, slot;
    if (moves_b && ready[b] > level) level = ready[b];
    if (!sweeps_place(schedule, sweeps, pair, a, b, turns, &level, &slot)) return false;
    if (turns) place_turns(schedule, sweeps, pair, sweep, level, slot);
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
    VISITS_AT_ONCE = 1 << 12, /* visits in one schedule, which should stay in the cache */
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

/* The number of sweeps in one schedule: an equal part of all sweeps, if possible. With momentum extrapolation an even
   number if the schedule is run more than once: each run begins in the same half of the bodies and sums. */
static int sweeps_of_schedule(const Sweeps *sweeps, int count, bool turns) {
    const int limit = sweeps->coloured ? COLOURED_AT_ONCE : SWEEPS_AT_ONCE;
    int most = VISITS_AT_ONCE / sweeps->pair_count;
    if (most > limit) most = limit;
    if (most < 1) most = 1;
    if (sweeps->block > 0) count = sweeps->block;
    if (count <= most) return count;
    int equal = count / ((count + most - 1) / most);
    return turns ? equal + equal % 2 : equal;
}

/* By lanes if the processor has them and enough visits share a level. False when memory is short. */
static bool sweeps_run_schedule(Sweeps *sweeps, const float *factors, int count) {
    bool turns = factors != NULL;
    int at_once = sweeps_of_schedule(sweeps, count, turns);
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

/* Both halves are equal: before the first sweep there is no change to extrapolate. */
static void begin_turns(Sweeps *sweeps) {
    size_t half = (size_t)sweeps->pair_count + 1, bodies = (size_t)sweeps->body_count + 1;
    memcpy(sweeps->bodies + bodies, sweeps->bodies, bodies * sizeof *sweeps->bodies);
    for (size_t i = 0; i < half; i++) memcpy(sweeps->sums + 2 * i, sweeps->pairs[i].sums, sizeof sweeps->pairs[i].sums);
    memcpy(sweeps->sums + 2 * half, sweeps->sums, 2 * half * sizeof *sweeps->sums);
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
    begin_turns(sweeps);
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

/* Whether an island goes on through the pair's body a or b: unlike in `ends`, not through one that does not move. */
static bool connects_a(const Sweeps *sweeps, int i) {
    return sweeps->bodies[sweep_body_at(sweeps->ends[i].a)].inv_mass > 0 || sweeps->pairs[i].inv_inertia_a > 0;
}

static bool connects_b(const Sweeps *sweeps, int i) {
    return sweeps->bodies[sweep_body_at(sweeps->ends[i].b)].inv_mass > 0 || sweeps->pairs[i].points[0].extra > 0;
}

void sweeps_group(Sweeps *sweeps) {
    int32_t *parent = sweeps->ready, *number = sweeps->seen; /* of the next schedule */
    for (int32_t i = 0; i < sweeps->body_count; i++) parent[i] = i, number[i] = -1;
    for (int i = 0; i < sweeps->pair_count; i++) {
        const int32_t a = sweep_body_at(sweeps->ends[i].a), b = sweep_body_at(sweeps->ends[i].b);
        if (connects_a(sweeps, i) && connects_b(sweeps, i)) parent[islands_root(parent, b)] = islands_root(parent, a);
    }
    sweeps->groups = 0;
    for (int i = 0; i < sweeps->pair_count; i++) {
        const int32_t a = sweep_body_at(sweeps->ends[i].a), b = sweep_body_at(sweeps->ends[i].b);
        int32_t *group = &number[islands_root(parent, connects_b(sweeps, i) ? b : a)];
        if (*group < 0) *group = sweeps->groups++;
        sweeps->group[i] = sweeps->group_of_body[a] = sweeps->group_of_body[b] = *group;
    }
}

static void keep_all(Sweeps *sweeps) {
    memcpy(sweeps->kept_bodies, sweeps->bodies, (size_t)sweeps->body_count * sizeof *sweeps->bodies);
    for (int i = 0; i < sweeps->pair_count; i++)
        memcpy(&sweeps->kept_sums[2 * i], sweeps->pairs[i].sums, sizeof sweeps->pairs[i].sums);
}

void sweeps_keep(Sweeps *sweeps, const bool *chosen) {
    bool all = true;
    for (int k = 0; k < sweeps->groups; k++) all &= chosen[k];
    if (all) {
        keep_all(sweeps);
        return;
    }
    for (int i = 0; i < sweeps->pair_count; i++) {
        if (!chosen[sweeps->group[i]]) continue;
        const int32_t a = sweep_body_at(sweeps->ends[i].a), b = sweep_body_at(sweeps->ends[i].b);
        memcpy(&sweeps->kept_sums[2 * i], sweeps->pairs[i].sums, sizeof sweeps->pairs[i].sums);
        sweeps->kept_bodies[a] = sweeps->bodies[a], sweeps->kept_bodies[b] = sweeps->bodies[b];
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

/* True if an impulse can change the velocity. For a static body only if it is -0, which may become 0. */
static bool sweeps_moves(const ProblemBody *body) {
    return problem_body_moves(body) || is_negative_zero(body->velocity.x) || is_negative_zero(body->velocity.y) ||
           is_negative_zero(body->angular_velocity);
}

static void load_bodies(Sweeps *sweeps, const ContactProblem *problem) {
    sweeps->body_count = problem->body_count;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        sweeps->bodies[i] = (SweepBody){body->velocity.x, body->velocity.y, body->angular_velocity, body->inv_mass};
        sweeps->moves[i] = sweeps_moves(body);
        sweeps->group_of_body[i] = 0;
    }
    sweeps->bodies[problem->body_count] = (SweepBody){0};
}

/* If neither moves, a counts as moving: visits of one pair must not share a level. */
static SweepEnds ends_of(const Sweeps *sweeps, int a, int b) {
    bool moves_a = sweeps->moves[a] || !sweeps->moves[b];
    return (SweepEnds){moves_a ? a : ~a, sweeps->moves[b] ? b : ~b};
}

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
    sweeps->ends[sweeps->pair_count++] = ends_of(sweeps, contact->a, contact->b);
    return points;
}

/* visits: the order of contacts, with those of a pair adjacent; NULL for the problem's order. */
static void load_pairs(Sweeps *sweeps, const ContactProblem *problem, const int32_t *visits, bool warm) {
    sweeps->pair_count = 0;
    for (int i = 0; i < problem->contact_count;) i += load_pair(sweeps, problem, visits != NULL ? visits[i] : i, warm);
    sweeps->pairs[sweeps->pair_count] = (SweepPair){0};
}

static bool begin_sweeps(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem, const int32_t *visits,
                         bool warm) {
    if (!sweeps_reserve(sweeps, problem)) return false;
    sweeps->kernel = kernel;
    sweeps->coloured = visits != NULL;
    sweeps->groups = 1;
    load_bodies(sweeps, problem);
    load_pairs(sweeps, problem, visits, warm);
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
