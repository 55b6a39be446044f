/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sweep of the reference, four pairs at a time: operation by operation the text of reference_sweep.c, without fused
   multiply-add, which would round once where that text rounds twice. */
#include "reference/reference_units.h"

#ifdef TWINBOX_AVX

#include <immintrin.h>

#define TARGET __attribute__((target("avx2")))
#define INLINE TARGET __attribute__((always_inline)) static inline

typedef __m256d Lanes;

/* The bodies at one end of the pairs. */
typedef struct Side {
    Lanes x, y, spin;
} Side;

/* What ReferenceSweep holds, lane by lane. */
typedef struct LaneSweep {
    Lanes squared, along, change;
} LaneSweep;

INLINE Lanes add(Lanes x, Lanes y) { return _mm256_add_pd(x, y); }
INLINE Lanes subtract(Lanes x, Lanes y) { return _mm256_sub_pd(x, y); }
INLINE Lanes multiply(Lanes x, Lanes y) { return _mm256_mul_pd(x, y); }
INLINE Lanes magnitude(Lanes x) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), x); }
INLINE Lanes negative(Lanes x) { return _mm256_xor_pd(_mm256_set1_pd(-0.0), x); }
/* x > y ? x : y and x < y ? x : y, zeros of either sign included. */
INLINE Lanes larger(Lanes x, Lanes y) { return _mm256_max_pd(x, y); }
INLINE Lanes smaller(Lanes x, Lanes y) { return _mm256_min_pd(x, y); }

INLINE Lanes load_two(const double *low, const double *high) {
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(low)), _mm_loadu_pd(high), 1);
}

INLINE void store_two(double *low, double *high, Lanes lanes) {
    _mm_storeu_pd(low, _mm256_castpd256_pd128(lanes));
    _mm_storeu_pd(high, _mm256_extractf128_pd(lanes, 1));
}

INLINE Side load_side(const ReferenceMomentum *momenta, const int *bodies) {
    const ReferenceMomentum *m[] = {&momenta[bodies[0]], &momenta[bodies[1]], &momenta[bodies[2]], &momenta[bodies[3]]};
    Lanes even = load_two(&m[0]->x, &m[2]->x), odd = load_two(&m[1]->x, &m[3]->x);
    Lanes even_spin = load_two(&m[0]->spin, &m[2]->spin), odd_spin = load_two(&m[1]->spin, &m[3]->spin);
    return (Side){_mm256_unpacklo_pd(even, odd), _mm256_unpackhi_pd(even, odd),
                  _mm256_unpacklo_pd(even_spin, odd_spin)};
}

INLINE void store_side(ReferenceMomentum *momenta, const int *bodies, const Side *side) {
    ReferenceMomentum *m[] = {&momenta[bodies[0]], &momenta[bodies[1]], &momenta[bodies[2]], &momenta[bodies[3]]};
    store_two(&m[0]->x, &m[2]->x, _mm256_unpacklo_pd(side->x, side->y));
    store_two(&m[1]->x, &m[3]->x, _mm256_unpackhi_pd(side->x, side->y));
    store_two(&m[0]->spin, &m[2]->spin, _mm256_unpacklo_pd(side->spin, side->spin));
    store_two(&m[1]->spin, &m[3]->spin, _mm256_unpackhi_pd(side->spin, side->spin));
}

INLINE Lanes along_row(const Side *side, const double row[3][REFERENCE_LANES]) {
    Lanes xy = add(multiply(_mm256_loadu_pd(row[0]), side->x), multiply(_mm256_loadu_pd(row[1]), side->y));
    return add(xy, multiply(_mm256_loadu_pd(row[2]), side->spin));
}

INLINE void apply(Side *side, const double row[3][REFERENCE_LANES], Lanes impulse) {
    side->x = add(side->x, multiply(_mm256_loadu_pd(row[0]), impulse));
    side->y = add(side->y, multiply(_mm256_loadu_pd(row[1]), impulse));
    side->spin = add(side->spin, multiply(_mm256_loadu_pd(row[2]), impulse));
}

/* p = p' + beta d and d' = beta d - g. */
INLINE Lanes go_on(Lanes value, Lanes step, double *direction, Lanes beta) {
    Lanes carried = multiply(beta, _mm256_loadu_pd(direction));
    Lanes tiny = _mm256_set1_pd(reference_floor);
    _mm256_storeu_pd(direction, subtract(add(add(carried, step), tiny), tiny));
    return add(value, carried);
}

/* The impulses of the pairs, in `sums`, and their changes: reference_sweep.c. */
INLINE void solve_pairs(const ReferenceGroup *group, const Lanes *before, const Lanes *wanted, Lanes *sums,
                        Lanes *steps) {
    Lanes limit = _mm256_setzero_pd();
    for (int row = 0, at = 0; row < REFERENCE_ROWS; row++) {
        Lanes total = wanted[row];
        for (int earlier = 0; earlier < row; earlier++)
            total = subtract(total, multiply(_mm256_loadu_pd(group->coupling[at++]), steps[earlier]));
        if (row % 2 == 0) {
            sums[row] = larger(total, _mm256_setzero_pd());
            limit = multiply(_mm256_loadu_pd(group->friction[row / 2]), sums[row]);
        } else {
            sums[row] = larger(smaller(total, limit), negative(limit));
        }
        steps[row] = subtract(sums[row], before[row]);
    }
}

INLINE Lanes sum_four(const Lanes *x) { return add(add(x[0], x[1]), add(x[2], x[3])); }

/* The four pairs of a group. */
INLINE LaneSweep visit(Reference *r, int i, Lanes beta) {
    const ReferenceGroup *group = &r->groups[i];
    Side a = load_side(r->momenta, group->a), b = load_side(r->momenta, group->b);
    Lanes before[REFERENCE_ROWS], wanted[REFERENCE_ROWS], sums[REFERENCE_ROWS], steps[REFERENCE_ROWS];
    Lanes squares[REFERENCE_ROWS], products[REFERENCE_ROWS], change = _mm256_setzero_pd();
    for (int k = 0; k < REFERENCE_ROWS; k++) {
        const ReferenceRow *row = &group->rows[k];
        before[k] = go_on(_mm256_loadu_pd(r->sums_before[i].rows[k]), _mm256_loadu_pd(r->steps[i].rows[k]),
                          r->direction[i].rows[k], beta);
        wanted[k] =
            subtract(add(before[k], _mm256_loadu_pd(row->target)), add(along_row(&a, row->a), along_row(&b, row->b)));
    }
    solve_pairs(group, before, wanted, sums, steps);
    for (int k = 0; k < REFERENCE_ROWS; k++) {
        apply(&a, group->rows[k].a, steps[k]);
        apply(&b, group->rows[k].b, steps[k]);
        _mm256_storeu_pd(r->sums[i].rows[k], sums[k]);
        _mm256_storeu_pd(r->steps[i].rows[k], steps[k]);
        squares[k] = multiply(steps[k], steps[k]);
        products[k] = multiply(steps[k], _mm256_loadu_pd(r->direction[i].rows[k]));
        change = larger(multiply(magnitude(steps[k]), _mm256_loadu_pd(group->rows[k].to_velocity)), change);
    }
    store_side(r->momenta, group->a, &a);
    store_side(r->momenta, group->b, &b);
    return (LaneSweep){sum_four(squares), sum_four(products), change};
}

INLINE void go_on_momenta(Reference *r, Lanes beta) {
    for (int i = 0; i < r->body_count; i++) {
        double *now = &r->momenta[i].x, *before = &r->momenta_before[i].x;
        Lanes value = _mm256_loadu_pd(now), step = subtract(value, _mm256_loadu_pd(before));
        value = go_on(value, step, &r->momenta_direction[i].x, beta);
        _mm256_storeu_pd(now, value);
        _mm256_storeu_pd(before, value);
    }
}

/* The lanes in the order of sum_four. */
INLINE double sum_lanes(Lanes x) {
    double lanes[REFERENCE_LANES];
    _mm256_storeu_pd(lanes, x);
    return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

INLINE double largest_lane(Lanes x) {
    double lanes[REFERENCE_LANES];
    _mm256_storeu_pd(lanes, x);
    double low = lanes[0] > lanes[1] ? lanes[0] : lanes[1], high = lanes[2] > lanes[3] ? lanes[2] : lanes[3];
    return low > high ? low : high;
}

TARGET ReferenceSweep reference_sweep_avx2(Reference *r, double factor) {
    Lanes beta = _mm256_set1_pd(factor);
    go_on_momenta(r, beta);
    LaneSweep all = {_mm256_setzero_pd(), _mm256_setzero_pd(), _mm256_setzero_pd()};
    for (int i = 0; i < r->group_count; i++) {
        LaneSweep found = visit(r, i, beta);
        all.squared = add(all.squared, found.squared);
        all.along = add(all.along, found.along);
        all.change = larger(found.change, all.change);
    }
    return (ReferenceSweep){sum_lanes(all.squared), sum_lanes(all.along), largest_lane(all.change)};
}

#else

#include <assert.h>

ReferenceSweep reference_sweep_avx2(Reference *r, double factor) {
    (void)r, (void)factor;
    assert(false);
    return (ReferenceSweep){0, 0, 0};
}

#endif
