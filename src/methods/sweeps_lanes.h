/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sweep kernel over the lanes of a vector. Included once by the file of each instruction set, which defines the
   vector type Lanes, LANES of them, TARGET and the operations used here.

   The operations of methods/sweeps_scalar.c, with three exceptions that have the same bits for finite numbers: x - y
   for x + -y, the tangent's components written out, and no change of the velocity of a static body. */
#include "methods/sweeps.h"

/* Velocities of the bodies at one end of the pairs, one pair per lane. */
typedef struct Side {
    Lanes x, y, spin, inv_mass, inv_inertia;
} Side;

/* A quantity with two components. */
typedef struct LaneVec {
    Lanes x, y;
} LaneVec;

/* Velocity of b's point relative to a's. */
TARGET static inline LaneVec relative_velocity(const Side *a, const Side *b, LaneVec arm_a, LaneVec arm_b) {
    Lanes x = lanes_add(lanes_sub(lanes_sub(b->x, lanes_mul(b->spin, arm_b.y)), a->x), lanes_mul(a->spin, arm_a.y));
    Lanes y = lanes_sub(lanes_sub(lanes_add(b->y, lanes_mul(b->spin, arm_b.x)), a->y), lanes_mul(a->spin, arm_a.x));
    return (LaneVec){x, y};
}

TARGET static inline Lanes cross(LaneVec a, LaneVec b) { return lanes_sub(lanes_mul(a.x, b.y), lanes_mul(a.y, b.x)); }

/* Applies impulse to b and its opposite to a. */
TARGET static inline void apply(Side *a, Side *b, LaneVec arm_a, LaneVec arm_b, LaneVec impulse) {
    a->x = lanes_sub(a->x, lanes_mul(a->inv_mass, impulse.x));
    a->y = lanes_sub(a->y, lanes_mul(a->inv_mass, impulse.y));
    a->spin = lanes_sub(a->spin, lanes_mul(a->inv_inertia, cross(arm_a, impulse)));
    b->x = lanes_add(b->x, lanes_mul(b->inv_mass, impulse.x));
    b->y = lanes_add(b->y, lanes_mul(b->inv_mass, impulse.y));
    b->spin = lanes_add(b->spin, lanes_mul(b->inv_inertia, cross(arm_b, impulse)));
}

/* The data that both points of a pair share. */
typedef struct Surface {
    LaneVec normal, tangent;
    Lanes friction;
} Surface;

/* arms: of a and b, x and y; masses: normal, tangent, bias. */
TARGET static inline void solve_normal(Side *a, Side *b, const Surface *surface, const Lanes arms[4],
                                       const Lanes masses[4], Lanes *sum) {
    LaneVec arm_a = {arms[0], arms[1]}, arm_b = {arms[2], arms[3]}, n = surface->normal;
    LaneVec v = relative_velocity(a, b, arm_a, arm_b);
    Lanes along = lanes_add(lanes_mul(v.x, n.x), lanes_mul(v.y, n.y));
    Lanes normal = lanes_mul(masses[0], lanes_sub(masses[2], along));
    Lanes total = lanes_max(lanes_add(*sum, normal), lanes_zero());
    normal = lanes_sub(total, *sum);
    *sum = total;
    apply(a, b, arm_a, arm_b, (LaneVec){lanes_mul(normal, n.x), lanes_mul(normal, n.y)});
}

TARGET static inline void solve_friction(Side *a, Side *b, const Surface *surface, const Lanes arms[4],
                                         const Lanes masses[4], Lanes sum_normal, Lanes *sum) {
    LaneVec arm_a = {arms[0], arms[1]}, arm_b = {arms[2], arms[3]}, t = surface->tangent;
    LaneVec v = relative_velocity(a, b, arm_a, arm_b);
    Lanes along = lanes_add(lanes_mul(v.x, t.x), lanes_mul(v.y, t.y));
    Lanes limit = lanes_mul(surface->friction, sum_normal);
    Lanes total = lanes_min(lanes_sub(*sum, lanes_mul(masses[1], along)), limit);
    total = lanes_max(lanes_negate(limit), total);
    Lanes tangent = lanes_sub(total, *sum);
    *sum = total;
    apply(a, b, arm_a, arm_b, (LaneVec){lanes_mul(tangent, t.x), lanes_mul(tangent, t.y)});
}

TARGET static inline void solve_point(Side *a, Side *b, const Surface *surface, const Lanes arms[4],
                                      const Lanes masses[4], Lanes *sum_normal, Lanes *sum_tangent) {
    solve_normal(a, b, surface, arms, masses, sum_normal);
    solve_friction(a, b, surface, arms, masses, *sum_normal, sum_tangent);
}

/* `base` is a row of four floats in the first record, `offsets` those of the lanes' rows, in floats; out[k] gets the
   k-th float of each row. */
TARGET static inline void load_rows(Lanes out[4], const float *base, const int32_t *offsets);
TARGET static inline void store_rows(float *base, const int32_t *offsets, const Lanes in[4]);

/* A sweep's factor for extrapolation, for a whole row. */
typedef float Factor[4];

/* As load_rows, of now - (factor * (before - now) + 0). */
TARGET static inline void load_extrapolated(Lanes out[4], const float *base, const int32_t *now, const int32_t *before,
                                            const Factor *factors, const int32_t *sweep);
/* Replaces the row of two sweeps ago. */
TARGET static inline void extrapolate_body(float *base, const SweepBodyTurn *turn, const Factor *factors);

TARGET static inline Side load_side(const Sweeps *sweeps, const int32_t *offsets, Lanes inv_inertia) {
    Lanes rows[4];
    load_rows(rows, &sweeps->bodies->x, offsets);
    return (Side){rows[0], rows[1], rows[2], rows[3], inv_inertia};
}

TARGET static inline void store_side(Sweeps *sweeps, const int32_t *offsets, const Side *side) {
    const Lanes rows[4] = {side->x, side->y, side->spin, side->inv_mass};
    store_rows(&sweeps->bodies->x, offsets, rows);
}

/* Selects the velocities after the second point for pairs that have one, else those before. */
TARGET static inline void keep_where_single(Side *after, const Side *before, Lanes second) {
    after->x = lanes_choose(before->x, after->x, second);
    after->y = lanes_choose(before->y, after->y, second);
    after->spin = lanes_choose(before->spin, after->spin, second);
}

/* turns, factors: NULL without momentum extrapolation. */
TARGET static inline void solve_pairs(Sweeps *sweeps, const SweepLevel *level, const SweepTurns *turns, int lane,
                                      const Factor *factors) {
    SweepPair *records = sweeps->pairs;
    const int32_t *pair = level->pair + lane, *offset_a = level->a + lane, *offset_b = level->b + lane;
    Lanes sums[4], shared[4], arms1[4], masses1[4], arms2[4], masses2[4];
    if (turns == NULL)
        load_rows(sums, &records->sums[0].normal, pair);
    else
        load_extrapolated(sums, &sweeps->sums->normal, turns->from + lane, turns->to + lane, factors,
                          turns->sweep + lane);
    load_rows(shared, &records->normal.x, pair);
    load_rows(arms1, &records->points[0].arm_a.x, pair);
    load_rows(masses1, &records->points[0].mass_normal, pair);
    const Surface surface = {{shared[0], shared[1]}, {shared[1], lanes_negate(shared[0])}, shared[2]};
    Side a = load_side(sweeps, offset_a, shared[3]), b = load_side(sweeps, offset_b, masses1[3]);

    solve_point(&a, &b, &surface, arms1, masses1, &sums[0], &sums[1]);
    Side single_a = a, single_b = b;
    load_rows(arms2, &records->points[1].arm_a.x, pair);
    load_rows(masses2, &records->points[1].mass_normal, pair);
    solve_point(&a, &b, &surface, arms2, masses2, &sums[2], &sums[3]);
    if (lanes_any_positive(masses2[3])) {
        keep_where_single(&a, &single_a, masses2[3]);
        keep_where_single(&b, &single_b, masses2[3]);
    }

    store_side(sweeps, offset_a, &a);
    store_side(sweeps, offset_b, &b);
    if (turns == NULL)
        store_rows(&records->sums[0].normal, pair, sums);
    else
        store_rows(&sweeps->sums->normal, turns->to + lane, sums);
}

TARGET static inline void run_levels(Sweeps *sweeps, const SweepSchedule *schedule) {
    for (int i = 0; i < schedule->level_count; i++)
        for (int lane = 0; lane < schedule->filled[i]; lane += LANES)
            solve_pairs(sweeps, &schedule->levels[i], NULL, lane, NULL);
}

TARGET static inline void run_levels_extrapolating(Sweeps *sweeps, const SweepSchedule *schedule,
                                                   const float *sweep_factors) {
    Factor factors[SWEEPS_AT_ONCE];
    for (int sweep = 0; sweep < schedule->sweeps; sweep++)
        for (int i = 0; i < 4; i++) factors[sweep][i] = sweep_factors[sweep];
    for (int i = 0, turn = 0; i < schedule->level_count; i++) {
        for (; turn < schedule->turns_end[i]; turn++)
            extrapolate_body(&sweeps->bodies->x, &schedule->body_turns[turn], factors);
        for (int lane = 0; lane < schedule->filled[i]; lane += LANES)
            solve_pairs(sweeps, &schedule->levels[i], &schedule->turns[i], lane, factors);
    }
}
