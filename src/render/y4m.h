/* SPDX-License-Identifier: GPL-3.0-or-later */
/* YUV4MPEG2, a format that video programs read from a pipe. 4:4:4, 8 bits, ITU-R BT.709, limited range, exact
   values rounded to nearest, halves up:

     Y = 16 + 219 L, Cb = 128 + 224 (B - L) / 1.8556, Cr = 128 + 224 (R - L) / 1.5748, L = 0.2126 R + 0.7152 G + 0.0722 B

   with R, G, B = channel / 255. The format has no field that marks BT.709. */
#pragma once
#include "image/image.h"

enum { Y4M_HEADER_SIZE = 128 };

/* The header line of a stream. frame_rate in Hz, to a thousandth. */
void y4m_header(char header[Y4M_HEADER_SIZE], int width, int height, double frame_rate);

/* Size in bytes of a frame with its header line, and the frame itself. */
size_t y4m_frame_size(int width, int height);
void y4m_frame(const Image *image, uint8_t *frame);
