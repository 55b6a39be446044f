/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Vectorised sweeps over contacts, with the bits of the scalar reference implementation (sequential_impulses.c).

   Contacts that share no moving body commute exactly. sweeps_schedule.c sorts the visits of several sweeps into levels
   of independent visits, and a level is solved in the lanes of a vector, one pair of bodies per lane (sweeps_lanes.h).
   For few contacts, or on a processor without such vectors, visits run one by one on the same packed records. Visits
   follow the order of the problem's contacts, which is the engine's, or colours (colours.h): fewer levels, other bits.

   Exact as long as all numbers are finite; sweeps_end() returns false otherwise. */
#pragma once
#include "dynamics/contact_problem.h"
#include "sweeps/block.h"
#include "sweeps/colours.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SWEEPS_MAX = 1000000 }; /* of one step, for any method */

/* The kernels; sweeps_can() tells which ones the processor supports. */
typedef enum SweepKernel { SWEEP_ONE_BY_ONE, SWEEP_AVX2, SWEEP_KERNELS } SweepKernel;

bool sweeps_can(SweepKernel kernel);

/* The fastest kernel that the processor supports. */
SweepKernel sweeps_best_kernel(void);

/* A body's row: one vector register of four. */
typedef struct SweepBody {
    float x, y, spin; /* velocity, m/s and rad/s */
    float inv_mass;   /* 1/kg */
} SweepBody;

/* One contact point of a pair, as in ContactPoint. */
typedef struct SweepPoint {
    Vec2 arm_a, arm_b;
    float mass_normal, mass_tangent, bias;
    float extra; /* point 0: inverse inertia of b; point 1: -1 if the pair has a second point, else 0 */
} SweepPoint;

/* One or two contact points of the same two bodies, in rows of four for the lanes. */
typedef struct SweepPair {
    ContactImpulse sums[2];
    Vec2 normal;
    float friction, inv_inertia_a;
    SweepPoint points[2];
    Block block; /* only for the block solver */
} SweepPair;

enum {
    LEVEL_WIDTH = 16,
    PAIR_FLOATS = sizeof(SweepPair) / sizeof(float),
    SUMS_FLOATS = 2 * sizeof(ContactImpulse) / sizeof(float),
    BODY_FLOATS = sizeof(SweepBody) / sizeof(float)
};

/* Visits that commute: the offsets of their records, in floats. Slots without a visit have the spare body and pair,
   which are all zeros. */
typedef struct SweepLevel {
    int32_t pair[LEVEL_WIDTH], a[LEVEL_WIDTH], b[LEVEL_WIDTH];
} SweepLevel;

/* With momentum extrapolation: the offsets, in floats, of a visit's sums after the previous sweep and of those of this
   sweep (which overwrite the sums of two sweeps ago), and the sweep's number in the schedule. */
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
    int32_t *filled; /* [level_count] number of visits */
    int32_t *open;   /* [level_count] a level, at or after this one, that may have room */
    size_t level_capacity, filled_capacity, open_capacity;
    /* Only with momentum extrapolation: */
    SweepTurns *turns;         /* [level_count] */
    SweepBodyTurn *body_turns; /* [body_turn_count] by level */
    SweepBodyTurn *unsorted;   /* [body_turn_count] while scheduling */
    int32_t *turns_end;        /* [level_count + 1] the end of each level's body_turns */
    int body_turn_count;
    size_t turn_capacity, body_turn_capacity, unsorted_capacity, turns_end_capacity;
} SweepSchedule;

/* The two bodies of a pair. A body that no impulse moves is stored as ~index: its visits commute. */
typedef struct SweepEnds {
    int32_t a, b;
} SweepEnds;

/* The body's index, whether it moves or not. */
static inline int32_t sweep_body_at(int32_t end) { return end < 0 ? ~end : end; }

/* Zero-initialise; arrays grow and are reused. */
typedef struct Sweeps {
    SweepKernel kernel;
    int body_count, pair_count;
    int block;            /* the caller's: more runs of this many sweeps may follow a run, so schedules are made for
                             them, too; 0: none. No bit depends on it. */
    SweepBody *bodies;    /* [2, body_count + 1]; the second half only with momentum extrapolation */
    SweepPair *pairs;     /* [pair_count + 1] in the order of visits */
    int32_t *first;       /* [pair_count] the first contact of each pair in the problem */
    SweepEnds *ends;      /* [pair_count] */
    SweepEnds *scheduled; /* [scheduled_count] the ends that the schedules are for */
    int scheduled_count, scheduled_bodies;
    bool scheduled_turns; /* they are for momentum extrapolation */
    bool coloured;        /* the pairs are in the order of colours */
    Colours colours;
    ContactImpulse
        *sums; /* [2, pair_count + 1, 2] with momentum extrapolation: of this sweep and the previous one, alternating */
    SweepSchedule whole, rest; /* of as many sweeps as fit, run repeatedly, and of the remaining sweeps */
    bool *moves;               /* [body_count] an impulse can change the body's velocity */
    int64_t *quiet_since;      /* [pair_count] one by one: the visit since which the pair is unchanged; 0: none */
    int64_t *changed_at;       /* [body_count] one by one: number of the visit that last changed the body */
    int32_t *ready;            /* [body_count] while scheduling: the first level that may visit the body */
    int32_t *seen; /* [body_count] while scheduling with momentum extrapolation: sweeps that have visited the body */
    size_t sums_capacity, seen_capacity, quiet_capacity, changed_capacity;
    size_t body_capacity, pair_capacity, ends_capacity, scheduled_capacity, moves_capacity, ready_capacity;
    size_t first_capacity;
} Sweeps;

void sweeps_free(Sweeps *sweeps);

/* Loads a problem and applies its warm start. Effective masses are multiplied by `relaxation` (1: unchanged). False
   when memory is short. */
bool sweeps_begin(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem, bool warm, float relaxation);

/* The same with visits in the order of colours (colours.h): faster, with other bits. With warm start, without
   relaxation. */
bool sweeps_begin_coloured(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem);

/* `count` sweeps over all contacts. False when memory is short. */
bool sweeps_run(Sweeps *sweeps, int count);

/* The same with momentum extrapolation before each sweep but the first, with the bits of the scalar reference
   implementation in momentum.c: velocities and sums advance by factors[sweep] (>= 0) times the change by the previous
   sweep, including its extrapolation. */
bool sweeps_run_momentum(Sweeps *sweeps, const float *factors, int count);

/* Continues after sweeps_run_momentum() or itself, as if in one run: here factors[0] counts. Both counts are even. */
bool sweeps_continue_momentum(Sweeps *sweeps, const float *factors, int count);

/* The same for the block solver, with the bits of block.c. Only for processors with lanes. */
bool sweeps_begin_blocks(Sweeps *sweeps, const ContactProblem *problem);
bool sweeps_run_blocks(Sweeps *sweeps, int count);

/* Applies additional impulses [contact_count] and adds them to the sums. */
void sweeps_push(Sweeps *sweeps, const ContactImpulse *impulses);

static inline int sweep_pair_points(const SweepPair *pair) { return pair->points[1].extra < 0.0f ? 2 : 1; }

/* Stores velocities and impulses. False if a velocity is NaN or infinite: then the bits may depend on the order of
   visits. */
bool sweeps_end(const Sweeps *sweeps, ContactSolution *solution);
