/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures of the differences between two pictures. */
#pragma once
#include "image/flip.h"
#include "image/image.h"
#include "image/indexed_image.h"

/* The expected picture, pale and grey, with differing pixels coloured: yellow for 1, over red, to violet for 255. What
   `masked` ignores (image/mask.h) is hatched if it is masked, and blue if it is a pixel of an edge that differs. Both
   pictures must have the same size. The difference picture has at least this size and is [height, width]; what lies
   beyond both pictures is striped. NULL with error set if out of memory. */
IndexedImage *difference_picture(const Image *expected, const Image *actual, const uint8_t *masked, int width,
                                 int height, Error *error);

/* A picture for values 0 to 1: black over violet and orange to pale yellow. It is black before the sink has had rows.
   NULL with error set if out of memory. */
IndexedImage *heat_picture(int width, int height, Error *error);
FlipSink heat_picture_sink(IndexedImage *picture);
