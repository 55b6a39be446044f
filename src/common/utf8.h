/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include <stddef.h>
#include <stdint.h>

/* The character that text of `size` bytes begins with (Unicode 15, table 3-7): its length in bytes, or 0 where it is
   not well-formed. */
size_t utf8_decode(const char *text, size_t size, uint32_t *character);

/* The next character of NUL-terminated text that is not empty; moves *text behind it. U+FFFD, and one byte, where the
   text is not well-formed. */
uint32_t utf8_next(const char **text);

/* Puts a character (no surrogate, at most 0x10ffff) to `out`, room for 4 bytes; returns its length. */
size_t utf8_encode(char *out, uint32_t character);
