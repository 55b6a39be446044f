/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures of the differences between two pictures. */
#pragma once
#include "image/image.h"

/* The expected picture, pale and grey, with differing pixels coloured: yellow for 1, over red, to violet for 255.
   Masked pixels (see image/image_compare.h) are hatched. Both pictures must have the same size. NULL with error set
   if out of memory. */
Image *difference_picture(const Image *expected, const Image *actual, const uint8_t *masked, Error *error);

/* Values 0 to 1, [height, width], as colours from black over violet and orange to pale yellow. */
Image *heat_picture(const float *values, int width, int height, Error *error);
