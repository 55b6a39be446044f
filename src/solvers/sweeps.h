/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sequential sweeps over contacts, fast, and with the bits of the plain text (sequential_impulses.c).

   Contacts that share no moving body commute exactly. So a sweep need not visit them one by one: sweeps_schedule.c
   sorts the visits of several sweeps into levels, each of visits that do not depend on each other, and a level is
   solved in the lanes of a vector, one pair of bodies a lane (sweeps_lanes.h). Few contacts, or a processor without
   such vectors: one after the other, from the same packed records.

   Exact as long as all numbers are finite; sweeps_end tells where they are not. */
#pragma once
#include "dynamics/contact_problem.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* How to sweep; all that the processor has, as sweeps_can says. */
typedef enum SweepKernel { SWEEP_ONE_BY_ONE, SWEEP_AVX2, SWEEP_KERNELS } SweepKernel;

bool sweeps_can(SweepKernel kernel);

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
} SweepPair;

enum {
    LEVEL_WIDTH = 16,
    PAIR_FLOATS = sizeof(SweepPair) / sizeof(float),
    BODY_FLOATS = sizeof(SweepBody) / sizeof(float)
};

/* Visits that commute: where their records begin, in floats. Slots without a visit have the spare body and pair,
   which are all zeros. */
typedef struct SweepLevel {
    int32_t pair[LEVEL_WIDTH], a[LEVEL_WIDTH], b[LEVEL_WIDTH];
} SweepLevel;

/* The levels of `sweeps` sweeps. */
typedef struct SweepSchedule {
    int sweeps, level_count;
    SweepLevel *levels;
    int32_t *filled; /* [level_count] visits in each */
    int32_t *open;   /* [level_count] a level at or after this one that may still have room */
    size_t level_capacity, filled_capacity, open_capacity;
} SweepSchedule;

/* The two bodies of a pair. One that no impulse moves is there as ~index: many may visit it at once. */
typedef struct SweepEnds {
    int32_t a, b;
} SweepEnds;

/* Zero-initialise; arrays grow and are reused. */
typedef struct Sweeps {
    SweepKernel kernel;
    int body_count, pair_count;
    SweepBody *bodies;    /* [body_count + 1] */
    SweepPair *pairs;     /* [pair_count + 1] */
    SweepEnds *ends;      /* [pair_count] */
    SweepEnds *scheduled; /* [scheduled_count] the ends that the schedules are made for */
    int scheduled_count, scheduled_bodies;
    SweepSchedule whole, rest; /* of as many sweeps as fit, run again and again, and of those left over */
    bool *moves;               /* [body_count] can an impulse change the body's velocity? */
    int64_t *quiet_since; /* [pair_count] one by one: number of the visit since which nothing changes; 0: of none */
    int64_t *changed_at;  /* [body_count] one by one: number of the visit that last changed the body */
    int32_t *ready;       /* [body_count] while scheduling: the first level that may visit the body */
    size_t quiet_capacity, changed_capacity;
    size_t body_capacity, pair_capacity, ends_capacity, scheduled_capacity, moves_capacity, ready_capacity;
} Sweeps;

void sweeps_free(Sweeps *sweeps);

/* Takes a problem in and applies its warm start. False when memory is short. */
bool sweeps_begin(Sweeps *sweeps, SweepKernel kernel, const ContactProblem *problem);

/* Sweeps `count` times over all contacts. False when memory is short. */
bool sweeps_run(Sweeps *sweeps, int count);

/* Hands out what was found. False where a velocity is not finite: then the order of visits may have mattered. */
bool sweeps_end(const Sweeps *sweeps, ContactSolution *solution);
