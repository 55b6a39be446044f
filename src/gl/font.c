/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gl/font.h"

#include "gl/glyph_bitmap.h"

#include <string.h>

enum { PEN_UNIT = 64 }; /* pen positions are in 1/64 pixel, so that rounding errors of glyphs do not accumulate */
#define ELLIPSIS "\xE2\x80\xA6"

Font font_pick(FontFace face, double pixels) {
    static const Typeface *const faces[FONT_FACES] = {&type_regular, &type_semibold};
    Font font = {0};
    for (int i = 0; i < FONT_SIZES; i++)
        if (font_sizes[i] <= pixels) font = (Font){font_glyphs[face][i], faces[face], font_sizes[i]};
    return font;
}

/* NULL if the atlas lacks the character. */
static const FontGlyph *find_in_atlas(const Font *font, unsigned code) {
    int low = 0, high = FONT_GLYPHS;
    while (low < high) {
        int middle = (low + high) / 2;
        if (font->glyphs[middle].code < code)
            low = middle + 1;
        else
            high = middle;
    }
    return low < FONT_GLYPHS && font->glyphs[low].code == code ? &font->glyphs[low] : NULL;
}

/* The next character of a text. `outline` is NULL if the bitmap is in the atlas. */
static FontGlyph next_glyph(const Font *font, const char **text, const Glyph **outline) {
    const unsigned code = type_next_code(text);
    const FontGlyph *glyph = find_in_atlas(font, code);
    *outline = glyph == NULL ? type_find(font->face, code) : NULL;
    if (*outline != NULL) return glyph_metrics(font->face, *outline, font->pixels);
    return glyph != NULL ? *glyph : *find_in_atlas(font, '?');
}

static int next_advance(const Font *font, const char **text) {
    const Glyph *outline;
    return next_glyph(font, text, &outline).advance;
}

static int advance(const Font *font, const char *text) {
    int pen = 0;
    while (font->glyphs != NULL && *text != '\0') pen += next_advance(font, &text);
    return pen;
}

static int to_pixels(int pen) { return (pen + PEN_UNIT - 1) / PEN_UNIT; }

int font_width(const Font *font, const char *text) { return to_pixels(advance(font, text)); }

static void draw_bitmap(Drawing *drawing, const Font *font, const Glyph *outline, const FontGlyph *glyph,
                        uint32_t *index) {
    uint8_t *bitmap = drawing_add_bitmap(drawing, (size_t)glyph->width * (size_t)glyph->height, index);
    if (bitmap != NULL && !glyph_draw(font->face, outline, font->pixels, glyph, bitmap)) drawing->failed = true;
}

/* Adds the characters before `end` and returns the pen. */
static int add(Drawing *drawing, const Font *font, const char *text, const char *end, int x, int baseline,
               uint32_t color) {
    int pen = 0;
    while (text < end) {
        const Glyph *outline;
        const FontGlyph glyph = next_glyph(font, &text, &outline);
        int left = x + (pen + PEN_UNIT / 2) / PEN_UNIT + glyph.left;
        GlyphInstance instance = {{left, baseline - glyph.top, glyph.width, glyph.height}, glyph.offset, color};
        if (outline != NULL) draw_bitmap(drawing, font, outline, &glyph, &instance.bitmap);
        if (glyph.width > 0) drawing_add_glyph(drawing, &instance);
        pen += glyph.advance;
    }
    return x + to_pixels(pen);
}

int font_add(Drawing *drawing, const Font *font, const char *text, int x, int baseline, uint32_t color) {
    if (font->glyphs == NULL) return x;
    return add(drawing, font, text, text + strlen(text), x, baseline, color);
}

int font_add_fitting(Drawing *drawing, const Font *font, const char *text, int x, int baseline, int max_width,
                     uint32_t color) {
    if (font_width(font, text) <= max_width) return font_add(drawing, font, text, x, baseline, color);
    int room = (max_width - font_width(font, ELLIPSIS)) * PEN_UNIT, pen = 0;
    if (room < 0) return x;
    const char *end = text, *next = text;
    while (*next != '\0' && (pen += next_advance(font, &next)) <= room) end = next;
    while (end > text && end[-1] == ' ') end--;
    int end_x = add(drawing, font, text, end, x, baseline, color);
    return font_add(drawing, font, ELLIPSIS, end_x, baseline, color);
}
