/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The solve for AVX2. */
#ifdef TWINBOX_AVX
#define KERNELS reference_avx2
#include "methods/reference_code.h"
#else
typedef int no_reference_for_this_processor; /* C wants a declaration in a file. */
#endif
