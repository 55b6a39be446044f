/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kernels for any CPU. */
#define KERNELS interior_scalar
#define KERNELS_NAME "scalar"
#include "methods/interior_code.h"
