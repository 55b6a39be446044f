/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kernels for any CPU. */
#define KERNELS admm_scalar
#define KERNELS_NAME "scalar"
#include "methods/admm_code.h"
