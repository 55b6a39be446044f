/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sweep kernel over the lanes of a vector, without fused multiply-add, which rounds once where the scalar reference
   implementation rounds twice.

   The operations of engine.c, with three exceptions that have the same bits for finite numbers: x - y for
   x + -y, the tangent's components written out, and no change of the velocity of a static body. */
#include "methods/sweeps.h"

#include "methods/lanes.h"

/* As load_rows, of now - (factor * (before - now) + 0). number: that of each lane's factor. */
static inline void load_extrapolated(Lanes out[4], const float *base, const int32_t *now, const int32_t *before,
                                     const float *factors, const int32_t *number) {
    Lanes rows[4];
    for (int i = 0; i < 4; i++) {
        const Lanes from = lanes_load(base, now + i), change = lanes_load(base, before + i) - from;
        rows[i] = from - (lanes_all(factors, number + i) * change + 0.0f);
    }
    transpose(out, rows);
}

/* Velocity of b's point relative to a's. */
static inline LaneVec relative_velocity(const Side *a, const Side *b, LaneVec arm_a, LaneVec arm_b) {
    return (LaneVec){b->x - b->spin * arm_b.y - a->x + a->spin * arm_a.y,
                     b->y + b->spin * arm_b.x - a->y - a->spin * arm_a.x};
}

/* The data that both points of a pair share. */
typedef struct Surface {
    LaneVec normal, tangent;
    Lanes friction;
} Surface;

/* shared: normal, friction, inverse inertia of a. */
static inline Surface surface_of(const Lanes shared[4]) {
    return (Surface){{shared[0], shared[1]}, {shared[1], -shared[0]}, shared[2]};
}

/* One visit of a point: the normal impulse, then friction. arms: of a and b, x and y; masses: normal, tangent, bias. */
static inline void solve_point(Side *a, Side *b, const Surface *surface, const Lanes arms[4], const Lanes masses[4],
                               Lanes *sum_normal, Lanes *sum_tangent) {
    const LaneVec arm_a = {arms[0], arms[1]}, arm_b = {arms[2], arms[3]};
    const Lanes apart = dot(relative_velocity(a, b, arm_a, arm_b), surface->normal);
    const Lanes pushed = lanes_max(*sum_normal + masses[0] * (masses[2] - apart), (Lanes){0});
    const Lanes normal = pushed - *sum_normal;
    *sum_normal = pushed;
    apply(a, b, arm_a, arm_b, scaled(normal, surface->normal));

    const Lanes along = dot(relative_velocity(a, b, arm_a, arm_b), surface->tangent);
    const Lanes limit = surface->friction * pushed;
    const Lanes dragged = lanes_clamp(*sum_tangent - masses[1] * along, -limit, limit);
    const Lanes tangent = dragged - *sum_tangent;
    *sum_tangent = dragged;
    apply(a, b, arm_a, arm_b, scaled(tangent, surface->tangent));
}

/* turns, factors: NULL without momentum extrapolation. */
__attribute__((always_inline)) static inline void solve_pairs(Sweeps *sweeps, const SweepLevel *level,
                                                              const SweepTurns *turns, int lane, const float *factors) {
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
    const Surface surface = surface_of(shared);
    Side a = load_side(&sweeps->bodies->x, offset_a, shared[3]),
         b = load_side(&sweeps->bodies->x, offset_b, masses1[3]);

    solve_point(&a, &b, &surface, arms1, masses1, &sums[0], &sums[1]);
    const Side single_a = a, single_b = b;
    load_rows(arms2, &records->points[1].arm_a.x, pair);
    load_rows(masses2, &records->points[1].mass_normal, pair);
    solve_point(&a, &b, &surface, arms2, masses2, &sums[2], &sums[3]);
    if (lanes_any_positive(masses2[3])) {
        keep_where_single(&a, &single_a, masses2[3]);
        keep_where_single(&b, &single_b, masses2[3]);
    }

    store_side(&sweeps->bodies->x, offset_a, &a);
    store_side(&sweeps->bodies->x, offset_b, &b);
    if (turns == NULL)
        store_rows(&records->sums[0].normal, pair, sums);
    else
        store_rows(&sweeps->sums->normal, turns->to + lane, sums);
}

void sweeps_run_lanes(Sweeps *sweeps, const SweepSchedule *schedule, const float *factors) {
    for (int i = 0, turn = 0; i < schedule->level_count; i++) {
        const SweepLevel *level = &schedule->levels[i];
        if (factors == NULL) {
            for (int lane = 0; lane < schedule->filled[i]; lane += LANES) solve_pairs(sweeps, level, NULL, lane, NULL);
            continue;
        }
        /* The rows of two sweeps ago are replaced. */
        for (; turn < schedule->turns_end[i]; turn++) {
            const SweepBodyTurn *body = &schedule->body_turns[turn];
            Row *to = row_at(&sweeps->bodies->x, body->to);
            const Row from = row_of(&sweeps->bodies->x, body->from);
            *to = from - (factors[body->factor] * (*to - from) + 0.0f);
        }
        for (int lane = 0; lane < schedule->filled[i]; lane += LANES)
            solve_pairs(sweeps, level, &schedule->turns[i], lane, factors);
    }
}

/* What is measured at the points of pairs: two at most, of the same bodies. */
typedef struct LanePoint {
    Lanes arms[4], masses[4]; /* as in solve_point() */
    Lanes normal, tangent;    /* the sums */
} LanePoint;

typedef struct LanePair {
    Surface surface;
    Side a, b;
    LanePoint points[2];
} LanePair;

/* The pairs whose records have these offsets, as in a level. */
static inline LanePair load_pair_lanes(const Sweeps *sweeps, const SweepLevel *at) {
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
    pair.surface = surface_of(shared);
    pair.a = load_side(&sweeps->bodies->x, at->a, shared[3]);
    pair.b = load_side(&sweeps->bodies->x, at->b, pair.points[0].masses[3]);
    return pair;
}

/* As in residual.c. */
static inline LaneVec velocity_there(const LanePair *pair, const Lanes arms[4]) {
    const Side *a = &pair->a, *b = &pair->b;
    return (LaneVec){(b->x - b->spin * arms[3]) - (a->x - a->spin * arms[1]),
                     (b->y + b->spin * arms[2]) - (a->y + a->spin * arms[0])};
}

/* The operations of squared_of_visit() in residual.c. Anything for a point that is not there. */
static inline Lanes squared_of_visit(const LanePair *pair, const LanePoint *point) {
    const LaneVec v = velocity_there(pair, point->arms);
    const Lanes slip = dot(v, pair->surface.tangent), gap = dot(v, pair->surface.normal) - point->masses[2];
    const Lanes normal = lanes_min(point->normal / point->masses[0], gap);
    const Lanes limit = pair->surface.friction * point->normal;
    const Lanes wanted = lanes_min(point->tangent - point->masses[1] * slip, limit);
    const Lanes tangent = (point->tangent - lanes_max(-limit, wanted)) / point->masses[1];
    return normal * normal + tangent * tangent + (0.0f * v.x + 0.0f * v.y); /* NaN for what is not finite */
}

/* The operations of overshoot_of_point() in residual.c. Anything for a point that is not there. */
static inline Lanes overshoot_of_point(const LanePair *pair, const LanePoint *point) {
    const LaneVec v = velocity_there(pair, point->arms), n = pair->surface.normal, t = pair->surface.tangent;
    const LaneVec arm_a = {point->arms[0], point->arms[1]}, arm_b = {point->arms[2], point->arms[3]};
    const Lanes gap = dot(v, n) - point->masses[2], slip = dot(v, t);
    const Lanes knt = pair->a.inv_inertia * (cross(arm_a, n) * cross(arm_a, t)) +
                      pair->b.inv_inertia * (cross(arm_b, n) * cross(arm_b, t));
    const Lanes share = pair->surface.friction * (point->masses[0] * knt);
    const Lanes held = 0.0f - point->normal; /* < 0 */
    const Lanes dragged = lanes_max(point->tangent, -point->tangent);
    const Lanes room = pair->surface.friction * point->normal - SWEEP_AT_LIMIT * dragged;
    /* + 0, as -0 is not below 0 */
    const Lanes slides = lanes_choose(gap, room, held) + 0.0f;
    const Lanes against = lanes_choose(-slip, point->tangent, held) + 0.0f;
    const Lanes overshoot = lanes_choose(share, -share, against);
    return lanes_max(lanes_choose((Lanes){0}, overshoot, slides), (Lanes){0});
}

/* Some pairs in a row, those behind the last as the first of them. */
static inline SweepLevel pairs_from(const Sweeps *sweeps, int first) {
    SweepLevel at;
    for (int lane = 0; lane < LANES; lane++) {
        const int i = first + lane < sweeps->pair_count ? first + lane : first;
        at.pair[lane] = i * PAIR_FLOATS;
        at.a[lane] = sweep_body_at(sweeps->ends[i].a) * BODY_FLOATS;
        at.b[lane] = sweep_body_at(sweeps->ends[i].b) * BODY_FLOATS;
    }
    return at;
}

static inline void store_from(const Sweeps *sweeps, int first, Lanes values, float *to) {
    for (int lane = 0; lane < LANES && first + lane < sweeps->pair_count; lane++) to[first + lane] = values[lane];
}

void sweeps_residuals_in_lanes(const Sweeps *sweeps, float *squared) {
    for (int first = 0; first < sweeps->pair_count; first += LANES) {
        const SweepLevel at = pairs_from(sweeps, first);
        const LanePair pair = load_pair_lanes(sweeps, &at);
        const Lanes second = squared_of_visit(&pair, &pair.points[1]);
        const Lanes sum =
            squared_of_visit(&pair, &pair.points[0]) + lanes_choose((Lanes){0}, second, pair.points[1].masses[3]);
        store_from(sweeps, first, sum, squared);
    }
}

void sweeps_overshoots_in_lanes(const Sweeps *sweeps, float *overshoot) {
    for (int first = 0; first < sweeps->pair_count; first += LANES) {
        Lanes most = {0};
        bool may = false;
        for (int i = first; i < first + LANES && i < sweeps->pair_count; i++)
            may |= sweep_pair_may_overshoot(&sweeps->pairs[i]);
        if (may) {
            const SweepLevel at = pairs_from(sweeps, first);
            const LanePair pair = load_pair_lanes(sweeps, &at);
            const Lanes second = overshoot_of_point(&pair, &pair.points[1]);
            most = lanes_max(lanes_choose((Lanes){0}, second, pair.points[1].masses[3]),
                             overshoot_of_point(&pair, &pair.points[0]));
            most = lanes_choose(most, (Lanes){0}, pair.surface.friction - SWEEP_SLIPPERY);
        }
        store_from(sweeps, first, most, overshoot);
    }
}

bool sweeps_have_lanes(void) {
#ifdef TWINBOX_AVX
    return __builtin_cpu_supports("avx2");
#else
    return true;
#endif
}
