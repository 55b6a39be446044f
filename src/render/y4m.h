/* SPDX-License-Identifier: GPL-3.0-or-later */
/* YUV4MPEG2, which video programs read from a pipe. 4:4:4, 8 bits, ITU-R BT.709, limited range, each value the nearest to
   the exact one, halves upwards:

     Y = 16 + 219 L, Cb = 128 + 224 (B - L) / 1.8556, Cr = 128 + 224 (R - L) / 1.5748, L = 0.2126 R + 0.7152 G + 0.0722 B

   with R, G, B = channel / 255. The format cannot say that it is BT.709. */
#pragma once
#include "image/image.h"

enum { Y4M_HEADER_SIZE = 128 };

/* The line that a stream begins with. frame_rate in Hz, to a thousandth. */
void y4m_header(char header[Y4M_HEADER_SIZE], int width, int height, double frame_rate);

/* Bytes of a frame with the line that it begins with, and these bytes. */
size_t y4m_frame_size(int width, int height);
void y4m_frame(const Image *image, uint8_t *frame);
