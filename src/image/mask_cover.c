/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/mask_cover.h"

static double clamp(double value, double largest) { return value < 0 ? 0 : value > largest ? largest : value; }

static double rectangle_area(const MaskPart *part, double width, double height) {
    double left = clamp(part->x, width), right = clamp((double)part->x + part->width, width);
    double top = clamp(part->y, height), bottom = clamp((double)part->y + part->height, height);
    return (right - left) * (bottom - top);
}

double mask_most_hidden(const Mask *mask, int width, int height) {
    double area = 0;
    for (int i = 0; i < mask->count; i++)
        area += mask->parts[i].kind == MASK_RECTANGLE ? rectangle_area(&mask->parts[i], width, height)
                                                      : (double)width * height;
    return area;
}
