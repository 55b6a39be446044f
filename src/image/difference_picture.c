/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/difference_picture.h"

#include "image/image_compare.h"
#include "image/mask.h"

#include <string.h>

typedef struct Stop {
    double at;
    uint8_t rgb[3];
} Stop;

/* Readable on a pale background, with steps that remain visible in grey. */
static const Stop differences[] = {{0, {255, 176, 0}}, {0.1, {250, 120, 0}}, {0.4, {214, 24, 48}}, {1, {72, 0, 110}}};
static const Stop heat[] = {
    {0, {0, 0, 4}}, {0.25, {87, 16, 110}}, {0.5, {188, 55, 84}}, {0.75, {249, 142, 9}}, {1, {252, 255, 164}}};

/* Adds `count` colours of a gradient, from its start to its end. */
static void add_gradient(Palette *palette, const Stop *stops, int count) {
    for (int i = 0; i < count; i++) {
        double at = (double)i / (count - 1);
        while (at > stops[1].at) stops++;
        double share = (at - stops[0].at) / (stops[1].at - stops[0].at);
        uint8_t *rgb = palette->rgb[palette->count++];
        for (int c = 0; c < 3; c++)
            rgb[c] = (uint8_t)(stops[0].rgb[c] + share * (stops[1].rgb[c] - stops[0].rgb[c]) + 0.5);
    }
}

/* Greys in the upper fifth of the scale, the hatch, ignored edges, the stripes beyond both pictures, and the gradient. */
enum { PALEST = 200, PALE = 56, HATCHED = PALE, EDGE, BEYOND, GRADIENT, STEPS = 256 - GRADIENT };
enum { HATCH_GREY = 120, HATCH = 8 };
static const uint8_t edge_color[3] = {70, 150, 235}, beyond_color[3] = {150, 120, 175};

static void make_difference_palette(Palette *palette) {
    palette->count = 0;
    for (int i = 0; i < PALE; i++) memset(palette->rgb[palette->count++], PALEST + i, 3);
    memset(palette->rgb[palette->count++], HATCH_GREY, 3);
    memcpy(palette->rgb[palette->count++], edge_color, sizeof edge_color);
    memcpy(palette->rgb[palette->count++], beyond_color, sizeof beyond_color);
    add_gradient(palette, differences, STEPS);
}

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

uint8_t *difference_picture(const Image *expected, const Image *actual, const uint8_t *masked, int width, int height,
                            size_t *size, Error *error) {
    Palette palette;
    make_difference_palette(&palette);
    IndexedPng *png = indexed_png_create(width, height, &palette, error);
    uint8_t *file = NULL;
    bool ok = png != NULL;
    for (int y = 0; ok && y < height; y++) {
        bool inside = y < expected->height;
        if (inside) draw_row(expected, actual, y, masked, indexed_png_row(png));
        draw_beyond(inside ? expected->width : 0, width, y, indexed_png_row(png));
        ok = indexed_png_add(png, error);
    }
    if (ok) file = indexed_png_end(png, size, error);
    indexed_png_destroy(png);
    return file;
}

/* Steps that are hardly visible make a smaller file. */
enum { HEAT_STEPS = 32 };

IndexedPng *heat_picture(int width, int height, Error *error) {
    Palette palette = {.count = 0};
    add_gradient(&palette, heat, HEAT_STEPS + 1);
    return indexed_png_create(width, height, &palette, error);
}

/* Only 0 gives step 0. */
static uint8_t heat_step(float value) {
    float scaled = value * HEAT_STEPS;
    int step = (int)scaled;
    step += (float)step < scaled;
    return (uint8_t)(step < HEAT_STEPS ? step : HEAT_STEPS);
}

static bool heat_row(void *context, const float *values, int width, Error *error) {
    uint8_t *row = indexed_png_row(context);
    for (int x = 0; x < width; x++) row[x] = heat_step(values[x]);
    return indexed_png_add(context, error);
}

FlipSink heat_picture_sink(IndexedPng *picture) { return (FlipSink){heat_row, picture}; }
