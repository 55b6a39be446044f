/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Regions and names of what changed in a frame. Only regression_frame.c includes this. */
#pragma once
#include "regression/regression.h"

/* Sets `changes` and `other_view` of a frame whose pixels differ. data: the two PNG files, whose texts are read.
   Thread-safe. False with error set if out of memory. */
bool regression_find_changes(Regression *regression, RegressionFrame *frame, uint8_t *const data[SIDES],
                             const Image *const images[SIDES], const uint8_t *masked, Error *error);
