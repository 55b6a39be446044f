/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The filter of FLIP for the baseline instruction set. */
#define FLIP_FILTER flip_filter_baseline
#define VECTOR_BYTES 16
#include "regression/flip_filter_code.h"
