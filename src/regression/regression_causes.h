/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Groups failed frames by cause. Only regression.c includes this. */
#pragma once
#include "regression/regression.h"

/* Fills `causes`. A frame may have several. False with error set if out of memory. */
bool regression_find_causes(Regression *regression, Error *error);
