/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A page with the memory that it is written into, until gnuplot draws it. */
#pragma once
#include "chart/figure_page.h"

/* Zero-initialise; freed by figure_sheet_free in any case. */
typedef struct FigureSheet {
    FigurePage page; /* a width of 0: there is nothing to draw */
    char *script, *caption, *links;
    size_t script_size, caption_size, links_size;
} FigureSheet;

/* Opens the page's script, caption and links; closes them. False when memory was short; then the error names `what`. */
bool figure_sheet_open(FigureSheet *sheet, const char *what, Error *error);
bool figure_sheet_close(FigureSheet *sheet, const char *what, Error *error);

/* Draws a closed sheet as folder/prefixNAME.png and .svg, and writes its caption as .txt. A sheet without a width is left
   out. */
bool figure_sheet_draw(const FigureSheet *sheet, const char *folder, const char *prefix, const char *name,
                       Error *error);

void figure_sheet_free(FigureSheet *sheet);
