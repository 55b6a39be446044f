/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bitmaps of glyphs that are not in the atlas, drawn from their outlines when text needs them. */
#pragma once
#include "gl/font_atlas.h"
#include "type/type.h"

#include <stdbool.h>

/* The size and place of a glyph at `pixels` per em; its offset is 0. */
FontGlyph glyph_metrics(const Typeface *face, const Glyph *glyph, int pixels);

/* Fills the glyph's bitmap in the levels of the atlas; false if out of memory. */
bool glyph_draw(const Typeface *face, const Glyph *glyph, int pixels, const FontGlyph *metrics, uint8_t *bitmap);
