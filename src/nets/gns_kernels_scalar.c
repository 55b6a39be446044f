/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kernels for any CPU. */
#define KERNELS gns_kernels_scalar
#define KERNELS_NAME "scalar"
#define ROWS_AT_ONCE 2
#include "nets/gns_kernels_code.h"
