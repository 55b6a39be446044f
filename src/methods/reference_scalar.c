/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The solve for any CPU. */
#define KERNELS reference_scalar
#include "methods/reference_code.h"
