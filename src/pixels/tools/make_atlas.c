/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Build-time tool: rasterises the fonts (FreeType, unhinted) at a set of sizes and prints the bitmaps and
   metrics as C (pixels/gl.h). Usage: make_atlas REGULAR.otf SEMIBOLD.otf OUTPUT.c */
#include "pixels/gl.h"

#include <ft2build.h>
#include <stdio.h>
#include <stdlib.h>

#include FT_FREETYPE_H
#include FT_OUTLINE_H

/* Steps of about an eighth: the next smaller size is close enough to the requested one. */
static const int sizes[FONT_SIZES] = {9,  10, 11, 12, 13, 14, 15, 16, 18, 20, 22, 24,
                                      26, 28, 30, 32, 36, 40, 44, 48, 52, 56, 64, 72};

static const unsigned extra[] = {0xB0, 0xB1, 0xB5, 0xB7, 0xD7, 0x2007, 0x2013, 0x2014, 0x2026, 0x2212, 0x221E};
enum { ASCII_FIRST = 0x20, ASCII_LAST = 0x7E, ASCII = ASCII_LAST - ASCII_FIRST + 1, FIGURE_SPACE_CODE = 0x2007 };

static FILE *output;
static unsigned bitmap_size;

static void make_atlas_quit(const char *what) {
    fprintf(stderr, "make_atlas: %s\n", what);
    exit(1);
}

static FT_Pos make_atlas_load(FT_Face face, unsigned code) {
    FT_UInt index = FT_Get_Char_Index(face, code);
    if (index == 0) make_atlas_quit("a character is missing in the font");
    if (FT_Load_Glyph(face, index, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP) != 0) make_atlas_quit("cannot load a glyph");
    return (face->glyph->linearHoriAdvance + (1 << 9)) >> 10;
}

/* All figures are as wide: changing numbers must not shift. */
static FT_Pos figure_advance(FT_Face face) {
    FT_Pos widest = 0;
    for (unsigned code = '0'; code <= '9'; code++) {
        FT_Pos advance = make_atlas_load(face, code);
        if (advance > widest) widest = advance;
    }
    return widest;
}

/* Prints the coverage in the levels of the shapes (shaders/shape.frag), as a part of one string: a list of numbers
   takes a compiler seconds. */
static FontGlyph render(FT_Face face, unsigned code, FT_Pos figure) {
    if (code == FIGURE_SPACE_CODE) return (FontGlyph){.code = code, .advance = (short)figure};
    FT_Pos advance = make_atlas_load(face, code);
    if (code >= '0' && code <= '9') {
        FT_Outline_Translate(&face->glyph->outline, (figure - advance) / 2, 0);
        advance = figure;
    }
    if (FT_Render_Glyph(face->glyph, FT_RENDER_MODE_NORMAL) != 0) make_atlas_quit("cannot render a glyph");
    const FT_Bitmap *bitmap = &face->glyph->bitmap;
    for (unsigned y = 0; y < bitmap->rows; y++) {
        for (unsigned x = 0; x < bitmap->width; x++) {
            int coverage = bitmap->buffer[(int)y * bitmap->pitch + (int)x];
            fprintf(output, "\\%o", (unsigned)(coverage * 51 + 127) / 255 * 5);
        }
    }
    const unsigned offset = bitmap_size;
    bitmap_size += bitmap->rows * bitmap->width;
    return (FontGlyph){code,
                       offset,
                       (short)bitmap->width,
                       (short)bitmap->rows,
                       (short)face->glyph->bitmap_left,
                       (short)face->glyph->bitmap_top,
                       (short)advance};
}

/* Nested braces: with a designator for each glyph, [1][2][3] = {...}, gcc takes seconds. */
static void print_glyphs(FontGlyph glyphs[FONT_FACES][FONT_SIZES][FONT_GLYPHS]) {
    fputs("const FontGlyph font_glyphs[FONT_FACES][FONT_SIZES][FONT_GLYPHS] = {\n", output);
    for (int face = 0; face < FONT_FACES; face++) {
        fputs("{", output);
        for (int size = 0; size < FONT_SIZES; size++) {
            fputs("{\n", output);
            for (int i = 0; i < FONT_GLYPHS; i++) {
                const FontGlyph *g = &glyphs[face][size][i];
                fprintf(output, "{%u,%u,%d,%d,%d,%d,%d},\n", g->code, g->offset, g->width, g->height, g->left, g->top,
                        g->advance);
            }
            fputs("},", output);
        }
        fputs("},\n", output);
    }
    fputs("};\nconst int font_sizes[FONT_SIZES] = {", output);
    for (int size = 0; size < FONT_SIZES; size++) fprintf(output, "%d,", sizes[size]);
    fprintf(output, "};\nconst unsigned font_bitmaps_size = %u;\n", bitmap_size);
}

int main(int argc, char **argv) {
    static FontGlyph glyphs[FONT_FACES][FONT_SIZES][FONT_GLYPHS];
    FT_Library library;
    if (argc != FONT_FACES + 2) make_atlas_quit("usage: make_atlas REGULAR.otf SEMIBOLD.otf OUTPUT.c");
    if ((output = fopen(argv[FONT_FACES + 1], "w")) == NULL) make_atlas_quit("cannot write the output");
    if (FT_Init_FreeType(&library) != 0) make_atlas_quit("cannot start FreeType");
    fputs("#include \"pixels/gl.h\"\nconst uint8_t font_bitmaps[] = \"", output);
    for (int i = 0; i < FONT_FACES; i++) {
        FT_Face face;
        if (FT_New_Face(library, argv[1 + i], 0, &face) != 0) make_atlas_quit("cannot read a font");
        for (int size = 0; size < FONT_SIZES; size++) {
            if (FT_Set_Pixel_Sizes(face, 0, (FT_UInt)sizes[size]) != 0) make_atlas_quit("cannot set a size");
            FT_Pos figure = figure_advance(face);
            for (int j = 0; j < FONT_GLYPHS; j++)
                glyphs[i][size][j] = render(face, j < ASCII ? ASCII_FIRST + (unsigned)j : extra[j - ASCII], figure);
        }
        FT_Done_Face(face);
    }
    fputs("\";\n", output);
    print_glyphs(glyphs);
    FT_Done_FreeType(library);
    if (fclose(output) != 0) make_atlas_quit("cannot write the output");
    return 0;
}
