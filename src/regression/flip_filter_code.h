/* SPDX-License-Identifier: GPL-3.0-or-later */
/* flip_filter() as FLIP_FILTER for vectors of VECTOR_BYTES. Lanes do not mix, so every width gives the same bits. */
#include "regression/flip.h"

#include <string.h>

typedef float Vector __attribute__((vector_size(VECTOR_BYTES)));
enum { LANES = VECTOR_BYTES / sizeof(float), VECTORS = FLIP_BLOCK / LANES };

/* One load: a copy of several vectors would go through memory. */
static inline Vector load(const float *from) {
    Vector vector;
    memcpy(&vector, from, sizeof vector);
    return vector;
}

/* The sums of a block stay in registers over all weights. */
static inline void filter_block(const float *from, const FlipKernel *kernel, size_t step, float *to) {
    Vector sums[VECTORS];
    for (int i = 0; i < VECTORS; i++) sums[i] = (Vector){0};
    for (int k = 0; k <= 2 * kernel->radius; k++, from += step)
        for (int i = 0; i < VECTORS; i++) sums[i] += kernel->weights[k] * load(from + i * LANES);
    for (int i = 0; i < VECTORS; i++) memcpy(to + i * LANES, &sums[i], sizeof sums[i]);
}

void FLIP_FILTER(const float *from, const FlipKernel *kernel, size_t step, size_t stride, int width, int height,
                 float *to) {
    for (int y = 0; y < height; y++, from += stride, to += stride)
        for (int x = 0; x < width; x += FLIP_BLOCK) filter_block(from + x, kernel, step, to + x);
}
