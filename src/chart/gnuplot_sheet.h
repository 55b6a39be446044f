/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A page and the memory it is written to, until gnuplot draws it. */
#pragma once
#include "chart/gnuplot_page.h"

/* Initialise with zeros; free with gnuplot_sheet_free(). */
typedef struct GnuplotSheet {
    GnuplotPage page; /* width 0: nothing to draw */
    char *script, *caption, *links;
    size_t script_size, caption_size, links_size;
} GnuplotSheet;

/* Open and close the page's script, caption and links. False if out of memory; the error names `what`. */
bool gnuplot_sheet_open(GnuplotSheet *sheet, const char *what, Error *error);
bool gnuplot_sheet_close(GnuplotSheet *sheet, const char *what, Error *error);

/* Draws a closed sheet as folder/prefixNAME.png and .svg, and writes its caption as .txt. Does nothing for width 0. */
bool gnuplot_sheet_draw(const GnuplotSheet *sheet, const char *folder, const char *prefix, const char *name,
                        Error *error);

void gnuplot_sheet_free(GnuplotSheet *sheet);
