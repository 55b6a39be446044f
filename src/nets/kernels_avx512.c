/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kernels for AVX-512. */
#ifdef TWINBOX_AVX
#define KERNELS kernels_avx512
#define KERNELS_NAME "avx512"
#define VECTOR_BYTES 64
#include "nets/kernels_code.h"
#else
typedef int no_kernels_for_this_processor; /* C wants a declaration in a file. */
#endif
