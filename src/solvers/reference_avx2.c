/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sweep of the reference, four pairs at a time: operation by operation the text of reference_sweep.c, without fused
   multiply-add, which would round once where that text rounds twice. */
#include "solvers/reference_units.h"

#ifdef __x86_64__

#include <immintrin.h>

#define TARGET __attribute__((target("avx2")))

typedef __m256d Lanes;

/* The bodies at one end of the pairs. */
typedef struct Side {
    Lanes x, y, spin;
} Side;

/* What ReferenceSweep holds, lane by lane. */
typedef struct LaneSweep {
    Lanes squared, along, change;
} LaneSweep;

TARGET static inline Lanes add(Lanes x, Lanes y) { return _mm256_add_pd(x, y); }
TARGET static inline Lanes subtract(Lanes x, Lanes y) { return _mm256_sub_pd(x, y); }
TARGET static inline Lanes multiply(Lanes x, Lanes y) { return _mm256_mul_pd(x, y); }
TARGET static inline Lanes magnitude(Lanes x) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), x); }
TARGET static inline Lanes negative(Lanes x) { return _mm256_xor_pd(_mm256_set1_pd(-0.0), x); }
/* x > y ? x : y and x < y ? x : y, zeros of either sign included. */
TARGET static inline Lanes larger(Lanes x, Lanes y) { return _mm256_max_pd(x, y); }
TARGET static inline Lanes smaller(Lanes x, Lanes y) { return _mm256_min_pd(x, y); }

TARGET static inline Lanes load_two(const double *low, const double *high) {
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(low)), _mm_loadu_pd(high), 1);
}

TARGET static inline void store_two(double *low, double *high, Lanes lanes) {
    _mm_storeu_pd(low, _mm256_castpd256_pd128(lanes));
    _mm_storeu_pd(high, _mm256_extractf128_pd(lanes, 1));
}

TARGET static inline Side load_side(const ReferenceMomentum *momenta, const int *bodies) {
    const ReferenceMomentum *m[] = {&momenta[bodies[0]], &momenta[bodies[1]], &momenta[bodies[2]], &momenta[bodies[3]]};
    Lanes even = load_two(&m[0]->x, &m[2]->x), odd = load_two(&m[1]->x, &m[3]->x);
    Lanes even_spin = load_two(&m[0]->spin, &m[2]->spin), odd_spin = load_two(&m[1]->spin, &m[3]->spin);
    return (Side){_mm256_unpacklo_pd(even, odd), _mm256_unpackhi_pd(even, odd),
                  _mm256_unpacklo_pd(even_spin, odd_spin)};
}

TARGET static inline void store_side(ReferenceMomentum *momenta, const int *bodies, const Side *side) {
    ReferenceMomentum *m[] = {&momenta[bodies[0]], &momenta[bodies[1]], &momenta[bodies[2]], &momenta[bodies[3]]};
    store_two(&m[0]->x, &m[2]->x, _mm256_unpacklo_pd(side->x, side->y));
    store_two(&m[1]->x, &m[3]->x, _mm256_unpackhi_pd(side->x, side->y));
    store_two(&m[0]->spin, &m[2]->spin, _mm256_unpacklo_pd(side->spin, side->spin));
    store_two(&m[1]->spin, &m[3]->spin, _mm256_unpackhi_pd(side->spin, side->spin));
}

TARGET static inline Lanes along_row(const Side *side, const double row[3][REFERENCE_LANES]) {
    Lanes xy = add(multiply(_mm256_loadu_pd(row[0]), side->x), multiply(_mm256_loadu_pd(row[1]), side->y));
    return add(xy, multiply(_mm256_loadu_pd(row[2]), side->spin));
}

TARGET static inline void apply(Side *side, const double row[3][REFERENCE_LANES], Lanes impulse) {
    side->x = add(side->x, multiply(_mm256_loadu_pd(row[0]), impulse));
    side->y = add(side->y, multiply(_mm256_loadu_pd(row[1]), impulse));
    side->spin = add(side->spin, multiply(_mm256_loadu_pd(row[2]), impulse));
}

/* The impulse that would bring the row to its target. */
TARGET static inline Lanes wanted(const Side *a, const Side *b, const ReferenceRow *row, Lanes before) {
    Lanes velocity = add(along_row(a, row->a), along_row(b, row->b));
    return add(before, subtract(_mm256_loadu_pd(row->target), velocity));
}

/* p = p' + beta d and d' = beta d - g. */
TARGET static inline Lanes go_on(Lanes value, Lanes step, double *direction, Lanes beta) {
    Lanes carried = multiply(beta, _mm256_loadu_pd(direction));
    _mm256_storeu_pd(direction, add(carried, step));
    return add(value, carried);
}

TARGET static inline Lanes change_of(Lanes step, const ReferenceRow *row) {
    return multiply(magnitude(step), _mm256_loadu_pd(row->to_velocity));
}

/* Point k of the group's pairs. */
TARGET static inline LaneSweep visit_point(Reference *r, int i, int k, Side *a, Side *b, Lanes beta) {
    const ReferencePoint *point = &r->groups[i].points[k];
    double *d_normal = r->direction[i].normal[k], *d_tangent = r->direction[i].tangent[k];
    double *s_normal = r->steps[i].normal[k], *s_tangent = r->steps[i].tangent[k];
    Lanes normal_before =
        go_on(_mm256_loadu_pd(r->sums_before[i].normal[k]), _mm256_loadu_pd(s_normal), d_normal, beta);
    Lanes tangent_before =
        go_on(_mm256_loadu_pd(r->sums_before[i].tangent[k]), _mm256_loadu_pd(s_tangent), d_tangent, beta);

    Lanes normal = larger(wanted(a, b, &point->normal, normal_before), _mm256_setzero_pd());
    Lanes normal_step = subtract(normal, normal_before);
    apply(a, point->normal.a, normal_step);
    apply(b, point->normal.b, normal_step);

    Lanes limit = multiply(_mm256_loadu_pd(point->friction), normal);
    Lanes tangent = smaller(wanted(a, b, &point->tangent, tangent_before), limit);
    tangent = larger(tangent, negative(limit));
    Lanes tangent_step = subtract(tangent, tangent_before);
    apply(a, point->tangent.a, tangent_step);
    apply(b, point->tangent.b, tangent_step);

    _mm256_storeu_pd(r->sums[i].normal[k], normal);
    _mm256_storeu_pd(r->sums[i].tangent[k], tangent);
    _mm256_storeu_pd(s_normal, normal_step);
    _mm256_storeu_pd(s_tangent, tangent_step);
    return (LaneSweep){
        add(multiply(normal_step, normal_step), multiply(tangent_step, tangent_step)),
        add(multiply(normal_step, _mm256_loadu_pd(d_normal)), multiply(tangent_step, _mm256_loadu_pd(d_tangent))),
        larger(change_of(normal_step, &point->normal), change_of(tangent_step, &point->tangent))};
}

TARGET static inline void go_on_momenta(Reference *r, Lanes beta) {
    for (int i = 0; i < r->body_count; i++) {
        double *now = &r->momenta[i].x, *before = &r->momenta_before[i].x;
        Lanes value = _mm256_loadu_pd(now), step = subtract(value, _mm256_loadu_pd(before));
        value = go_on(value, step, &r->momenta_direction[i].x, beta);
        _mm256_storeu_pd(now, value);
        _mm256_storeu_pd(before, value);
    }
}

TARGET ReferenceSweep reference_sweep_avx2(Reference *r, double factor) {
    Lanes beta = _mm256_set1_pd(factor);
    go_on_momenta(r, beta);
    LaneSweep all = {_mm256_setzero_pd(), _mm256_setzero_pd(), _mm256_setzero_pd()};
    for (int i = 0; i < r->group_count; i++) {
        const ReferenceGroup *group = &r->groups[i];
        Side a = load_side(r->momenta, group->a), b = load_side(r->momenta, group->b);
        LaneSweep first = visit_point(r, i, 0, &a, &b, beta), second = visit_point(r, i, 1, &a, &b, beta);
        store_side(r->momenta, group->a, &a);
        store_side(r->momenta, group->b, &b);
        all.squared = add(all.squared, add(first.squared, second.squared));
        all.along = add(all.along, add(first.along, second.along));
        all.change = larger(larger(first.change, second.change), all.change);
    }
    double squared[4], along[4], change[4];
    _mm256_storeu_pd(squared, all.squared);
    _mm256_storeu_pd(along, all.along);
    _mm256_storeu_pd(change, all.change);
    double low = change[0] > change[1] ? change[0] : change[1], high = change[2] > change[3] ? change[2] : change[3];
    return (ReferenceSweep){(squared[0] + squared[1]) + (squared[2] + squared[3]),
                            (along[0] + along[1]) + (along[2] + along[3]), low > high ? low : high};
}

#else

#include <assert.h>

ReferenceSweep reference_sweep_avx2(Reference *r, double factor) {
    (void)r, (void)factor;
    assert(false);
    return (ReferenceSweep){0, 0, 0};
}

#endif
