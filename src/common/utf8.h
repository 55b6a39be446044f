/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include <stddef.h>
#include <stdint.h>

/* The character that text of `size` bytes begins with (Unicode 15, table 3-7): its length in bytes, or 0 where it is
   not well-formed. */
size_t utf8_decode(const char *text, size_t size, uint32_t *character);
