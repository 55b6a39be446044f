/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes a PNG file of at most 256 colours in memory, row by row. It has a third of the bytes of RGB and takes a fraction
   of the time to compress. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

typedef struct Palette {
    int count;
    uint8_t rgb[256][3];
} Palette;

typedef struct IndexedPng IndexedPng;

/* NULL with error set if out of memory. */
IndexedPng *indexed_png_create(int width, int height, const Palette *palette, Error *error);
void indexed_png_destroy(IndexedPng *png);

/* Room for a row, [width] indices of the palette; indexed_png_add() takes it as the next one. */
uint8_t *indexed_png_row(IndexedPng *png);
bool indexed_png_add(IndexedPng *png, Error *error);

/* The file, malloc'ed, once all rows are added. NULL with error set if out of memory. */
uint8_t *indexed_png_end(IndexedPng *png, size_t *size, Error *error);
