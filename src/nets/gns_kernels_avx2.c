/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kernels for AVX2. */
#ifdef TWINBOX_AVX
#define KERNELS gns_kernels_avx2
#define KERNELS_NAME "avx2"
#define ROWS_AT_ONCE 4
#include "nets/gns_kernels_code.h"
#else
typedef int no_kernels_for_this_processor; /* C wants a declaration in a file. */
#endif
