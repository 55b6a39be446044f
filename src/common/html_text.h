/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include <stdio.h>

/* Writes text escaped for HTML or XML, also for use in attributes, so that no text can become markup. */
void html_put(FILE *file, const char *text);
