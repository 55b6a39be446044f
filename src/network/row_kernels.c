/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "network/row_kernels.h"

#include <stddef.h>

void row_kernels_list(const RowKernels *list[ROW_KERNELS_MAX + 1]) {
    int count = 0;
#ifdef TWINBOX_AVX
    if (__builtin_cpu_supports("avx512f")) list[count++] = &row_kernels_avx512;
    if (__builtin_cpu_supports("avx2")) list[count++] = &row_kernels_avx2;
#endif
    list[count++] = &row_kernels_plain;
    list[count] = NULL;
}

const RowKernels *row_kernels_best(void) {
    const RowKernels *list[ROW_KERNELS_MAX + 1];
    row_kernels_list(list);
    return list[0];
}
