/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints what a comparison of pictures leaves out or accepts without failing. */
#pragma once
#include "report/regression.h"

void compare_print_notes(const Regression *regression);
