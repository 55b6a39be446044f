/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include <stdio.h>

/* Writes text escaped for HTML or XML, also for use in attributes, so that no text can become markup. Bytes that are not
   UTF-8 and characters that XML does not allow become U+FFFD: a parser would refuse the whole file. */
void html_put(FILE *file, const char *text);

/* Writes a file name for use in an address: percent-encoded but for letters, digits and -._~. */
void html_put_address(FILE *file, const char *name);
