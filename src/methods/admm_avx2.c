/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kernels for AVX2. */
#ifdef TWINBOX_AVX
#define KERNELS admm_avx2
#define KERNELS_NAME "avx2"
#include "methods/admm_code.h"
#else
typedef int no_kernels_for_this_processor; /* C wants a declaration in a file. */
#endif
