/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where two pictures differ, as a picture. */
#pragma once
#include "image/image.h"

/* The expected picture, grey and pale, and on it what differs: from yellow, by 1, over red to violet, by 255. masked as in
   image_compare_masked(): it is hatched. The pictures have one size. NULL with error set when memory is short. */
Image *difference_picture(const Image *expected, const Image *actual, const uint8_t *masked, Error *error);

/* Numbers from 0 to 1, [height, width], as colours from black over violet and orange to pale yellow. */
Image *heat_picture(const float *values, int width, int height, Error *error);
