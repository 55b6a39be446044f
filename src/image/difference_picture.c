/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/difference_picture.h"

#include "image/image_compare.h"

#include <math.h>

typedef struct Stop {
    double at;
    uint8_t rgb[3];
} Stop;

/* The colour at `at`, 0 to 1, of a gradient. */
static void set_color(const Stop *stops, double at, uint8_t *pixel) {
    while (at > stops[1].at) stops++;
    double share = (at - stops[0].at) / (stops[1].at - stops[0].at);
    for (int c = 0; c < 3; c++)
        pixel[c] = (uint8_t)(stops[0].rgb[c] + share * (stops[1].rgb[c] - stops[0].rgb[c]) + 0.5);
    pixel[3] = 255;
}

/* Readable on a pale background, with steps that remain visible in grey. */
static const Stop differences[] = {{0, {255, 176, 0}}, {0.1, {250, 120, 0}}, {0.4, {214, 24, 48}}, {1, {72, 0, 110}}};
static const Stop heat[] = {
    {0, {0, 0, 4}}, {0.25, {87, 16, 110}}, {0.5, {188, 55, 84}}, {0.75, {249, 142, 9}}, {1, {252, 255, 164}}};

/* Grey in the upper fifth of the scale. */
static void set_pale(const uint8_t *from, uint8_t *pixel) {
    int grey = 200 + (from[0] * 3 + from[1] * 6 + from[2]) / 10 * 55 / 255;
    pixel[0] = pixel[1] = pixel[2] = (uint8_t)grey;
    pixel[3] = 255;
}

Image *difference_picture(const Image *expected, const Image *actual, const uint8_t *masked, Error *error) {
    enum { HATCH = 8 };
    Image *picture = image_create(expected->width, expected->height, error);
    for (int y = 0; picture != NULL && y < picture->height; y++)
        for (int x = 0; x < picture->width; x++) {
            size_t i = (size_t)y * (size_t)picture->width + (size_t)x;
            uint8_t *pixel = picture->pixels + 4 * i;
            bool hidden = masked != NULL && masked[i] != 0;
            int difference = hidden ? 0 : image_pixel_difference(expected, actual, i);
            set_pale(expected->pixels + 4 * i, pixel);
            if (hidden && (x + y) % HATCH == 0)
                pixel[0] = pixel[1] = pixel[2] = 120;
            else if (difference > 0)
                set_color(differences, (difference - 1) / 254.0, pixel);
        }
    return picture;
}

/* Quantised to steps that are hardly visible: the file is a quarter as large. */
Image *heat_picture(const float *values, int width, int height, Error *error) {
    enum { STEPS = 32 };
    Image *picture = image_create(width, height, error);
    size_t pixels = (size_t)width * (size_t)height;
    for (size_t i = 0; picture != NULL && i < pixels; i++) {
        int step = (int)ceilf(values[i] * STEPS); /* only 0 gives step 0 */
        set_color(heat, step < STEPS ? (double)step / STEPS : 1, picture->pixels + 4 * i);
    }
    return picture;
}
