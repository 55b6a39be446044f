/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Values as Markdown. */
#pragma once
#include <stdbool.h>
#include <stdio.h>

/* Writes text so that no character of it has a meaning to Markdown, nor in a table's cell. */
void markdown_escape(FILE *out, const char *text);

/* Writes a field of a CSV file. format: NULL (text), "number", "percent", "score" (template.h); false for any other. */
bool template_write_value(FILE *out, const char *field, const char *format);
