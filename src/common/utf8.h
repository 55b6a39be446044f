/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include <stddef.h>
#include <stdint.h>

/* The character that text of `size` bytes begins with (Unicode 15, table 3-7): its length in bytes, or 0 if it is not
   well-formed. */
size_t utf8_decode(const char *text, size_t size, uint32_t *character);

/* The next character of NUL-terminated text that is not empty; moves *text behind it. Returns U+FFFD for a byte that is
   not well-formed. */
uint32_t utf8_next(const char **text);

/* Length of the first whole characters of NUL-terminated text, at most `limit` bytes. */
size_t utf8_cut(const char *text, size_t limit);

/* Writes a character (not a surrogate, at most 0x10ffff) to `out`, which has room for 4 bytes; returns its length. */
size_t utf8_encode(char *out, uint32_t character);
