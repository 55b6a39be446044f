/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A pair of bodies in each lane of a vector: eight lanes in files that are compiled for AVX2, else four, as all other
   processors and WebAssembly have them. Operations have the bits of the scalar ones. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#ifdef __AVX2__
#include <immintrin.h>

enum { LANES = 8 };
#else
enum { LANES = 4 };
#endif

typedef float Lanes __attribute__((vector_size(LANES * sizeof(float))));
typedef int32_t LaneMask __attribute__((vector_size(LANES * sizeof(int32_t))));

/* Four floats that follow each other in memory. */
typedef float Row __attribute__((vector_size(4 * sizeof(float)), aligned(sizeof(float)), may_alias));

static inline Lanes lanes_where(LaneMask mask, Lanes a, Lanes b) {
    return (Lanes)((mask & (LaneMask)a) | (~mask & (LaneMask)b));
}
static inline Lanes lanes_abs(Lanes a) { return (Lanes)((LaneMask)a & INT32_MAX); }

/* b where the sign of `by` is negative; a > b ? a : b and a < b ? a : b, also for zeros of either sign. Each is one
   instruction of AVX, where GCC 12 takes two or three for the general form: a tenth of a sweep's time. */
#ifdef __AVX2__
static inline Lanes lanes_choose(Lanes a, Lanes b, Lanes by) { return _mm256_blendv_ps(a, b, by); }
static inline Lanes lanes_max(Lanes a, Lanes b) { return _mm256_max_ps(a, b); }
static inline Lanes lanes_min(Lanes a, Lanes b) { return _mm256_min_ps(a, b); }
static inline bool lanes_any_positive(Lanes a) { return _mm256_movemask_ps(a) != 0xff; }
#else
static inline Lanes lanes_choose(Lanes a, Lanes b, Lanes by) { return lanes_where((LaneMask)by < 0, b, a); }
static inline Lanes lanes_max(Lanes a, Lanes b) { return lanes_where(a > b, a, b); }
static inline Lanes lanes_min(Lanes a, Lanes b) { return lanes_where(a < b, a, b); }
static inline bool lanes_any_positive(Lanes a) {
    const LaneMask positive = (LaneMask)a >= 0;
    return (positive[0] | positive[1] | positive[2] | positive[3]) != 0;
}
#endif

/* As contact_clamp(). */
static inline Lanes lanes_clamp(Lanes x, Lanes low, Lanes high) { return lanes_max(low, lanes_min(x, high)); }

/* In each four lanes: those of a (0 to 3) and b (4 to 7) that the numbers name. */
#ifdef __AVX2__
#define LANE_OF(i) ((i) < 4 ? (i) : (i) + 4)
#define LANES_OF(a, b, i, j, k, l)                                                                                \
    __builtin_shufflevector(a, b, LANE_OF(i), LANE_OF(j), LANE_OF(k), LANE_OF(l), LANE_OF(i) + 4, LANE_OF(j) + 4, \
                            LANE_OF(k) + 4, LANE_OF(l) + 4)
#else
#define LANES_OF(a, b, i, j, k, l) __builtin_shufflevector(a, b, i, j, k, l)
#endif

/* A transpose of each 4 x 4. */
static inline void transpose(Lanes out[4], const Lanes in[4]) {
    const Lanes low01 = LANES_OF(in[0], in[1], 0, 4, 1, 5), high01 = LANES_OF(in[0], in[1], 2, 6, 3, 7);
    const Lanes low23 = LANES_OF(in[2], in[3], 0, 4, 1, 5), high23 = LANES_OF(in[2], in[3], 2, 6, 3, 7);
    out[0] = LANES_OF(low01, low23, 0, 1, 4, 5);
    out[1] = LANES_OF(low01, low23, 2, 3, 6, 7);
    out[2] = LANES_OF(high01, high23, 0, 1, 4, 5);
    out[3] = LANES_OF(high01, high23, 2, 3, 6, 7);
}

static inline Row *row_at(float *base, int32_t offset) { return (Row *)(base + offset); }
static inline Row row_of(const float *base, int32_t offset) { return *(const Row *)(base + offset); }
static inline Row row_all(float x) { return (Row){x, x, x, x}; }

/* One row, or with eight lanes this one and the one of four lanes further, which AVX inserts while it loads. */
#ifdef __AVX2__
static inline Lanes lanes_join(Row low, Row high) { return _mm256_insertf128_ps(_mm256_castps128_ps256(low), high, 1); }
static inline Lanes lanes_load(const float *base, const int32_t *at) {
    return lanes_join(row_of(base, at[0]), row_of(base, at[4]));
}
static inline Lanes lanes_all(const float *factors, const int32_t *number) {
    return lanes_join(row_all(factors[number[0]]), row_all(factors[number[4]]));
}
static inline void lanes_store(float *base, const int32_t *at, Lanes rows) {
    *row_at(base, at[0]) = ((const Row *)&rows)[0];
    *row_at(base, at[4]) = ((const Row *)&rows)[1];
}
#else
static inline Lanes lanes_load(const float *base, const int32_t *at) { return row_of(base, at[0]); }
static inline Lanes lanes_all(const float *factors, const int32_t *number) { return row_all(factors[number[0]]); }
static inline void lanes_store(float *base, const int32_t *at, Lanes rows) { *row_at(base, at[0]) = rows; }
#endif

/* `base` is a row of four floats in the first record, `offsets` those of the lanes' rows, in floats; out[k] gets the
   k-th float of each row. */
static inline void load_rows(Lanes out[4], const float *base, const int32_t *offsets) {
    Lanes rows[4];
    for (int i = 0; i < 4; i++) rows[i] = lanes_load(base, offsets + i);
    transpose(out, rows);
}

static inline void store_rows(float *base, const int32_t *offsets, const Lanes in[4]) {
    Lanes rows[4];
    transpose(rows, in);
    for (int i = 0; i < 4; i++) lanes_store(base, offsets + i, rows[i]);
}

/* Velocities of the bodies at one end of the pairs, one pair per lane. */
typedef struct Side {
    Lanes x, y, spin, inv_mass, inv_inertia;
} Side;

/* A quantity with two components. */
typedef struct LaneVec {
    Lanes x, y;
} LaneVec;

static inline Lanes dot(LaneVec a, LaneVec b) { return a.x * b.x + a.y * b.y; }
static inline Lanes cross(LaneVec a, LaneVec b) { return a.x * b.y - a.y * b.x; }
static inline LaneVec scaled(Lanes by, LaneVec a) { return (LaneVec){by * a.x, by * a.y}; }

/* Applies impulse to b and its opposite to a. */
static inline void apply(Side *a, Side *b, LaneVec arm_a, LaneVec arm_b, LaneVec impulse) {
    a->x -= a->inv_mass * impulse.x;
    a->y -= a->inv_mass * impulse.y;
    a->spin -= a->inv_inertia * cross(arm_a, impulse);
    b->x += b->inv_mass * impulse.x;
    b->y += b->inv_mass * impulse.y;
    b->spin += b->inv_inertia * cross(arm_b, impulse);
}

/* bodies: the rows, each of a velocity and the inverse mass; offsets: those of the lanes' bodies, in floats. */
static inline Side load_side(const float *bodies, const int32_t *offsets, Lanes inv_inertia) {
    Lanes rows[4];
    load_rows(rows, bodies, offsets);
    return (Side){rows[0], rows[1], rows[2], rows[3], inv_inertia};
}

static inline void store_side(float *bodies, const int32_t *offsets, const Side *side) {
    const Lanes rows[4] = {side->x, side->y, side->spin, side->inv_mass};
    store_rows(bodies, offsets, rows);
}

/* Selects the velocities after the second point for pairs that have one, else those before. */
static inline void keep_where_single(Side *after, const Side *before, Lanes second) {
    after->x = lanes_choose(before->x, after->x, second);
    after->y = lanes_choose(before->y, after->y, second);
    after->spin = lanes_choose(before->spin, after->spin, second);
}

/* levels[count]: the number of visits of each, replaced by the lane of its first visit. Each level begins with new
   lanes. Returns the number of lanes. */
static inline int lanes_of_levels(int *levels, int count) {
    int lanes = 0;
    for (int i = 0; i < count; i++) {
        const int visits = levels[i];
        levels[i] = lanes;
        lanes += (visits + LANES - 1) / LANES * LANES;
    }
    return lanes;
}
