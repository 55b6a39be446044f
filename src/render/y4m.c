/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/y4m.h"

#include "render/divisor.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char frame_line[] = "FRAME\n";
enum { FRAME_LINE_SIZE = sizeof frame_line - 1 };

void y4m_header(char header[Y4M_HEADER_SIZE], int width, int height, double frame_rate) {
    const int64_t rate = (int64_t)(1000 * frame_rate + 0.5), divisor = greatest_divisor(rate, 1000);
    snprintf(header, Y4M_HEADER_SIZE, "YUV4MPEG2 W%d H%d F%" PRId64 ":%" PRId64 " Ip A1:1 C444 XCOLORRANGE=LIMITED\n",
             width, height, rate / divisor, 1000 / divisor);
}

size_t y4m_frame_size(int width, int height) { return FRAME_LINE_SIZE + 3 * (size_t)width * (size_t)height; }

/* a / b rounded to the nearest integer; b > 0 and even. */
static int nearest(int a, int b) { return (a + b / 2 + 256 * b) / b - 256; }

void y4m_frame(const Image *image, uint8_t *frame) {
    size_t pixels = (size_t)image->width * (size_t)image->height;
    uint8_t *y = (uint8_t *)memcpy(frame, frame_line, FRAME_LINE_SIZE) + FRAME_LINE_SIZE, *cb = y + pixels,
            *cr = cb + pixels;
    for (size_t i = 0; i < pixels; i++) {
        const uint8_t *rgb = image->pixels + 4 * i;
        /* In 1/10000 of a channel's step. */
        int light = 2126 * rgb[0] + 7152 * rgb[1] + 722 * rgb[2];
        y[i] = (uint8_t)(16 + nearest(219 * light, 255 * 10000));
        cb[i] = (uint8_t)(128 + nearest(224 * (10000 * rgb[2] - light), 255 * 18556));
        cr[i] = (uint8_t)(128 + nearest(224 * (10000 * rgb[0] - light), 255 * 15748));
    }
}
