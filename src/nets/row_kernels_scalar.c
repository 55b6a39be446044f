/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The row kernels for any processor. */
#define ROW_KERNELS row_kernels_scalar
#define ROW_KERNELS_NAME "scalar"
#define VECTOR_BYTES 16
#include "nets/row_kernels_code.h"
