/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs the program gnuplot. */
#pragma once
#include "common/error.h"

#include <stdbool.h>
#include <stddef.h>

/* One drawing. */
typedef struct GnuplotDrawing {
    double width, height; /* mm */
    const char *script;   /* plot commands without terminal and output; trusted, as gnuplot can run programs */
    size_t script_size;
    bool without_pdf;
    const char *title;   /* of the SVG and PDF files; plain (chart_plain) */
    const char *overlay; /* SVG elements on top of the drawing, in mm from its upper left corner; NULL: none */
} GnuplotDrawing;

/* Draws stem.png (300 dots per inch), stem.svg and, unless without_pdf, stem.pdf. The default font is 8 pt Inter,
   embedded. The files appear when all are complete. PNG and SVG depend only on the script and
   the versions of gnuplot and cairo; a PDF contains its date. ERROR_SYSTEM if gnuplot is missing or fails. */
bool gnuplot_draw(const GnuplotDrawing *drawing, const char *stem, Error *error);
