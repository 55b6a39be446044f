/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sweep kernel over the lanes of a vector. Included once by the file of each instruction set, which defines the
   vector type Lanes, LANES of them, TARGET and the operations used here.

   The operations of sweeps_scalar.c, with three exceptions that have the same bits for finite numbers: x - y for
   x + -y, the tangent's components written out, and no change of the velocity of a static body. */
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

/* As load_rows, of now - (factor * (before - now) + 0). number: that of each lane's factor. */
TARGET static inline void load_extrapolated(Lanes out[4], const float *base, const int32_t *now, const int32_t *before,
                                            const float *factors, const int32_t *number);
/* Replaces the row of two sweeps ago. */
TARGET static inline void extrapolate_body(float *base, const SweepBodyTurn *turn, const float *factors);

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
TARGET __attribute__((always_inline)) static inline void
solve_pairs(Sweeps *sweeps, const SweepLevel *level, const SweepTurns *turns, int lane, const float *factors) {
    SweepPair *records = sweeps->pairs;
    const int32_t *pair = level->pair + lane, *offset_a = level->a + lane, *offset_b = level->b + lane;
    Lanes sums[4], shared[4], arms1[4], masses1[4], arms2[4], masses2[4];
    if (turns == NULL)
        load_rows(sums, &records->sums[0].normal, pair);
    else
        load_extrapolated(sums, &sweeps->sums->normal, turns->from + lane, turns->to + lane, factors,
                          turns->factor + lane);
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
                                                   const float *factors) {
    for (int i = 0, turn = 0; i < schedule->level_count; i++) {
        for (; turn < schedule->turns_end[i]; turn++)
            extrapolate_body(&sweeps->bodies->x, &schedule->body_turns[turn], factors);
        for (int lane = 0; lane < schedule->filled[i]; lane += LANES)
            solve_pairs(sweeps, &schedule->levels[i], &schedule->turns[i], lane, factors);
    }
}

/* What is measured at the points of pairs: two at most, of the same bodies. */
typedef struct LanePoint {
    Lanes arms[4], masses[4]; /* as in solve_normal() */
    Lanes normal, tangent;    /* the sums */
} LanePoint;

typedef struct LanePair {
    Surface surface;
    Side a, b;
    LanePoint points[2];
} LanePair;

/* The pairs whose records have these offsets, as in a level. */
TARGET static inline LanePair load_pair_lanes(const Sweeps *sweeps, const SweepLevel *at) {
    const SweepPair *records = sweeps->pairs;
    LanePair pair;
    Lanes sums[4], shared[4];
    load_rows(sums, &records->sums[0].normal, at->pair);
    load_rows(shared, &records->normal.x, at->pair);
    for (int k = 0; k < 2; k++) {
        load_rows(pair.points[k].arms, &records->points[k].arm_a.x, at->pair);
        load_rows(pair.points[k].masses, &records->points[k].mass_normal, at->pair);
        pair.points[k].normal = sums[2 * k];
        pair.points[k].tangent = sums[2 * k + 1];
    }
    pair.surface = (Surface){{shared[0], shared[1]}, {shared[1], lanes_negate(shared[0])}, shared[2]};
    pair.a = load_side(sweeps, at->a, shared[3]);
    pair.b = load_side(sweeps, at->b, pair.points[0].masses[3]);
    return pair;
}

/* As in residual.c. */
TARGET static inline LaneVec velocity_there(const LanePair *pair, const Lanes arms[4]) {
    const Side *a = &pair->a, *b = &pair->b;
    return (LaneVec){
        lanes_sub(lanes_sub(b->x, lanes_mul(b->spin, arms[3])), lanes_sub(a->x, lanes_mul(a->spin, arms[1]))),
        lanes_sub(lanes_add(b->y, lanes_mul(b->spin, arms[2])), lanes_add(a->y, lanes_mul(a->spin, arms[0])))};
}

TARGET static inline Lanes dot(LaneVec a, LaneVec b) { return lanes_add(lanes_mul(a.x, b.x), lanes_mul(a.y, b.y)); }

/* The operations of squared_of_visit() in residual.c. Anything for a point that is not there. */
TARGET static inline Lanes squared_of_visit(const LanePair *pair, const LanePoint *point) {
    const LaneVec v = velocity_there(pair, point->arms);
    const Lanes slip = dot(v, pair->surface.tangent), gap = lanes_sub(dot(v, pair->surface.normal), point->masses[2]);
    const Lanes normal = lanes_min(lanes_divide(point->normal, point->masses[0]), gap);
    const Lanes limit = lanes_mul(pair->surface.friction, point->normal);
    const Lanes wanted = lanes_min(lanes_sub(point->tangent, lanes_mul(point->masses[1], slip)), limit);
    const Lanes clamped = lanes_max(lanes_negate(limit), wanted);
    const Lanes tangent = lanes_divide(lanes_sub(point->tangent, clamped), point->masses[1]);
    const Lanes squared = lanes_add(lanes_mul(normal, normal), lanes_mul(tangent, tangent));
    return lanes_add(squared, lanes_add(lanes_sub(v.x, v.x), lanes_sub(v.y, v.y)));
}

/* The operations of overshoot_of_point() in residual.c. Anything for a point that is not there. */
TARGET static inline Lanes overshoot_of_point(const LanePair *pair, const LanePoint *point) {
    const LaneVec v = velocity_there(pair, point->arms), n = pair->surface.normal, t = pair->surface.tangent;
    const LaneVec arm_a = {point->arms[0], point->arms[1]}, arm_b = {point->arms[2], point->arms[3]};
    const Lanes gap = lanes_sub(dot(v, n), point->masses[2]), slip = dot(v, t);
    const Lanes turn_a = lanes_mul(cross(arm_a, n), cross(arm_a, t)),
                turn_b = lanes_mul(cross(arm_b, n), cross(arm_b, t));
    const Lanes knt = lanes_add(lanes_mul(pair->a.inv_inertia, turn_a), lanes_mul(pair->b.inv_inertia, turn_b));
    const Lanes share = lanes_mul(pair->surface.friction, lanes_mul(point->masses[0], knt));
    const Lanes held = lanes_sub(lanes_zero(), point->normal); /* < 0 */
    const Lanes dragged = lanes_max(point->tangent, lanes_negate(point->tangent));
    const Lanes room =
        lanes_sub(lanes_mul(pair->surface.friction, point->normal), lanes_mul(lanes_all(SWEEP_AT_LIMIT), dragged));
    /* + 0, as -0 is not below 0 */
    const Lanes slides = lanes_add(lanes_choose(gap, room, held), lanes_zero());
    const Lanes against = lanes_add(lanes_choose(lanes_negate(slip), point->tangent, held), lanes_zero());
    const Lanes overshoot = lanes_choose(share, lanes_negate(share), against);
    return lanes_max(lanes_choose(lanes_zero(), overshoot, slides), lanes_zero());
}

/* Some pairs in a row, those behind the last as the first of them. */
TARGET static inline SweepLevel pairs_from(const Sweeps *sweeps, int first) {
    SweepLevel at;
    for (int lane = 0; lane < LANES; lane++) {
        const int i = first + lane < sweeps->pair_count ? first + lane : first;
        at.pair[lane] = i * PAIR_FLOATS;
        at.a[lane] = sweep_body_at(sweeps->ends[i].a) * BODY_FLOATS;
        at.b[lane] = sweep_body_at(sweeps->ends[i].b) * BODY_FLOATS;
    }
    return at;
}

TARGET static inline void store_from(const Sweeps *sweeps, int first, Lanes values, float *to) {
    float row[LANES];
    lanes_store(row, values);
    for (int lane = 0; lane < LANES && first + lane < sweeps->pair_count; lane++) to[first + lane] = row[lane];
}

TARGET static inline void measure_residuals(const Sweeps *sweeps, float *squared) {
    for (int first = 0; first < sweeps->pair_count; first += LANES) {
        const SweepLevel at = pairs_from(sweeps, first);
        const LanePair pair = load_pair_lanes(sweeps, &at);
        const Lanes second = squared_of_visit(&pair, &pair.points[1]);
        const Lanes sum = lanes_add(squared_of_visit(&pair, &pair.points[0]),
                                    lanes_choose(lanes_zero(), second, pair.points[1].masses[3]));
        store_from(sweeps, first, sum, squared);
    }
}

static inline bool any_may_overshoot(const Sweeps *sweeps, int first) {
    bool may = false;
    for (int i = first; i < first + LANES && i < sweeps->pair_count; i++)
        may |= sweep_pair_may_overshoot(&sweeps->pairs[i]);
    return may;
}

TARGET static inline void measure_overshoots(const Sweeps *sweeps, float *overshoot) {
    for (int first = 0; first < sweeps->pair_count; first += LANES) {
        Lanes most = lanes_zero();
        if (any_may_overshoot(sweeps, first)) {
            const SweepLevel at = pairs_from(sweeps, first);
            const LanePair pair = load_pair_lanes(sweeps, &at);
            const Lanes second = overshoot_of_point(&pair, &pair.points[1]);
            most = lanes_max(lanes_choose(lanes_zero(), second, pair.points[1].masses[3]),
                             overshoot_of_point(&pair, &pair.points[0]));
            const Lanes slippery = lanes_sub(pair.surface.friction, lanes_all(SWEEP_SLIPPERY)); /* < 0 */
            most = lanes_choose(most, lanes_zero(), slippery);
        }
        store_from(sweeps, first, most, overshoot);
    }
}
