/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A title on several lines. */
#pragma once
#include "gl/font.h"
#include "picture/caption_size.h"

enum { TEXT_LINES_MAX = 4 };

typedef struct TextLines {
    int count; /* lines that the text needs; at least 1 */
    char lines[TEXT_LINES_MAX][CAPTION_SIZE];
} TextLines;

/* Breaks a text at spaces, or within a word longer than a line, into lines of at most `first` pixels and then `others`. If it
   needs more than TEXT_LINES_MAX, the last of these has the rest. The first stays empty if only the others have room for the
   first word. */
TextLines text_lines(const Font *font, const char *text, int first, int others);
