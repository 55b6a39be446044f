/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes a sketch to a file. The same sketch gives the same bytes, independent of machine, time and path. SVG and
   PDF are vector graphics, except for pictures; their text is text. */
#pragma once
#include "sketch/sketch.h"

#define SKETCH_DPI 300.0
#define SKETCH_DPI_MIN 50.0
#define SKETCH_DPI_MAX 1200.0
enum { SKETCH_MAX_PIXELS = 40000000 }; /* of a PNG; 160 MB in memory */

typedef struct SketchOutput {
    double dpi;       /* dots per inch of a PNG */
    bool transparent; /* without a white page */
    bool outlines;    /* SVG: text as outlines instead of text */
} SketchOutput;

typedef enum SketchFormat { SKETCH_PNG, SKETCH_SVG, SKETCH_PDF, SKETCH_FORMATS } SketchFormat;

/* From the ending of a path. ERROR_INPUT unless it is .png, .svg or .pdf. */
bool sketch_format(const char *path, SketchFormat *format, Error *error);

/* ERROR_INPUT if a page of this size in mm would exceed SKETCH_MAX_PIXELS. */
bool sketch_check_pixels(double width, double height, double dpi, Error *error);

/* ERROR_INPUT if a text or the title has a character that the font lacks (type/type_check.h); `where` names the origin. */
bool sketch_check_texts(const Sketch *sketch, const char *where, Error *error);

/* Writes the format given by the path's ending. The file appears complete or not at all. */
bool sketch_write(const Sketch *sketch, const char *path, const SketchOutput *output, Error *error);

/* Writes stem.png (SKETCH_DPI) and stem.svg, up to `last` SKETCH_PDF also stem.pdf, on white. */
bool sketch_draw(const Sketch *sketch, const char *stem, SketchFormat last, Error *error);
