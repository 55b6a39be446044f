/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints the result of a comparison of pictures. */
#pragma once
#include "regression/regression.h"

void compare_print(const Regression *regression);
