/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The filter of FLIP for AVX2. */
#ifdef TWINBOX_AVX
#define FLIP_FILTER flip_filter_avx2
#define VECTOR_BYTES 32
#include "regression/flip_filter_code.h"
#else
typedef int no_flip_filter_for_this_processor; /* C wants a declaration in a file. */
#endif
