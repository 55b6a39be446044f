/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sweeps over contacts, fast: the order of visits, and many visits at once. */
#pragma once
#include "engine/engine.h"
#include "methods/impulses.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Graph colouring of the contacts: pairs of one colour share no moving body, so their visits commute. A sweep in this
   order has one level (sweeps.h) per colour, instead of one per body of the longest chain, and a schedule needs two
   sweeps only.

   Greedy, from the last pair to the first: each takes the lowest colour that neither of its moving bodies has yet.
   Bodies are numbered from the ground up and the bomb last, so the bomb's contacts are visited first. Source: Harada,
   "A Parallel Constraint Solver for a Rigid Body Simulation" (2011), which batches contacts this way for a GPU. Fails
   sooner than the engine's order, from the ground up, for a tall stack under a heavy load. The engine keeps its own
   order, for the bits of Box2D-Lite. */

enum { COLOURS = 64 };

/* Zero-initialise; arrays grow and are reused. */
typedef struct Colours {
    int32_t *visits; /* [contact_count] the contacts in the order of visits; the two of a pair stay adjacent */
    int32_t *pairs;  /* [pairs + 1] the first contact of each pair, and the end */
    uint8_t *colour; /* [pairs] */
    uint64_t *taken; /* [body_count] one bit per colour */
    ArrayBlock arrays;
} Colours;

void colours_free(Colours *colours);

/* Fills colours->visits. False when memory is short. */
bool colours_order(Colours *colours, const ContactProblem *problem);

/* Vectorised sweeps over contacts, with the bits of the scalar reference implementation (engine.c).

   Contacts that share no moving body commute exactly. sweeps.c sorts the visits of several sweeps into levels
   of independent visits, and a level is solved in the lanes of a vector, one pair of bodies per lane (sweeps_lanes.c).
   For few contacts, or where AVX2 was built in and the processor lacks it, visits run one by one on the same records.
   Visits follow the order of the problem's contacts, which is the engine's, or colours: fewer levels, other bits.

   Exact as long as all numbers are finite; sweeps_end() returns false otherwise. */

/* The kernels; sweeps_can() tells which ones the processor supports. */
typedef enum SweepKernel { SWEEP_ONE_BY_ONE, SWEEP_LANES, SWEEP_KERNELS } SweepKernel;

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
   sweep (which overwrite the sums of two sweeps ago), and the number of its factor in the schedule: of the sweep and
   group. */
typedef struct SweepTurns {
    int32_t from[LEVEL_WIDTH], to[LEVEL_WIDTH], factor[LEVEL_WIDTH];
} SweepTurns;

/* The same for a body, before the levels from `level` on. */
typedef struct SweepBodyTurn {
    int32_t from, to, factor, level;
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
    size_t turn_capacity, unsorted_capacity;
    ArrayBlock sorted; /* body_turns and turns_end */
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
    int scheduled_count, scheduled_bodies, scheduled_groups;
    bool scheduled_turns; /* they are for momentum extrapolation */
    bool coloured;        /* the pairs are in the order of colours */
    Colours colours;
    ContactImpulse
        *sums; /* [2, pair_count + 1, 2] with momentum extrapolation: of this sweep and the previous one, alternating */
    int groups;                /* of pairs, each with factors of its own: 1, or the islands */
    int32_t *group;            /* [pair_count] 0 to groups - 1 */
    int32_t *group_of_body;    /* [body_count] that of a moving body's pairs */
    SweepBody *kept_bodies;    /* [body_count] what sweeps_keep() copied */
    ContactImpulse *kept_sums; /* [pair_count, 2] */
    SweepSchedule whole, rest; /* of as many sweeps as fit, run repeatedly, and of the remaining sweeps */
    bool *moves;               /* [body_count] an impulse can change the body's velocity */
    int64_t *quiet_since;      /* [pair_count] one by one: the visit since which the pair is unchanged; 0: none */
    int64_t *changed_at;       /* [body_count] one by one: number of the visit that last changed the body */
    int32_t *ready;            /* [body_count] while scheduling: the first level that may visit the body */
    int32_t *seen; /* [body_count] while scheduling with momentum extrapolation: sweeps that have visited the body */
    ArrayBlock arrays; /* all but `scheduled`, the colours' and the schedules' */
    size_t scheduled_capacity;
} Sweeps;

void sweeps_free(Sweeps *sweeps);

/* Loads a problem and applies its warm start. False when memory is short. */
bool sweeps_begin(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem, bool warm);

/* The same with visits in the order of colours: faster, with other bits. With warm start. */
bool sweeps_begin_coloured(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem);

/* `count` sweeps over all contacts. False when memory is short. */
bool sweeps_run(Sweeps *sweeps, int count);

/* The same with momentum extrapolation before each sweep but the first, with the bits of the scalar reference
   implementation in tests/methods/momentum_scalar.h: velocities and sums advance by factors[sweep, group] times the
   change by the previous sweep, including its extrapolation. */
bool sweeps_run_momentum(Sweeps *sweeps, const float *factors, int count);

/* Continues after sweeps_run_momentum() or itself, as if in one run: here the first sweep's factors count. Both counts
   are even. */
bool sweeps_continue_momentum(Sweeps *sweeps, const float *factors, int count);

/* Islands: groups of pairs that share no moving body with others, so what happens in one changes no bit in another.
   After sweeps_begin(), which makes a single group of all. */

/* Finds the islands. */
void sweeps_group(Sweeps *sweeps);

/* Computes the velocities from the sums, for the problem that the sweeps began with: over many sweeps with momentum
   rounding errors take them apart, by mm/s after a hundred. The velocities before the last sweep move by as much:
   momentum would go on along the difference, and make it 1 / (1 - beta) times as large. chosen[groups]: of which; NULL:
   of all. */
void sweeps_refresh(Sweeps *sweeps, const ContactProblem *problem, const bool *chosen);

/* Copies sums, and velocities of moving bodies, of the groups for which chosen[groups] is true. */
void sweeps_keep(Sweeps *sweeps, const bool *chosen);

/* Copies them back. sweeps_continue_momentum() then begins from them without momentum. */
void sweeps_return(Sweeps *sweeps, const bool *chosen);

/* Applies additional impulses [contact_count] and adds them to the sums. */
void sweeps_push(Sweeps *sweeps, const ContactImpulse *impulses);

/* A contact slides if its tangent impulse times this exceeds the limit. */
#define SWEEP_AT_LIMIT 1.0001f
/* Friction below which no contact of boxes overshoots enough to matter (overshoot_of_pairs() in methods/residual.h): an
   impulse at a corner, r from the middle, in the plane's directions n and t, overshoots by friction times q c s / (1 +
   q c^2), where c = cos, s = sin of the angle between the arm and t, and q = m r^2 / I = 3: at most 0.75. Less than
   0.264 is no matter (largest_factor() in momentum.c). */
#define SWEEP_SLIPPERY 0.35f

static inline int sweep_pair_points(const SweepPair *pair) { return pair->points[1].extra < 0.0f ? 2 : 1; }

/* False if none of the pair's contacts slides, or friction is too low for it to matter. New contacts may slide. */
static inline bool sweep_pair_may_overshoot(const SweepPair *pair) {
    if (pair->friction < SWEEP_SLIPPERY) return false;
    bool may = false;
    for (int k = 0; k < sweep_pair_points(pair); k++) {
        const ContactImpulse sum = pair->sums[k];
        may |= !(sum.normal > 0) || pair->friction * sum.normal < SWEEP_AT_LIMIT * fabsf(sum.tangent);
    }
    return may;
}

/* Stores velocities and impulses. False if a velocity is NaN or infinite: then the bits may depend on the order of
   visits. */
bool sweeps_end(const Sweeps *sweeps, ContactSolution *solution);

/* Internal functions of the sweeps. */

enum { SWEEPS_AT_ONCE = 16 }; /* sweeps in one schedule, which is run repeatedly */

bool sweeps_have_lanes(void);

/* Solves the levels one after the other, a pair in each lane. factors[the schedule's sweeps, groups], or NULL without
   momentum extrapolation. */
void sweeps_run_lanes(Sweeps *sweeps, const SweepSchedule *schedule, const float *factors);

/* As residual_of_pairs() and overshoot_of_pairs() in methods/residual.h, a pair in each lane. */
void sweeps_residuals_in_lanes(const Sweeps *sweeps, float *squared);
void sweeps_overshoots_in_lanes(const Sweeps *sweeps, float *overshoot);

/* Applies the impulses in the sums, of the groups for which chosen[groups] is true; NULL: of all. */
void sweeps_push_sums(Sweeps *sweeps, const bool *chosen);

/* Sweeps pair by pair, and stops early after a sweep without a change: later ones would change nothing. */
void sweeps_run_one_by_one(Sweeps *sweeps, const float *factors, int count);
