/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The objects of a PDF file and of its font. Why our own: sketch_formats.h. */
#pragma once
#include "sketch/sketch.h"

/* Object numbers. Pictures follow, each with its alpha after it. */
enum { CATALOG = 1, PAGES, PAGE, CONTENT, FONT, CID_FONT, DESCRIPTOR, FONT_FILE, TO_UNICODE, INFO, FIRST_IMAGE };

typedef struct Pdf {
    FILE *file;
    const Sketch *sketch;
    size_t *offsets; /* byte offset of each object, by number */
    int count;       /* number of objects, including number 0 */
} Pdf;

void pdf_begin_object(Pdf *pdf, int number);

/* A compressed stream; `keys`: dictionary entries besides length and filter. False if out of memory. */
bool pdf_write_stream(Pdf *pdf, int number, const char *keys, const void *data, size_t size);

/* A text string in UTF-16, "<FEFF...>": titles, and texts that replace others. */
void pdf_put_text(FILE *file, const char *text);

/* Writes the objects FONT to TO_UNICODE. False if out of memory. */
bool pdf_write_font(Pdf *pdf);
