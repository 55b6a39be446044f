/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sketch as a file. Nothing in it depends on the machine, the hour or the path: the same sketch gives the same bytes.
   Pictures stay pixels; all else is lines, areas and, in a PDF, text in SVG and PDF, and pixels in PNG. */
#pragma once
#include "sketch/sketch.h"

#define SKETCH_DPI 300.0
#define SKETCH_LEAST_DPI 50.0
#define SKETCH_LARGEST_DPI 1200.0
enum { SKETCH_MAX_PIXELS = 40000000 }; /* of a PNG: 160 MB in memory */

typedef struct SketchOutput {
    double dpi;       /* dots an inch: of a PNG */
    bool transparent; /* without a white page below all */
} SketchOutput;

typedef enum SketchFormat { SKETCH_PNG, SKETCH_SVG, SKETCH_PDF, SKETCH_FORMATS } SketchFormat;

/* By the ending of a path. ERROR_INPUT for any but .png, .svg and .pdf. */
bool sketch_format(const char *path, SketchFormat *format, Error *error);

/* Refuses (ERROR_INPUT) a size in mm at a resolution that would take more than SKETCH_MAX_PIXELS. */
bool sketch_check_pixels(double width, double height, double dpi, Error *error);

/* Writes the file that the ending asks for, whole or not at all. */
bool sketch_write(const Sketch *sketch, const char *path, const SketchOutput *output, Error *error);

/* Writes stem.png (SKETCH_DPI) and stem.svg, on white. */
bool sketch_draw(const Sketch *sketch, const char *stem, Error *error);
