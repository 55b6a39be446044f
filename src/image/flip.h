/* SPDX-License-Identifier: GPL-3.0-or-later */
/* FLIP, how large a difference between two pictures looks when one flips to the other and back: Andersson, Nilsson,
   Akenine-Moeller, Oskarsson, Astroem, Fairchild, "FLIP: A Difference Evaluator for Alternating Images", HPG 2020
   (doi:10.1145/3406183), the version for pictures of 8 bits.

   Colours are blurred by what the eye no longer tells apart at this distance, and compared in a space where equal
   distances look alike; where edges or points differ, the difference weighs more. */
#pragma once
#include "image/image.h"

/* Pixels a degree: a screen of 0.7 m and 3840 pixels, seen from 0.7 m. The paper's. */
#define FLIP_PIXELS_PER_DEGREE 67.02064327658225

/* Of two pictures of one size, over white where they are transparent: the mean over all pixels, 0 (equal) to 1. map, NULL
   or [height, width], gets that of each pixel. False with error set when memory is short. */
bool flip_compare(const Image *expected, const Image *actual, double pixels_per_degree, float *map, double *mean,
                  Error *error);
