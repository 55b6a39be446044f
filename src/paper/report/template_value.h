/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Values as Markdown. No character of them has a meaning to Markdown, nor in a table's cell. */
#pragma once
#include "common/error.h"

#include <stdio.h>

/* A field of a CSV file: cut to a name's length, a dash if it is empty. */
void template_write_text(FILE *out, const char *text);

/* A text of one line; a dash if it is empty. ERROR_INPUT if it is not UTF-8 without control characters; `where` names it. */
bool template_write_line(FILE *out, const char *text, const char *where, Error *error);

/* format: "number", "percent", "score" (template.h); false for any other. A dash for NaN and infinite values. */
bool template_write_number(FILE *out, double value, const char *format);

/* The text of a file. ERROR_INPUT if it is not one line of UTF-8 without control characters. */
bool template_write_caption(FILE *out, const char *path, Error *error);
