/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text of others, such as names of files, in messages: what a terminal or a log would obey becomes visible. */
#pragma once
#include <stddef.h>

typedef enum VisibleLines { VISIBLE_ONE_LINE, VISIBLE_LINES } VisibleLines;

/* Copies text to out[size], size > 16. Control characters, bytes that are not UTF-8 and characters that turn the direction
   of text become "\x1b", "\xff", "\u202e"; ends of lines "\n", unless `lines` keeps them. Text that does not fit loses its
   middle: "begin...end". Returns the length. */
size_t visible_text(char *out, size_t size, const char *text, VisibleLines lines);

/* The first control character in the text (C0, DEL, C1 of Unicode, which includes ends of lines); 0 without one. */
unsigned control_in_text(const char *text);
