/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The comparison of one frame's pictures. Only regression.c includes this. */
#pragma once
#include "regression/regression.h"

/* Sets what the frame's files alone tell: pixels, states, metadata, changes. Where several pictures are accepted, the first
   that passes counts, or else the closest. Thread-safe. ERROR_INPUT if a file cannot be read. */
bool regression_compare_frame(Regression *regression, RegressionFrame *frame, Error *error);
