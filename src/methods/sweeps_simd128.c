/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Four lanes of WebAssembly, for the program in a page (live/live.h): the functions of sweeps_avx2.c. */
#ifdef __wasm_simd128__

#include "methods/sweeps.h"

#include <wasm_simd128.h>

#define LANES 4
#define TARGET

typedef v128_t Lanes;

static inline Lanes lanes_zero(void) { return wasm_f32x4_const_splat(0); }
static inline Lanes lanes_all(float x) { return wasm_f32x4_splat(x); }
static inline Lanes lanes_add(Lanes a, Lanes b) { return wasm_f32x4_add(a, b); }
static inline Lanes lanes_sub(Lanes a, Lanes b) { return wasm_f32x4_sub(a, b); }
static inline Lanes lanes_mul(Lanes a, Lanes b) { return wasm_f32x4_mul(a, b); }
static inline Lanes lanes_divide(Lanes a, Lanes b) { return wasm_f32x4_div(a, b); }
/* a > b ? a : b and a < b ? a : b, also for zeros of either sign: pmax(x, y) is x < y ? y : x. */
static inline Lanes lanes_max(Lanes a, Lanes b) { return wasm_f32x4_pmax(b, a); }
static inline Lanes lanes_min(Lanes a, Lanes b) { return wasm_f32x4_pmin(b, a); }
static inline Lanes lanes_negate(Lanes a) { return wasm_f32x4_neg(a); }
/* b where the sign of `by` is negative. */
static inline Lanes lanes_choose(Lanes a, Lanes b, Lanes by) {
    return wasm_v128_bitselect(b, a, wasm_i32x4_shr(by, 31));
}
static inline bool lanes_any_positive(Lanes a) { return wasm_i32x4_bitmask(a) != 0xf; }
static inline void lanes_store(float *to, Lanes a) { wasm_v128_store(to, a); }

#include "methods/sweeps_lanes_code.h"

static inline void sweeps_simd128_transpose(Lanes out[4], const Lanes in[4]) {
    const Lanes low01 = wasm_i32x4_shuffle(in[0], in[1], 0, 4, 1, 5);
    const Lanes high01 = wasm_i32x4_shuffle(in[0], in[1], 2, 6, 3, 7);
    const Lanes low23 = wasm_i32x4_shuffle(in[2], in[3], 0, 4, 1, 5);
    const Lanes high23 = wasm_i32x4_shuffle(in[2], in[3], 2, 6, 3, 7);
    out[0] = wasm_i64x2_shuffle(low01, low23, 0, 2);
    out[1] = wasm_i64x2_shuffle(low01, low23, 1, 3);
    out[2] = wasm_i64x2_shuffle(high01, high23, 0, 2);
    out[3] = wasm_i64x2_shuffle(high01, high23, 1, 3);
}

static inline void load_rows(Lanes out[4], const float *base, const int32_t *offsets) {
    Lanes rows[4];
    for (int i = 0; i < 4; i++) rows[i] = wasm_v128_load(base + offsets[i]);
    sweeps_simd128_transpose(out, rows);
}

static inline void store_rows(float *base, const int32_t *offsets, const Lanes in[4]) {
    Lanes rows[4];
    sweeps_simd128_transpose(rows, in);
    for (int i = 0; i < 4; i++) wasm_v128_store(base + offsets[i], rows[i]);
}

static inline Lanes extrapolated(const float *now, const float *before, const float *factor) {
    const Lanes from = wasm_v128_load(now), change = lanes_sub(wasm_v128_load(before), from);
    return lanes_sub(from, lanes_add(lanes_mul(wasm_v128_load32_splat(factor), change), lanes_zero()));
}

static inline void load_extrapolated(Lanes out[4], const float *base, const int32_t *now, const int32_t *before,
                                     const float *factors, const int32_t *number) {
    Lanes rows[4];
    for (int i = 0; i < 4; i++) rows[i] = extrapolated(base + now[i], base + before[i], factors + number[i]);
    sweeps_simd128_transpose(out, rows);
}

static inline void extrapolate_body(float *base, const SweepBodyTurn *turn, const float *factors) {
    wasm_v128_store(base + turn->to, extrapolated(base + turn->from, base + turn->to, factors + turn->factor));
}

bool sweeps_have_lanes(void) { return true; }

void sweeps_run_lanes(Sweeps *sweeps, const SweepSchedule *schedule, const float *factors) {
    if (factors != NULL)
        run_levels_extrapolating(sweeps, schedule, factors);
    else
        run_levels(sweeps, schedule);
}

void sweeps_residuals_in_lanes(const Sweeps *sweeps, float *squared) { measure_residuals(sweeps, squared); }

void sweeps_overshoots_in_lanes(const Sweeps *sweeps, float *overshoot) { measure_overshoots(sweeps, overshoot); }

#else
typedef int no_lanes_for_this_processor; /* C wants a declaration in a file. */
#endif
