/* SPDX-License-Identifier: GPL-3.0-or-later */
/* List scheduling: assigns visits, in the order of the sweeps, to the first level that comes after all their
   dependencies and has a free slot. Visits of different sweeps share levels. */
#include "common/array.h"
#include "sweeps/sweeps_kernels.h"

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
            slots->sweep[i] = 0;
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
static bool place(SweepSchedule *schedule, const Sweeps *sweeps, int32_t pair, int32_t a, int32_t b, bool turns,
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
    turns->sweep[slot] = sweep;
    schedule->levels[level].a[slot] += sweep % 2 * body_half;
    schedule->levels[level].b[slot] += sweep % 2 * body_half;
}

/* A body is extrapolated at its first visit in a sweep, when the previous sweep no longer changes it. */
static bool add_body_turn(SweepSchedule *schedule, Sweeps *sweeps, int32_t body, int32_t sweep) {
    if (sweeps->seen[body] > sweep) return true;
    sweeps->seen[body] = sweep + 1;
    size_t wanted = (size_t)schedule->body_turn_count + 1;
    if (!array_reserve((void **)&schedule->unsorted, &schedule->unsorted_capacity, wanted, sizeof *schedule->unsorted))
        return false;
    int32_t half = (sweeps->body_count + 1) * BODY_FLOATS, at = body * BODY_FLOATS;
    schedule->unsorted[schedule->body_turn_count++] = (SweepBodyTurn){
        .from = (1 - sweep % 2) * half + at, .to = sweep % 2 * half + at, .sweep = sweep, .level = sweeps->ready[body]};
    return true;
}

/* Counting sort of the bodies' turns by level. */
static bool sort_body_turns(SweepSchedule *schedule) {
    size_t count = (size_t)schedule->body_turn_count, levels = (size_t)schedule->level_count;
    if (!array_reserve((void **)&schedule->body_turns, &schedule->body_turn_capacity, count,
                       sizeof *schedule->body_turns) ||
        !array_reserve((void **)&schedule->turns_end, &schedule->turns_end_capacity, levels + 1,
                       sizeof *schedule->turns_end))
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
    if (turns && ((moves_a && !add_body_turn(schedule, sweeps, a, sweep)) ||
                  (moves_b && !add_body_turn(schedule, sweeps, b, sweep))))
        return false;
    int32_t level = moves_a ? ready[a] : 0, slot;
    if (moves_b && ready[b] > level) level = ready[b];
    if (!place(schedule, sweeps, pair, a, b, turns, &level, &slot)) return false;
    if (turns) place_turns(schedule, sweeps, pair, sweep, level, slot);
    if (moves_a) ready[a] = level + 1;
    if (moves_b) ready[b] = level + 1;
    return true;
}

bool sweeps_schedule(SweepSchedule *schedule, Sweeps *sweeps, int count, bool turns) {
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
