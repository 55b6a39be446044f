/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A Markdown text as one HTML5 page that needs no other file, for phones, screens and paper. */
#pragma once
#include "common/error.h"

#include <stdio.h>

typedef struct HtmlPage {
    const char *markdown; /* CommonMark with GitHub's tables; raw HTML in it is left out */
    const char *style;    /* CSS */
    const char *folder;   /* that paths of images are relative to */
} HtmlPage;

/* The first heading becomes the page's title, those of level 2 its table of contents. A paragraph that is only an image
   becomes a figure with the PNG file embedded; the paragraph after it is its caption. ERROR_INPUT where an image is
   missing or damaged. */
bool html_page_write(const HtmlPage *page, FILE *out, Error *error);
