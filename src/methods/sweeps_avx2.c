/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Eight lanes: AVX2, without fused multiply-add, which rounds once where the reference implementation rounds twice. */
#include "methods/sweeps.h"

#ifdef TWINBOX_AVX

#include <immintrin.h>

#define LANES 8
#define TARGET __attribute__((target("avx2")))

typedef __m256 Lanes;

TARGET static inline Lanes lanes_zero(void) { return _mm256_setzero_ps(); }
TARGET static inline Lanes lanes_all(float x) { return _mm256_set1_ps(x); }
TARGET static inline Lanes lanes_add(Lanes a, Lanes b) { return _mm256_add_ps(a, b); }
TARGET static inline Lanes lanes_sub(Lanes a, Lanes b) { return _mm256_sub_ps(a, b); }
TARGET static inline Lanes lanes_mul(Lanes a, Lanes b) { return _mm256_mul_ps(a, b); }
TARGET static inline Lanes lanes_divide(Lanes a, Lanes b) { return _mm256_div_ps(a, b); }
/* a > b ? a : b and a < b ? a : b, also for zeros of either sign. */
TARGET static inline Lanes lanes_max(Lanes a, Lanes b) { return _mm256_max_ps(a, b); }
TARGET static inline Lanes lanes_min(Lanes a, Lanes b) { return _mm256_min_ps(a, b); }
TARGET static inline Lanes lanes_negate(Lanes a) { return _mm256_xor_ps(a, _mm256_set1_ps(-0.0f)); }
/* b where the sign of `by` is negative. */
TARGET static inline Lanes lanes_choose(Lanes a, Lanes b, Lanes by) { return _mm256_blendv_ps(a, b, by); }
TARGET static inline bool lanes_any_positive(Lanes a) { return _mm256_movemask_ps(a) != 0xff; }
TARGET static inline void lanes_store(float *to, Lanes a) { _mm256_storeu_ps(to, a); }

#include "methods/sweeps_lanes_code.h"

TARGET static inline Lanes load_two(const float *low, const float *high) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(low)), _mm_loadu_ps(high), 1);
}

TARGET static inline Lanes all_of_two(const float *low, const float *high) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_broadcast_ss(low)), _mm_broadcast_ss(high), 1);
}

TARGET static inline void store_two(float *low, float *high, Lanes rows) {
    _mm_storeu_ps(low, _mm256_castps256_ps128(rows));
    _mm_storeu_ps(high, _mm256_extractf128_ps(rows, 1));
}

/* A 4 x 4 transpose in each half. */
TARGET static inline void transpose(Lanes out[4], const Lanes in[4]) {
    Lanes low01 = _mm256_unpacklo_ps(in[0], in[1]), high01 = _mm256_unpackhi_ps(in[0], in[1]);
    Lanes low23 = _mm256_unpacklo_ps(in[2], in[3]), high23 = _mm256_unpackhi_ps(in[2], in[3]);
    out[0] = _mm256_shuffle_ps(low01, low23, 0x44);
    out[1] = _mm256_shuffle_ps(low01, low23, 0xee);
    out[2] = _mm256_shuffle_ps(high01, high23, 0x44);
    out[3] = _mm256_shuffle_ps(high01, high23, 0xee);
}

TARGET static inline void load_rows(Lanes out[4], const float *base, const int32_t *offsets) {
    Lanes rows[4];
    for (int i = 0; i < 4; i++) rows[i] = load_two(base + offsets[i], base + offsets[i + 4]);
    transpose(out, rows);
}

TARGET static inline void store_rows(float *base, const int32_t *offsets, const Lanes in[4]) {
    Lanes rows[4];
    transpose(rows, in);
    for (int i = 0; i < 4; i++) store_two(base + offsets[i], base + offsets[i + 4], rows[i]);
}

TARGET static inline void load_extrapolated(Lanes out[4], const float *base, const int32_t *now, const int32_t *before,
                                            const float *factors, const int32_t *number) {
    Lanes rows[4];
    for (int i = 0; i < 4; i++) {
        Lanes from = load_two(base + now[i], base + now[i + 4]);
        Lanes change = lanes_sub(load_two(base + before[i], base + before[i + 4]), from);
        Lanes step = lanes_mul(all_of_two(factors + number[i], factors + number[i + 4]), change);
        rows[i] = lanes_sub(from, lanes_add(step, lanes_zero()));
    }
    transpose(out, rows);
}

TARGET static inline void extrapolate_body(float *base, const SweepBodyTurn *turn, const float *factors) {
    __m128 from = _mm_loadu_ps(base + turn->from);
    __m128 step = _mm_mul_ps(_mm_broadcast_ss(factors + turn->factor), _mm_sub_ps(_mm_loadu_ps(base + turn->to), from));
    _mm_storeu_ps(base + turn->to, _mm_sub_ps(from, _mm_add_ps(step, _mm_setzero_ps())));
}

bool sweeps_have_lanes(void) { return __builtin_cpu_supports("avx2"); }

TARGET void sweeps_run_lanes(Sweeps *sweeps, const SweepSchedule *schedule, const float *factors) {
    if (factors != NULL)
        run_levels_extrapolating(sweeps, schedule, factors);
    else
        run_levels(sweeps, schedule);
}

TARGET void sweeps_residuals_in_lanes(const Sweeps *sweeps, float *squared) { measure_residuals(sweeps, squared); }

TARGET void sweeps_overshoots_in_lanes(const Sweeps *sweeps, float *overshoot) {
    measure_overshoots(sweeps, overshoot);
}

#elif !defined(__wasm_simd128__) /* sweeps_simd128.c */

#include <assert.h>

bool sweeps_have_lanes(void) { return false; }

void sweeps_run_lanes(Sweeps *sweeps, const SweepSchedule *schedule, const float *factors) {
    (void)sweeps, (void)schedule, (void)factors;
    assert(false);
}

void sweeps_residuals_in_lanes(const Sweeps *sweeps, float *squared) {
    (void)sweeps, (void)squared;
    assert(false);
}

void sweeps_overshoots_in_lanes(const Sweeps *sweeps, float *overshoot) {
    (void)sweeps, (void)overshoot;
    assert(false);
}

#endif
