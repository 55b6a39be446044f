/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chunks of PNG files that change how equal pixels are displayed: the colour space (cICP, iCCP, sRGB, gAMA, cHRM), its
   range (mDCV, cLLI, sBIT), the background (bKGD), the shape and size of a pixel (pHYs) and the orientation in eXIf
   (PNG specification, third edition, sections 11.3.2 to 11.3.4). */
#pragma once
#include "base/base.h"

#include <stddef.h>
#include <stdint.h>

/* "gAMA 0.45455 and none, orientation 1 and 6" */
typedef struct PngDisplay {
    char text[256];
} PngDisplay;

/* Finds what differs between two files; an empty text if nothing does. Each chunk is compared by itself, although some
   viewers ignore gAMA beside iCCP. Colour profiles are compared uncompressed. Both files must be valid up to their
   ends, as png_check() or image_decode_png() finds. False with error set when memory is short. */
bool png_display_compare(const uint8_t *a, size_t a_size, const uint8_t *b, size_t b_size, PngDisplay *display,
                         Error *error);
