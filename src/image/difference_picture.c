/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/difference_picture.h"

#include "image/image_compare.h"
#include "image/mask.h"

#include <math.h>
#include <string.h>

typedef struct Stop {
    double at;
    uint8_t rgb[3];
} Stop;

/* Readable on a pale background, with steps that remain visible in grey. */
static const Stop differences[] = {{0, {255, 176, 0}}, {0.1, {250, 120, 0}}, {0.4, {214, 24, 48}}, {1, {72, 0, 110}}};
static const Stop heat[] = {
    {0, {0, 0, 4}}, {0.25, {87, 16, 110}}, {0.5, {188, 55, 84}}, {0.75, {249, 142, 9}}, {1, {252, 255, 164}}};

/* Adds `count` colours of a gradient to the palette, from its start to its end. */
static void add_gradient(IndexedImage *picture, const Stop *stops, int count) {
    for (int i = 0; i < count; i++) {
        double at = (double)i / (count - 1);
        while (at > stops[1].at) stops++;
        double share = (at - stops[0].at) / (stops[1].at - stops[0].at);
        uint8_t *rgb = picture->palette[picture->colors++];
        for (int c = 0; c < 3; c++)
            rgb[c] = (uint8_t)(stops[0].rgb[c] + share * (stops[1].rgb[c] - stops[0].rgb[c]) + 0.5);
    }
}

static void add_grey(IndexedImage *picture, int grey) { memset(picture->palette[picture->colors++], grey, 3); }

/* The palette of differences: greys in the upper fifth of the scale, the hatch, ignored edges, the stripes beyond the
   pictures, and the gradient. */
enum { PALEST = 200, PALE = 56, HATCHED = PALE, EDGE, BEYOND, GRADIENT, STEPS = 256 - GRADIENT };
enum { HATCH_GREY = 120, HATCH = 8 };
static const uint8_t edge_color[3] = {70, 150, 235}, beyond_color[3] = {150, 120, 175};

static uint8_t pale(const uint8_t *from) { return (uint8_t)((from[0] * 3 + from[1] * 6 + from[2]) / 10 * 55 / 255); }

/* From 1 to 255. */
static uint8_t gradient_of(int difference) {
    return (uint8_t)(GRADIENT + ((difference - 1) * (STEPS - 1) + 127) / 254);
}

/* Neighbours are often equal, and most pixels are equal in both pictures. */
static void draw_row(const Image *expected, const Image *actual, int y, const uint8_t *masked, uint8_t *row) {
    size_t first = (size_t)y * (size_t)expected->width;
    const uint8_t *p = expected->pixels + 4 * first, *q = actual->pixels + 4 * first;
    bool deep = expected->pixels16 != NULL || actual->pixels16 != NULL;
    uint8_t grey = 0;
    for (int x = 0; x < expected->width; x++, p += 4, q += 4) {
        size_t i = first + (size_t)x;
        if (x == 0 || memcmp(p, p - 4, 4) != 0) grey = pale(p);
        row[x] = grey;
        Ignored ignored = masked != NULL ? (Ignored)masked[i] : IGNORED_NOT;
        if (ignored == IGNORED_EDGE) {
            row[x] = EDGE;
        } else if (ignored == IGNORED_MASK) {
            if ((x + y) % HATCH == 0) row[x] = HATCHED;
        } else if (deep || memcmp(p, q, 4) != 0) {
            int difference = image_pixel_difference(expected, actual, i);
            if (difference > 0) row[x] = gradient_of(difference);
        }
    }
}

static void draw_beyond(int first, int width, int y, uint8_t *row) {
    for (int x = first; x < width; x++) row[x] = (x + y) / (HATCH / 2) % 2 == 0 ? BEYOND : PALE - 1;
}

IndexedImage *difference_picture(const Image *expected, const Image *actual, const uint8_t *masked, int width,
                                 int height, Error *error) {
    IndexedImage *picture = indexed_image_create(width, height, error);
    if (picture == NULL) return NULL;
    for (int i = 0; i < PALE; i++) add_grey(picture, PALEST + i);
    add_grey(picture, HATCH_GREY);
    memcpy(picture->palette[picture->colors++], edge_color, sizeof edge_color);
    memcpy(picture->palette[picture->colors++], beyond_color, sizeof beyond_color);
    add_gradient(picture, differences, STEPS);
    for (int y = 0; y < height; y++) {
        uint8_t *row = indexed_image_row(picture, y);
        bool inside = y < expected->height;
        if (inside) draw_row(expected, actual, y, masked, row);
        draw_beyond(inside ? expected->width : 0, width, y, row);
    }
    return picture;
}

/* Steps that are hardly visible make a smaller file. */
enum { HEAT_STEPS = 32 };

IndexedImage *heat_picture(int width, int height, Error *error) {
    IndexedImage *picture = indexed_image_create(width, height, error);
    if (picture != NULL) add_gradient(picture, heat, HEAT_STEPS + 1);
    return picture;
}

/* Only 0 gives step 0. */
static bool heat_row(void *context, int y, const float *values, Error *error) {
    IndexedImage *picture = context;
    uint8_t *row = indexed_image_row(picture, y);
    (void)error;
    for (int x = 0; x < picture->width; x++) {
        int step = (int)ceilf(values[x] * HEAT_STEPS);
        row[x] = (uint8_t)(step < HEAT_STEPS ? step : HEAT_STEPS);
    }
    return true;
}

FlipSink heat_picture_sink(IndexedImage *picture) { return (FlipSink){heat_row, picture}; }
