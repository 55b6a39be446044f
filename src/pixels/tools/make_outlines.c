/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Build-time tool: prints the outlines and widths of two fonts as C (pixels/type.h) in unscaled font units, so that
   they do not depend on the version of FreeType. Usage: make_outlines REGULAR.otf SEMIBOLD.otf SMALL.otf OUTPUT.c; the
   characters of SMALL.otf must have the indices of REGULAR.otf there. */
#include "pixels/type.h"

#include <ft2build.h>
#include <stdio.h>
#include <stdlib.h>

#include FT_FREETYPE_H
#include FT_OUTLINE_H

enum { GLYPHS_MAX = 2048, STEPS_MAX = 1 << 17 };

static OutlineStep steps[STEPS_MAX];
static Glyph glyphs[GLYPHS_MAX];
static int step_count, glyph_count;

static void make_outlines_quit(const char *what) {
    fprintf(stderr, "make_outlines: %s\n", what);
    exit(1);
}

static void make_outlines_add(OutlineKind kind, const FT_Vector *to) {
    if (step_count == STEPS_MAX) make_outlines_quit("too many outlines");
    steps[step_count++] = (OutlineStep){(short)kind, (short)to->x, (short)to->y};
}

static int make_outlines_move(const FT_Vector *to, void *context) {
    (void)context;
    make_outlines_add(OUTLINE_MOVE, to);
    return 0;
}

static int line(const FT_Vector *to, void *context) {
    (void)context;
    make_outlines_add(OUTLINE_LINE, to);
    return 0;
}

static int conic(const FT_Vector *control, const FT_Vector *to, void *context) {
    (void)control, (void)to, (void)context;
    make_outlines_quit("the font has quadratic curves");
    return 1;
}

static int cubic(const FT_Vector *first, const FT_Vector *second, const FT_Vector *to, void *context) {
    (void)context;
    make_outlines_add(OUTLINE_CURVE, first);
    make_outlines_add(OUTLINE_CURVE, second);
    make_outlines_add(OUTLINE_CURVE, to);
    return 0;
}

static FT_Face open_font(FT_Library library, const char *path) {
    FT_Face face = NULL;
    if (FT_New_Face(library, path, 0, &face) != 0) make_outlines_quit("cannot read a font");
    return face;
}

static void write_face(FILE *output, FT_Face face, const char *name) {
    static const FT_Outline_Funcs functions = {make_outlines_move, line, conic, cubic, 0, 0};
    FT_UInt index;
    glyph_count = step_count = 0;
    for (FT_ULong code = FT_Get_First_Char(face, &index); index != 0; code = FT_Get_Next_Char(face, code, &index)) {
        const int first = step_count;
        if (glyph_count == GLYPHS_MAX) make_outlines_quit("too many characters");
        if (FT_Load_Glyph(face, index, FT_LOAD_NO_SCALE | FT_LOAD_NO_HINTING) != 0)
            make_outlines_quit("cannot load a glyph");
        if (FT_Outline_Decompose(&face->glyph->outline, &functions, NULL) != 0)
            make_outlines_quit("cannot read an outline");
        glyphs[glyph_count++] =
            (Glyph){(unsigned)code, index, (int)face->glyph->metrics.horiAdvance, first, step_count - first};
    }
    fprintf(output, "static const Glyph %s_glyphs[] = {\n", name);
    for (int i = 0; i < glyph_count; i++)
        fprintf(output, "{%u,%u,%d,%d,%d},\n", glyphs[i].code, glyphs[i].index, glyphs[i].advance, glyphs[i].first,
                glyphs[i].steps);
    fprintf(output, "};\nstatic const OutlineStep %s_steps[] = {\n", name);
    for (int i = 0; i < step_count; i++) fprintf(output, "{%d,%d,%d},\n", steps[i].kind, steps[i].x, steps[i].y);
    fprintf(output, "};\nconst Typeface type_%s = {%s_glyphs, %s_steps};\n", name, name, name);
}

int main(int argc, char **argv) {
    FT_Library library;
    FT_UInt index;
    if (argc != 5) make_outlines_quit("usage: make_outlines REGULAR.otf SEMIBOLD.otf SMALL.otf OUTPUT.c");
    FILE *output = fopen(argv[4], "w");
    if (output == NULL) make_outlines_quit("cannot write the output");
    if (FT_Init_FreeType(&library) != 0) make_outlines_quit("cannot start FreeType");
    FT_Face regular = open_font(library, argv[1]), semibold = open_font(library, argv[2]);
    FT_Face small = open_font(library, argv[3]);
    for (FT_ULong code = FT_Get_First_Char(small, &index); index != 0; code = FT_Get_Next_Char(small, code, &index))
        if (FT_Get_Char_Index(regular, code) != index)
            make_outlines_quit("a glyph of the small font has another index");
    fprintf(output, "#include \"pixels/type.h\"\n");
    write_face(output, regular, "regular");
    const int count = glyph_count;
    write_face(output, semibold, "semibold");
    if (glyph_count != count || semibold->units_per_EM != regular->units_per_EM)
        make_outlines_quit("the faces differ in kind");
    fprintf(output, "const int type_units = %d, type_glyph_count = %d;\nconst unsigned type_small_count = %ld;\n",
            regular->units_per_EM, count, small->num_glyphs);
    FT_Done_FreeType(library);
    if (fclose(output) != 0) make_outlines_quit("cannot write the output");
    return 0;
}
