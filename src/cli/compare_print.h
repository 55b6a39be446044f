/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a comparison of pictures found, on standard output. */
#pragma once
#include "report/regression.h"

void compare_print(const Regression *regression);
