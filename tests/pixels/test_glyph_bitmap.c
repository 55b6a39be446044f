/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Glyphs drawn at run time look like those of the atlas, which FreeType drew. */
#include "testing.h"
#include "owned_drawings.h"

#include "pixels/gl.h"
#include "pixels/pixels_internal.h"

enum { LEVEL = 5 };

/* Coverage at a pixel of the picture; 0 outside the bitmap. */
static int coverage(const FontGlyph *glyph, const uint8_t *bitmap, int x, int y) {
    const int column = x - glyph->left, row = y + glyph->top;
    return column < 0 || row < 0 || column >= glyph->width || row >= glyph->height
               ? 0
               : bitmap[row * glyph->width + column];
}

/* The largest difference of a pixel, in levels. */
static int difference(const FontGlyph *a, const uint8_t *first, const FontGlyph *b, const uint8_t *second) {
    int largest = 0;
    for (int y = -100; y < 50; y++)
        for (int x = -20; x < 120; x++) {
            const int off = abs(coverage(a, first, x, y) - coverage(b, second, x, y)) / LEVEL;
            if (off > largest) largest = off;
        }
    return largest;
}

static bool has_curves(const Typeface *face, const Glyph *glyph) {
    for (int i = glyph->first; i < glyph->first + glyph->steps; i++)
        if (face->steps[i].kind == OUTLINE_CURVE) return true;
    return false;
}

/* Straight edges differ by the rounding of a level; FreeType draws curves as lines that may be a fifth of a pixel (10
   of 51 levels) away. Digits are left out: those of the atlas have equal widths. */
TEST(own_glyphs_are_those_of_freetype) {
    static const Typeface *const faces[FONT_FACES] = {&type_regular, &type_semibold};
    int compared = 0;
    for (int face = 0; face < FONT_FACES; face++)
        for (int size = 0; size < FONT_SIZES; size++)
            for (int i = 0; i < FONT_GLYPHS; i++) {
                const FontGlyph *expected = &font_glyphs[face][size][i];
                const Glyph *outline = type_find(faces[face], expected->code);
                if (outline == NULL || (expected->code >= '0' && expected->code <= '9')) continue;
                const FontGlyph actual = glyph_metrics(faces[face], outline, font_sizes[size]);
                uint8_t *bitmap = calloc((size_t)actual.width * (size_t)actual.height + 1, 1);
                assert_true(glyph_draw(faces[face], outline, font_sizes[size], &actual, bitmap));
                if (abs(actual.advance - expected->advance) > 1 ||
                    difference(expected, font_bitmaps + expected->offset, &actual, bitmap) >
                        (has_curves(faces[face], outline) ? 10 : 1))
                    fail_msg("U+%04X at %d pixels: advance %d and %d, %d levels apart", expected->code,
                             font_sizes[size], expected->advance, actual.advance,
                             difference(expected, font_bitmaps + expected->offset, &actual, bitmap));
                free(bitmap);
                compared++;
            }
    assert_true(compared > 4000);
}

/* A frame that reuses the place of another's bitmap is another frame, and a part of a glyph begins at its texel. */
TEST(the_bitmaps_belong_to_the_drawing) {
    OWN(Drawing) drawing = {0}, part = {0};
    const Font font = font_pick(FONT_REGULAR, 20);
    font_add(&drawing, &font,
             "\xC3\x9C"
             "b\xC4\x83",
             10, 40, 0); /* U umlaut, b, a breve */
    assert_int_equal(drawing.glyph_count, 3);
    assert_int_equal(drawing.glyphs[0].bitmap, font_bitmaps_size);
    assert_true(drawing.glyphs[1].bitmap < font_bitmaps_size);
    const GlyphInstance *last = &drawing.glyphs[2];
    assert_int_equal(last->bitmap + (unsigned)(last->box[2] * last->box[3]), font_bitmaps_size + drawing.bitmap_size);
    drawing_add_part(&part, &drawing, &(Rect){last->box[0] + 3, last->box[1] + 2, 1000, 40});
    assert_int_equal(part.glyph_count, 1);
    assert_int_equal(part.glyphs[0].bitmap, last->bitmap + 2U * (unsigned)last->box[2] + 3);
    drawing_clear(&drawing);
    assert_int_equal(drawing.bitmap_size, 0);
}

RUN_TESTS(NULL, NULL)
