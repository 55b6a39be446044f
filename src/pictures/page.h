/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What HTML pages share: base64, escaped text, the house style. */
#pragma once
#include "base/base.h"

#include <stddef.h>
#include <stdio.h>

/* Bytes as base64 (RFC 4648). Own code: none of the libraries in use encodes it. */
void base64_put(FILE *file, const void *data, size_t size);

/* Writes text escaped for HTML or XML, also for use in attributes, so that no text can become markup. Bytes that are
   not UTF-8 and characters that XML does not allow become U+FFFD: a parser would refuse the whole file. */
void html_put(FILE *file, const char *text);

/* Prints as printf() does, with each "%s" escaped as by html_put(); there is no other conversion. */
void html_print(FILE *file, const char *format, ...) PRINTF_LIKE(2, 3);

/* Writes " 'sha256-...'": what the policy of a page needs to run an embedded script (base/tools/embed.cmake), and no
   other. */
void html_put_script_hash(FILE *file, const unsigned char sha256[32]);

/* Writes a file name for use in an address: percent-encoded but for letters, digits and -._~. */
void html_put_address(FILE *file, const char *name);

/* What twinbox's HTML pages share: style, head and end. Their policy prevents any request but for pictures beside
   them. */

extern const char house_css[]; /* src/pictures/page, embedded in the binary by base/tools/embed.cmake */

/* Up to <main>; the title is text. style: more CSS. */
void house_page_begin(FILE *out, const char *title, const char *style);
void house_page_end(FILE *out);
