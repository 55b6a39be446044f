/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Inter as an OpenType file, embedded at build time from src/gl/font. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct FontFile {
    const unsigned char *bytes;
    size_t size;
    unsigned glyphs; /* those with an index below this (Glyph.index) */
} FontFile;

/* Whether the small font has all characters of a text. */
bool font_file_suffices(const char *text);

/* The small one has ASCII and few more characters: figures carry the font that they need. */
FontFile font_file(bool small);
