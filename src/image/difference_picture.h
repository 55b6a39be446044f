/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures of the differences between two pictures. */
#pragma once
#include "image/flip.h"
#include "image/image.h"
#include "image/indexed_png.h"

/* The expected picture, pale and grey, with differing pixels coloured: yellow for 1, over red, to violet for 255. What
   `masked` ignores (image/mask.h) is hatched if it is masked, and blue if it is a pixel of an edge that differs. Both
   pictures must have the same size. The difference picture has [height, width] and at least this size; what lies beyond
   both pictures is striped. A PNG file, malloc'ed; NULL with error set if out of memory. */
uint8_t *difference_picture(const Image *expected, const Image *actual, const uint8_t *masked, int width, int height,
                            size_t *size, Error *error);

/* A picture of values 0 to 1, black over violet and orange to pale yellow, whose rows come through the sink. NULL with
   error set if out of memory. */
IndexedPng *heat_picture(int width, int height, Error *error);
FlipSink heat_picture_sink(IndexedPng *picture);
