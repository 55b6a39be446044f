/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text for LaTeX. */
#pragma once
#include <stdio.h>

/* A text in which every character stands for itself, in any font encoding; bytes beyond ASCII stay as they are (UTF-8). */
void latex_text(FILE *out, const char *text);

/* The same as \texttt{...}. */
void latex_code(FILE *out, const char *text);

/* What stands before item `index` of a list of `count`: nothing, a comma or "and". */
const char *latex_between(int index, int count);
