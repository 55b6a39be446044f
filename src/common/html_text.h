/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include <stdio.h>

/* Writes text as HTML or XML, also within quotes: no text can be more than a text. */
void html_put(FILE *file, const char *text);
