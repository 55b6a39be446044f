/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sequential sweeps over contacts, fast, and with the bits of the plain text (sequential_impulses.c).

   Contacts that share no moving body commute exactly. So a sweep need not visit them one by one: sweeps_schedule.c
   sorts the visits of several sweeps into levels, each of visits that do not depend on each other, and a level is
   solved in the lanes of a vector, one pair of bodies a lane (sweeps_lanes.h). Few contacts, or a processor without
   such vectors: one after the other, from the same packed records. Visits come in the order of the problem's contacts,
   which is the engine's, or by colours (colours.h): fewer levels, other bits.

   Exact as long as all numbers are finite; sweeps_end tells where they are not. */
#pragma once
#include "dynamics/contact_problem.h"
#include "sweeps/block.h"
#include "sweeps/colours.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SWEEPS_MAX = 1000000 }; /* that any method may be asked for */

/* How to sweep; all that the processor has, as sweeps_can says. */
typedef enum SweepKernel { SWEEP_ONE_BY_ONE, SWEEP_AVX2, SWEEP_KERNELS } SweepKernel;

bool sweeps_can(SweepKernel kernel);

/* The fastest that the processor has. */
SweepKernel sweeps_best_kernel(void);

/* A body's row: one vector register of four. */
typedef struct SweepBody {
    float x, y, spin; /* velocity, m/s and rad/s */
    float inv_mass;   /* 1/kg */
} SweepBody;

/* One contact point of a pair, as ContactPoint has it. */
typedef struct SweepPoint {
    Vec2 arm_a, arm_b;
    float mass_normal, mass_tangent, bias;
    float extra; /* point 0: inverse inertia of b; point 1: -1 where there is such a point, 0 where not */
} SweepPoint;

/* Two points at most that the same bodies have in common: rows of four for the lanes. */
typedef struct SweepPair {
    ContactImpulse sums[2];
    Vec2 normal;
    float friction, inv_inertia_a;
    SweepPoint points[2];
    Block block; /* only where blocks are solved */
} SweepPair;

enum {
    LEVEL_WIDTH = 16,
    PAIR_FLOATS = sizeof(SweepPair) / sizeof(float),
    SUMS_FLOATS = 2 * sizeof(ContactImpulse) / sizeof(float),
    BODY_FLOATS = sizeof(SweepBody) / sizeof(float)
};

/* Visits that commute: where their records begin, in floats. Slots without a visit have the spare body and pair,
   which are all zeros. */
typedef struct SweepLevel {
    int32_t pair[LEVEL_WIDTH], a[LEVEL_WIDTH], b[LEVEL_WIDTH];
} SweepLevel;

/* With extrapolation: where the sums of a visit are after the sweep before, where those of this sweep go (until then
   the sums of two sweeps before are there), both in floats, and the sweep's number in the schedule. */
typedef struct SweepTurns {
    int32_t from[LEVEL_WIDTH], to[LEVEL_WIDTH], sweep[LEVEL_WIDTH];
} SweepTurns;

/* The same for a body, before the levels from `level` on. */
typedef struct SweepBodyTurn {
    int32_t from, to, sweep, level;
} SweepBodyTurn;

/* The levels of `sweeps` sweeps. */
typedef struct SweepSchedule {
    int sweeps, level_count;
    SweepLevel *levels;
    int32_t *filled; /* [level_count] visits in each */
    int32_t *open;   /* [level_count] a level at or after this one that may still have room */
    size_t level_capacity, filled_capacity, open_capacity;
    /* Only with extrapolation: */
    SweepTurns *turns;         /* [level_count] */
    SweepBodyTurn *body_turns; /* [body_turn_count] by level */
    SweepBodyTurn *unsorted;   /* [body_turn_count] while scheduling */
    int32_t *turns_end;        /* [level_count + 1] the end of each level's body_turns */
    int body_turn_count;
    size_t turn_capacity, body_turn_capacity, unsorted_capacity, turns_end_capacity;
} SweepSchedule;

/* The two bodies of a pair. One that no impulse moves is there as ~index: many may visit it at once. */
typedef struct SweepEnds {
    int32_t a, b;
} SweepEnds;

/* The body of an end, whether it moves or not. */
static inline int32_t sweep_body_at(int32_t end) { return end < 0 ? ~end : end; }

/* Zero-initialise; arrays grow and are reused. */
typedef struct Sweeps {
    SweepKernel kernel;
    int body_count, pair_count;
    SweepBody *bodies;    /* [2, body_count + 1]; the second half is for extrapolation only */
    SweepPair *pairs;     /* [pair_count + 1] in the order of visits */
    int32_t *first;       /* [pair_count] the problem's contact that each begins with */
    SweepEnds *ends;      /* [pair_count] */
    SweepEnds *scheduled; /* [scheduled_count] the ends that the schedules are made for */
    int scheduled_count, scheduled_bodies;
    bool scheduled_turns; /* are they made for extrapolation? */
    bool coloured;        /* are the pairs in the order of colours? */
    Colours colours;
    ContactImpulse *sums; /* [2, pair_count + 1, 2] with extrapolation: of this sweep and the one before, in turns */
    SweepSchedule whole, rest; /* of as many sweeps as fit, run again and again, and of those left over */
    bool *moves;               /* [body_count] can an impulse change the body's velocity? */
    int64_t *quiet_since; /* [pair_count] one by one: number of the visit since which nothing changes; 0: of none */
    int64_t *changed_at;  /* [body_count] one by one: number of the visit that last changed the body */
    int32_t *ready;       /* [body_count] while scheduling: the first level that may visit the body */
    int32_t *seen;        /* [body_count] while scheduling with extrapolation: sweeps that have met the body */
    size_t sums_capacity, seen_capacity, quiet_capacity, changed_capacity;
    size_t body_capacity, pair_capacity, ends_capacity, scheduled_capacity, moves_capacity, ready_capacity;
    size_t first_capacity;
} Sweeps;

void sweeps_free(Sweeps *sweeps);

/* Takes a problem in and applies its warm start. Effective masses are multiplied by `relaxation` (1: as they are).
   False when memory is short. */
bool sweeps_begin(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem, bool warm, float relaxation);

/* The same, but for visits in the order of colours (colours.h): sooner done, and other bits. Warm, not relaxed. */
bool sweeps_begin_coloured(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem);

/* Sweeps `count` times over all contacts. False when memory is short. */
bool sweeps_run(Sweeps *sweeps, int count);

/* The same with an extrapolation before each sweep but the first, bit by bit the plain text of momentum.c: velocities
   and sums go on by factors[sweep] (>= 0) times what the sweep before changed, extrapolation included. */
bool sweeps_run_momentum(Sweeps *sweeps, const float *factors, int count);

/* Goes on where sweeps_run_momentum, or this, has ended, as if that had been one run: factors[0] counts here. Both counts
   are even. */
bool sweeps_continue_momentum(Sweeps *sweeps, const float *factors, int count);

/* The same for sweeps over blocks, bit by bit the plain text of block.c. Only where the processor can sweep by lanes. */
bool sweeps_begin_blocks(Sweeps *sweeps, const ContactProblem *problem);
bool sweeps_run_blocks(Sweeps *sweeps, int count);

/* Applies further impulses [contact_count] and adds them to the sums. */
void sweeps_push(Sweeps *sweeps, const ContactImpulse *impulses);

static inline int sweep_pair_points(const SweepPair *pair) { return pair->points[1].extra < 0.0f ? 2 : 1; }

/* Hands out what was found. False where a velocity is not finite: then the order of visits may have mattered. */
bool sweeps_end(const Sweeps *sweeps, ContactSolution *solution);
