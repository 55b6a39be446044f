/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The row kernels for AVX2. */
#ifdef TWINBOX_AVX
#define ROW_KERNELS row_kernels_avx2
#define ROW_KERNELS_NAME "avx2"
#define VECTOR_BYTES 32
#include "nets/row_kernels_code.h"
#else
typedef int no_row_kernels_for_this_processor; /* C wants a declaration in a file. */
#endif
