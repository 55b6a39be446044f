/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The objects that a PDF file consists of, and those of its font. Why our own: sketch_formats.h. */
#pragma once
#include "sketch/sketch.h"

/* Numbers of the objects; pictures follow, each with its alpha behind it. */
enum { CATALOG = 1, PAGES, PAGE, CONTENT, FONT, CID_FONT, DESCRIPTOR, FONT_FILE, TO_UNICODE, FIRST_IMAGE };

typedef struct Pdf {
    FILE *file;
    const Sketch *sketch;
    size_t *offsets; /* of the objects, by number */
    int count;       /* of them, number 0 included */
} Pdf;

void pdf_begin_object(Pdf *pdf, int number);

/* A compressed block; `keys`: of its dictionary, beside length and filter. False when memory is short. */
bool pdf_put_stream(Pdf *pdf, int number, const char *keys, const void *data, size_t size);

/* The objects FONT to TO_UNICODE. False when memory is short. */
bool pdf_put_font(Pdf *pdf);
