/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops over rows, compiled once for each instruction set (see CMakeLists.txt) from kernels_code.h. All perform the
   same operations in the same order, so they have the same bits; the widest that the CPU supports is used. */
#pragma once
#include "network/network_gradient.h"

/* Rows of a batch that pass the layers together: 2 x 10 x 64 numbers stay in the L1 cache. */
enum { TILE_ROWS = 64, CACHE_LINE = 64 };

typedef struct Kernels {
    const char *name;
    /* Rows first to first + count - 1, at most TILE_ROWS, of a batch: network_predict_batch(). */
    void (*predict)(const Network *network, const float *inputs, float *scratch, float *outputs, int rows, int first,
                    int count);
    /* network_gradient.h */
    void (*forward)(NetworkBlock *block, const double *parameters);
    void (*backward)(NetworkBlock *block, const double *parameters);
    void (*backward_to_inputs)(const NetworkBlock *block, const double *parameters, double *slopes);
    void (*add_gradient)(const NetworkBlock *block, double *gradient);
    double (*dot)(const double *a, const double *b);
} Kernels;

extern const Kernels kernels_scalar, kernels_avx2, kernels_avx512;

/* The kernels that this CPU supports, widest first; ends with NULL. */
enum { KERNELS_MAX = 3 };
void kernels_list(const Kernels *list[KERNELS_MAX + 1]);

/* The first of the list. */
const Kernels *kernels_best(void);
