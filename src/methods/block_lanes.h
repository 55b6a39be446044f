/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The block solver's visit over the lanes of a vector: the operations of block.c, with the exceptions of
   sweeps_lanes.h. All cases are computed; each lane selects its own. */

/* The points of the pairs, one pair per lane. */
typedef struct LanePoints {
    Lanes arms[2][4];   /* of a and b, x and y */
    Lanes masses[2][4]; /* normal, tangent, bias, extra (SweepPoint) */
} LanePoints;

TARGET static inline Lanes normal_velocity(const Side *a, const Side *b, LaneVec n, const Lanes arms[4]) {
    LaneVec v = relative_velocity(a, b, (LaneVec){arms[0], arms[1]}, (LaneVec){arms[2], arms[3]});
    return lanes_add(lanes_mul(v.x, n.x), lanes_mul(v.y, n.y));
}

TARGET static inline void push(Side *a, Side *b, LaneVec n, const Lanes arms[4], Lanes impulse) {
    apply(a, b, (LaneVec){arms[0], arms[1]}, (LaneVec){arms[2], arms[3]},
          (LaneVec){lanes_mul(impulse, n.x), lanes_mul(impulse, n.y)});
}

/* block: k11, k12, k22, inverse determinant; from the last case to the first, which takes precedence. */
TARGET static inline LaneVec solve_cases(const Lanes block[4], Lanes mass1, Lanes mass2, LaneVec x, LaneVec q) {
    const Lanes zero = lanes_zero();
    Lanes none = lanes_and(lanes_at_least(q.x, zero), lanes_at_least(q.y, zero));
    LaneVec found = {lanes_choose(x.x, zero, none), lanes_choose(x.y, zero, none)};

    Lanes second = lanes_sub(zero, lanes_mul(mass2, q.y));
    Lanes apart = lanes_add(lanes_mul(block[1], second), q.x);
    Lanes holds = lanes_and(lanes_at_least(second, zero), lanes_at_least(apart, zero));
    found = (LaneVec){lanes_choose(found.x, zero, holds), lanes_choose(found.y, second, holds)};

    Lanes first = lanes_sub(zero, lanes_mul(mass1, q.x));
    apart = lanes_add(lanes_mul(block[1], first), q.y);
    holds = lanes_and(lanes_at_least(first, zero), lanes_at_least(apart, zero));
    found = (LaneVec){lanes_choose(found.x, first, holds), lanes_choose(found.y, zero, holds)};

    LaneVec both = {lanes_mul(block[3], lanes_sub(lanes_mul(block[1], q.y), lanes_mul(block[2], q.x))),
                    lanes_mul(block[3], lanes_sub(lanes_mul(block[1], q.x), lanes_mul(block[0], q.y)))};
    holds = lanes_and(lanes_at_least(both.x, zero), lanes_at_least(both.y, zero));
    return (LaneVec){lanes_choose(found.x, both.x, holds), lanes_choose(found.y, both.y, holds)};
}

/* Solves both normal impulses together. */
TARGET static inline void solve_normals(Side *a, Side *b, LaneVec n, const LanePoints *points, const Lanes block[4],
                                        Lanes *sum1, Lanes *sum2) {
    const Lanes *masses1 = points->masses[0], *masses2 = points->masses[1];
    LaneVec x = {*sum1, *sum2};
    Lanes v1 = lanes_sub(normal_velocity(a, b, n, points->arms[0]), masses1[2]);
    Lanes v2 = lanes_sub(normal_velocity(a, b, n, points->arms[1]), masses2[2]);
    LaneVec q = {lanes_sub(lanes_sub(v1, lanes_mul(block[0], x.x)), lanes_mul(block[1], x.y)),
                 lanes_sub(lanes_sub(v2, lanes_mul(block[1], x.x)), lanes_mul(block[2], x.y))};
    LaneVec found = solve_cases(block, masses1[0], masses2[0], x, q);
    push(a, b, n, points->arms[0], lanes_sub(found.x, x.x));
    push(a, b, n, points->arms[1], lanes_sub(found.y, x.y));
    *sum1 = found.x;
    *sum2 = found.y;
}

/* Friction at both points. */
TARGET static inline void solve_frictions(Side *a, Side *b, const Surface *surface, const LanePoints *points,
                                          Lanes sums[4]) {
    solve_friction(a, b, surface, points->arms[0], points->masses[0], sums[0], &sums[1]);
    Side single_a = *a, single_b = *b;
    solve_friction(a, b, surface, points->arms[1], points->masses[1], sums[2], &sums[3]);
    keep_where_single(a, &single_a, points->masses[1][3]);
    keep_where_single(b, &single_b, points->masses[1][3]);
}

/* Solves the normal impulses separately. */
TARGET static inline void solve_apart(Side *a, Side *b, const Surface *surface, const LanePoints *points,
                                      Lanes sums[4]) {
    solve_normal(a, b, surface, points->arms[0], points->masses[0], &sums[0]);
    Side single_a = *a, single_b = *b;
    solve_normal(a, b, surface, points->arms[1], points->masses[1], &sums[2]);
    keep_where_single(a, &single_a, points->masses[1][3]);
    keep_where_single(b, &single_b, points->masses[1][3]);
}

TARGET static inline void solve_block_pairs(Sweeps *sweeps, const SweepLevel *level, int lane) {
    SweepPair *records = sweeps->pairs;
    const int32_t *pair = level->pair + lane, *offset_a = level->a + lane, *offset_b = level->b + lane;
    Lanes sums[4], shared[4], block[4];
    LanePoints points;
    load_rows(sums, &records->sums[0].normal, pair);
    load_rows(shared, &records->normal.x, pair);
    load_rows(block, &records->block.k11, pair);
    for (int k = 0; k < 2; k++) {
        load_rows(points.arms[k], &records->points[k].arm_a.x, pair);
        load_rows(points.masses[k], &records->points[k].mass_normal, pair);
    }
    const Surface surface = {{shared[0], shared[1]}, {shared[1], lanes_negate(shared[0])}, shared[2]};
    Side a = load_side(sweeps, offset_a, shared[3]), b = load_side(sweeps, offset_b, points.masses[0][3]);

    solve_frictions(&a, &b, &surface, &points, sums);
    Side apart_a = a, apart_b = b;
    Lanes apart_sums[4] = {sums[0], sums[1], sums[2], sums[3]};
    solve_normals(&a, &b, surface.normal, &points, block, &sums[0], &sums[2]);
    Lanes together = lanes_sub(lanes_zero(), block[3]);
    if (lanes_any_positive(together)) {
        solve_apart(&apart_a, &apart_b, &surface, &points, apart_sums);
        keep_where_single(&a, &apart_a, together);
        keep_where_single(&b, &apart_b, together);
        for (int i = 0; i < 4; i++) sums[i] = lanes_choose(apart_sums[i], sums[i], together);
    }

    store_side(sweeps, offset_a, &a);
    store_side(sweeps, offset_b, &b);
    store_rows(&records->sums[0].normal, pair, sums);
}

TARGET static inline void run_block_levels(Sweeps *sweeps, const SweepSchedule *schedule) {
    for (int i = 0; i < schedule->level_count; i++)
        for (int lane = 0; lane < schedule->filled[i]; lane += LANES)
            solve_block_pairs(sweeps, &schedule->levels[i], lane);
}
