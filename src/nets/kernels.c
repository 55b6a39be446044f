/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops that this CPU can run, and rows rounded to bytes. */
#include "nets/kernels.h"

void kernels_list(const Kernels *list[KERNELS_MAX + 1]) {
    int count = 0;
#ifdef TWINBOX_AVX
    if (__builtin_cpu_supports("avx512f")) list[count++] = &kernels_avx512;
    if (__builtin_cpu_supports("avx2")) list[count++] = &kernels_avx2;
#endif
    list[count++] = &kernels_scalar;
    list[count] = NULL;
}

const Kernels *kernels_best(void) {
    const Kernels *list[KERNELS_MAX + 1];
    kernels_list(list);
    return list[0];
}

enum { STEPS = INT8_MAX };

static const float nothing =
    1e-30f; /* a row with no larger number becomes 0, because the reciprocal of its unit is infinite */

size_t packed_rows_bytes(int count, int width) { return (size_t)count * ((size_t)width + sizeof(float)); }

PackedRows packed_rows_in(void *block, int count, int width) {
    return (PackedRows){count, width, block != NULL ? (int8_t *)((float *)block + count) : NULL, block};
}

void packed_rows_fill(PackedRows *packed, const float *rows) {
    for (int64_t i = 0; i < packed->count; i++) {
        const float *row = rows + i * packed->width;
        int8_t *numbers = packed->numbers + i * packed->width;
        float most = 0;
        for (int k = 0; k < packed->width; k++) most = fabsf(row[k]) > most ? fabsf(row[k]) : most;
        const float steps = most > nothing ? STEPS / most : 0;
        packed->units[i] = most > nothing ? most / STEPS : 0;
        for (int k = 0; k < packed->width; k++) {
            const float number = row[k] * steps;
            numbers[k] = (int8_t)(number + (number < 0 ? -0.5f : 0.5f)); /* the nearest */
        }
    }
}
