/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The two languages of a document. Both escape every text, so none can be more than a text. */
#pragma once
#include "paper/report/document.h"

#include <stdio.h>

/* Markdown with tables (GitHub's), figures as relative links. */
void document_write_markdown(const Document *document, FILE *file);

/* One HTML5 page that needs nothing else: style and figures are in it. The first heading is its title; those of level
   2 make its table of contents. */
void document_write_html(const Document *document, FILE *file);
