/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The writers of the three formats, and what they share. Each returns a malloc'ed block, or NULL with error set.

     char *data = sketch_as_svg(&sketch, &output, &size, &error);

   Why our own writers: a figure has the same bytes on Debian 12 and 13. Tests compare bytes with stored hashes:
   test_sketch_files.c for the writers, test_figure.sh and test_paper.sh for figures. cairo's bytes depend on its
   version: with a fixed creation date, cairo 1.16.0 (Debian 12) and 1.18.4 (Debian 13) write different PDF and
   SVG files, and different pixels of text. zlib, which compresses our PNG files and PDF streams, gives the same
   bytes in versions 1.2.13 and 1.3.1. */
#pragma once
#include "base/base.h"
#include "figures/sketch.h"
#include "pixels/png.h"
#include "pixels/type.h"

char *sketch_as_png(const Sketch *sketch, const SketchOutput *output, size_t *size, Error *error);
char *sketch_as_svg(const Sketch *sketch, const SketchOutput *output, size_t *size, Error *error);
char *sketch_as_pdf(const Sketch *sketch, const SketchOutput *output, size_t *size, Error *error);

/* The font that the texts need. */
FontFile sketch_font(const Sketch *sketch);

/* The marks' indices from bottom to top, [mark_count]; NULL if out of memory. */
size_t *sketch_order(const Sketch *sketch);

enum { DASHES_MAX = 4 };

/* Returns the number of a pen's dashes and gaps, and their lengths in mm; 0: solid. */
int pen_dashes(const Pen *pen, double dashes[DASHES_MAX]);

/* The start of a text on its baseline, and the unit vector along it. */
typedef struct TextPlace {
    Point from;
    double cosine, sine, em; /* mm per em */
} TextPlace;
TextPlace text_place(const Sketch *sketch, const SketchMark *mark);

/* Halo thickness on each side / em. */
#define HALO_SHARE 0.14

/* The picture as PNG, with alpha if any pixel is not opaque; dpi 0: without resolution. drawn: of lines and text alone,
   which take a tenth to a quarter less room without filters. */
char *picture_as_png(const Image *image, double dpi, bool drawn, size_t *size, Error *error);

/* Blends one colour, alpha 0 .. 255, over a pixel. */
void pixel_over(uint8_t *pixel, const uint8_t colour[3], int alpha);
