/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The difference picture of a report. */
#include "base/base.h"
#include "pixels/png.h"
#include "regression/image_compare.h"
#include "regression/regression_internal.h"

#include <string.h>

typedef struct Stop {
    double at;
    uint8_t rgb[3];
} Stop;

/* Readable on a pale background, with steps that remain visible in grey. */
static const Stop gradient[] = {{0, {255, 176, 0}}, {0.1, {250, 120, 0}}, {0.4, {214, 24, 48}}, {1, {72, 0, 110}}};

/* Greys in the upper fifth of the scale, the hatch, ignored edges, the stripes beyond both pictures, and the
   gradient. */
enum { PALEST = 200, PALE = 56, HATCHED = PALE, EDGE, BEYOND, GRADIENT, STEPS = 256 - GRADIENT };
enum { HATCH_GREY = 120, HATCH = 8 };
static const uint8_t edge_color[3] = {70, 150, 235}, beyond_color[3] = {150, 120, 175};

static void make_palette(Palette *palette) {
    palette->count = 0;
    for (int i = 0; i < PALE; i++) memset(palette->rgb[palette->count++], PALEST + i, 3);
    memset(palette->rgb[palette->count++], HATCH_GREY, 3);
    memcpy(palette->rgb[palette->count++], edge_color, sizeof edge_color);
    memcpy(palette->rgb[palette->count++], beyond_color, sizeof beyond_color);
    const Stop *stops = gradient;
    for (int i = 0; i < STEPS; i++) {
        const double at = (double)i / (STEPS - 1);
        while (at > stops[1].at) stops++;
        const double share = (at - stops[0].at) / (stops[1].at - stops[0].at);
        uint8_t *rgb = palette->rgb[palette->count++];
        for (int c = 0; c < 3; c++)
            rgb[c] = (uint8_t)(stops[0].rgb[c] + share * (stops[1].rgb[c] - stops[0].rgb[c]) + 0.5);
    }
}

/* Neighbours are often equal, and most pixels are equal in both pictures. */
static void draw_row(const Image *expected, const Image *actual, int y, const uint8_t *masked, uint8_t *row) {
    size_t first = (size_t)y * (size_t)expected->width;
    const uint8_t *p = expected->pixels + 4 * first, *q = actual->pixels + 4 * first;
    bool deep = expected->pixels16 != NULL || actual->pixels16 != NULL;
    uint8_t grey = 0;
    for (int x = 0; x < expected->width; x++, p += 4, q += 4) {
        size_t i = first + (size_t)x;
        if (x == 0 || memcmp(p, p - 4, 4) != 0) grey = (uint8_t)((p[0] * 3 + p[1] * 6 + p[2]) / 10 * 55 / 255);
        row[x] = grey;
        Ignored ignored = masked != NULL ? (Ignored)masked[i] : IGNORED_NOT;
        if (ignored == IGNORED_EDGE) {
            row[x] = EDGE;
        } else if (ignored == IGNORED_MASK) {
            if ((x + y) % HATCH == 0) row[x] = HATCHED;
        } else if (deep || memcmp(p, q, 4) != 0) {
            int difference = image_pixel_difference(expected, actual, i);
            if (difference > 0) row[x] = (uint8_t)(GRADIENT + ((difference - 1) * (STEPS - 1) + 127) / 254);
        }
    }
}

uint8_t *difference_picture(const Image *expected, const Image *actual, const uint8_t *masked, int width, int height,
                            size_t *size, Error *error) {
    Palette palette = {.count = 0};
    make_palette(&palette);
    IndexedPng *png = indexed_png_create(width, height, &palette, error);
    uint8_t *file = NULL;
    bool ok = png != NULL;
    for (int y = 0; ok && y < height; y++) {
        bool inside = y < expected->height;
        uint8_t *row = indexed_png_row(png);
        if (inside) draw_row(expected, actual, y, masked, row);
        for (int x = inside ? expected->width : 0; x < width; x++) /* stripes */
            row[x] = (x + y) / (HATCH / 2) % 2 == 0 ? BEYOND : PALE - 1;
        ok = indexed_png_add(png, error);
    }
    if (ok) file = indexed_png_end(png, size, error);
    indexed_png_destroy(png);
    return file;
}
