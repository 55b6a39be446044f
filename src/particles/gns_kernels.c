/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "particles/gns_kernels.h"

#include <stddef.h>

void gns_kernels_list(const GnsKernels *list[GNS_KERNELS_MAX + 1]) {
    int count = 0;
#ifdef TWINBOX_AVX
    if (__builtin_cpu_supports("avx2")) list[count++] = &gns_kernels_avx2;
#endif
    list[count++] = &gns_kernels_scalar;
    list[count] = NULL;
}

const GnsKernels *gns_kernels_best(void) {
    const GnsKernels *list[GNS_KERNELS_MAX + 1];
    gns_kernels_list(list);
    return list[0];
}
