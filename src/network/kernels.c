/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "network/kernels.h"

void kernels_list(const Kernels *list[KERNELS_MAX + 1]) {
    int count = 0;
#ifdef TWINBOX_AVX
    if (__builtin_cpu_supports("avx512f")) list[count++] = &kernels_avx512;
    if (__builtin_cpu_supports("avx2")) list[count++] = &kernels_avx2;
#endif
    list[count++] = &kernels_plain;
    list[count] = NULL;
}

const Kernels *kernels_best(void) {
    const Kernels *list[KERNELS_MAX + 1];
    kernels_list(list);
    return list[0];
}
