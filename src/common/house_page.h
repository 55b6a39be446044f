/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What twinbox's HTML pages share: style, head and end. Their policy prevents any request but for pictures beside them. */
#pragma once
#include <stdio.h>

extern const char house_css[]; /* src/common/page, embedded in the binary by common/tools/embed.cmake */

/* Up to <main>; the title is text. style: more CSS. */
void house_page_begin(FILE *out, const char *title, const char *style);
void house_page_end(FILE *out);
