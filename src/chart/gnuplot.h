/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Drawings by gnuplot, another program. */
#pragma once
#include "common/error.h"

#include <stdbool.h>
#include <stddef.h>

/* One drawing to be printed. */
typedef struct GnuplotDrawing {
    double width, height; /* mm */
    const char *script;   /* what to plot, without terminal and output; trusted: gnuplot can run programs */
    size_t script_size;
    bool without_pdf;
    const char *over; /* elements that go over those of the SVG, in mm from its upper left corner; NULL: none */
} GnuplotDrawing;

/* Draws stem.png (300 dots an inch), stem.svg and, unless told not to, stem.pdf, with 8 pt Inter as the default font
   (the SVG: whatever sans-serif the reader has). The files are put in place whole, and only when all are drawn. The
   same script gives the same PNG and SVG with the same gnuplot and cairo; a PDF holds its date. ERROR_SYSTEM where
   gnuplot is missing or fails. */
bool gnuplot_draw(const GnuplotDrawing *drawing, const char *stem, Error *error);
