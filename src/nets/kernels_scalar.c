/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kernels for any CPU. */
#define KERNELS kernels_scalar
#define KERNELS_NAME "scalar"
#define VECTOR_BYTES 16
#include "nets/kernels_code.h"
