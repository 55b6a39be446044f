/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the options and rules of a comparison mean for a frame: its limits, and the pixels that it ignores. */
#pragma once
#include "regression/regression.h"

/* Reads the rules that the options name, or RULES_NAME in the expected folder if it is there. For folders, each rule must
   match a frame: ERROR_INPUT otherwise. */
bool regression_read_rules(Regression *regression, Error *error);

/* Rules first, then what the options give. */
Tolerance regression_tolerance(const Regression *regression, const RegressionFrame *frame);

/* Whether the masks of a frame of this size could hide all its pixels, or not fit: false is certain, true is not. */
bool regression_may_hide_all(const Regression *regression, const RegressionFrame *frame, int width, int height);

/* Cuts both pictures of a frame to their overlap, and marks in *masked[height, width] what is ignored (image/mask.h):
   masks, and edges if the tolerance says so. *masked is malloc'ed, or NULL if nothing can be ignored. */
bool regression_ignore(const Regression *regression, const RegressionFrame *frame, Image *expected, Image *actual,
                       uint8_t **masked, Error *error);

/* Compares the pictures of regression_ignore(): sets the frame's difference, which is not equal for other sizes. */
void regression_compare(const Regression *regression, RegressionFrame *frame, const Image *expected,
                        const Image *actual, const uint8_t *masked);

/* Sets the frame's verdict on pixels from its difference. Where a limit of FLIP decides, measures FLIP, and for this
   copies what is ignored into the actual picture. */
bool regression_decide(const Regression *regression, RegressionFrame *frame, const Image *expected, Image *actual,
                       const uint8_t *masked, Error *error);

/* Measures FLIP of the first frame that failed by its pixels, from its files, if that has not been done: it is the frame
   that compare names. Only if it has a limit of FLIP: FLIP takes longer than everything else. */
bool regression_measure_first(Regression *regression, Error *error);
