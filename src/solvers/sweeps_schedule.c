/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A list schedule: visit by visit in the order of the sweeps, each into the first level that comes after all that
   it depends on and has a slot left. Visits of different sweeps share levels: a pair may be visited again as soon
   as its own bodies allow. */
#include "common/array.h"
#include "solvers/sweeps_kernels.h"

#include <string.h>

/* Appends an empty level. */
static bool add_level(SweepSchedule *schedule, const Sweeps *sweeps) {
    size_t wanted = (size_t)schedule->level_count + 1;
    if (!array_reserve((void **)&schedule->levels, &schedule->level_capacity, wanted, sizeof *schedule->levels) ||
        !array_reserve((void **)&schedule->filled, &schedule->filled_capacity, wanted, sizeof *schedule->filled) ||
        !array_reserve((void **)&schedule->open, &schedule->open_capacity, wanted, sizeof *schedule->open))
        return false;
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

/* The first level from this one on that has room; paths are halved on the way, so that full levels are passed
   over quickly. */
static int32_t find_open(SweepSchedule *schedule, int32_t level) {
    int32_t *open = schedule->open;
    while (level < schedule->level_count && open[level] != level) {
        if (open[level] < schedule->level_count) open[level] = open[open[level]];
        level = open[level];
    }
    return level;
}

/* Puts one visit into its level, and returns the level after it; -1 when memory is short. */
static int32_t place(SweepSchedule *schedule, const Sweeps *sweeps, int32_t pair, int32_t a, int32_t b,
                     int32_t earliest) {
    int32_t level = find_open(schedule, earliest);
    if (level == schedule->level_count && !add_level(schedule, sweeps)) return -1;
    int32_t slot = schedule->filled[level]++;
    schedule->levels[level].pair[slot] = pair * PAIR_FLOATS;
    schedule->levels[level].a[slot] = a * BODY_FLOATS;
    schedule->levels[level].b[slot] = b * BODY_FLOATS;
    if (slot == LEVEL_WIDTH - 1) schedule->open[level] = level + 1;
    return level + 1;
}

bool sweeps_schedule(SweepSchedule *schedule, Sweeps *sweeps, int count) {
    schedule->sweeps = count;
    schedule->level_count = 0;
    int32_t *ready = sweeps->ready;
    memset(ready, 0, (size_t)sweeps->body_count * sizeof *ready);
    for (int sweep = 0; sweep < count; sweep++) {
        for (int32_t i = 0; i < sweeps->pair_count; i++) {
            SweepEnds ends = sweeps->ends[i];
            bool moves_a = ends.a >= 0, moves_b = ends.b >= 0;
            int32_t a = moves_a ? ends.a : ~ends.a, b = moves_b ? ends.b : ~ends.b;
            int32_t earliest = moves_a ? ready[a] : 0;
            if (moves_b && ready[b] > earliest) earliest = ready[b];
            int32_t next = place(schedule, sweeps, i, a, b, earliest);
            if (next < 0) return false;
            if (moves_a) ready[a] = next;
            if (moves_b) ready[b] = next;
        }
    }
    return true;
}
