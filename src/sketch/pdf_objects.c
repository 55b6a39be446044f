/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sketch/pdf_objects.h"

#include "common/memory_stream.h"
#include "common/utf8.h"
#include "sketch/sketch_formats.h"
#include "type/type.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* Metrics of Inter, in 1/1000 em: viewers use them only if the embedded font fails. */
enum { FONT_ASCENT = 969, FONT_DESCENT = -241, FONT_CAPS = 727 };

void pdf_begin_object(Pdf *pdf, int number) {
    pdf->offsets[number] = (size_t)ftell(pdf->file);
    fprintf(pdf->file, "%d 0 obj\n", number);
}

bool pdf_write_stream(Pdf *pdf, int number, const char *keys, const void *data, size_t size) {
    uLongf packed_size = compressBound((uLong)size);
    Bytef *packed = malloc(packed_size);
    bool done = packed != NULL && compress2(packed, &packed_size, data, (uLong)size, 9) == Z_OK;
    if (done) {
        pdf_begin_object(pdf, number);
        fprintf(pdf->file, "<<%s/Length %lu/Filter/FlateDecode>>\nstream\n", keys, (unsigned long)packed_size);
        fwrite(packed, 1, packed_size, pdf->file);
        fprintf(pdf->file, "\nendstream\nendobj\n");
    }
    free(packed);
    return done;
}

void pdf_put_text(FILE *file, const char *text) {
    fprintf(file, "<FEFF");
    while (*text != '\0') {
        const unsigned code = utf8_next(&text);
        if (code < 0x10000)
            fprintf(file, "%04X", code);
        else
            fprintf(file, "%04X%04X", 0xD800 + ((code - 0x10000) >> 10), 0xDC00 + ((code - 0x10000) & 0x3FF));
    }
    fputc('>', file);
}

static unsigned read_big_endian(const unsigned char *bytes, int count) {
    unsigned value = 0;
    for (int i = 0; i < count; i++) value = value << 8 | bytes[i];
    return value;
}

/* The table of an OpenType file that holds the outlines; PDF embeds it alone. */
static const unsigned char *find_outlines(const FontFile *font, size_t *size) {
    unsigned tables = read_big_endian(font->bytes + 4, 2);
    for (unsigned i = 0; i < tables; i++) {
        const unsigned char *entry = font->bytes + 12 + 16 * i;
        if (memcmp(entry, "CFF ", 4) != 0) continue;
        *size = read_big_endian(entry + 12, 4);
        return font->bytes + read_big_endian(entry + 8, 4);
    }
    return NULL;
}

static int count_glyphs(const FontFile *font) {
    int count = 0;
    for (int i = 0; i < type_glyph_count; i++) count += type_regular.glyphs[i].index < font->glyphs;
    return count;
}

/* The character of each glyph, so that text can be copied. */
static bool write_to_unicode(Pdf *pdf, const FontFile *font) {
    enum { MAX_ENTRIES = 100 }; /* the maximum length of a list */
    char *text = NULL;
    size_t size = 0;
    FILE *map = memory_stream(&text, &size);
    if (map == NULL) return false;
    fprintf(map, "/CIDInit /ProcSet findresource begin\n12 dict begin\nbegincmap\n/CMapName /Inter def\n"
                 "/CMapType 2 def\n1 begincodespacerange\n<0000> <FFFF>\nendcodespacerange\n");
    int left = count_glyphs(font), listed = 0;
    for (int i = 0; i < type_glyph_count; i++) {
        const Glyph *glyph = &type_regular.glyphs[i];
        if (glyph->index >= font->glyphs) continue;
        if (listed == 0) fprintf(map, "%d beginbfchar\n", left < MAX_ENTRIES ? left : MAX_ENTRIES);
        fprintf(map, "<%04X> <%04X>\n", glyph->index, glyph->code);
        listed = (listed + 1) % MAX_ENTRIES;
        if (--left == 0 || listed == 0) fprintf(map, "endbfchar\n");
    }
    fprintf(map, "endcmap\nend\nend\n");
    bool whole = !ferror(map);
    whole = fclose(map) == 0 && whole && pdf_write_stream(pdf, TO_UNICODE, "", text, size);
    free(text);
    return whole;
}

bool pdf_write_font(Pdf *pdf) {
    size_t size;
    const FontFile font = sketch_font(pdf->sketch);
    const unsigned char *outlines = find_outlines(&font, &size);
    pdf_begin_object(pdf, FONT);
    fprintf(pdf->file,
            "<</Type/Font/Subtype/Type0/BaseFont/TWNBOX+Inter/Encoding/Identity-H/DescendantFonts[%d 0 R]"
            "/ToUnicode %d 0 R>>\nendobj\n",
            CID_FONT, TO_UNICODE);
    pdf_begin_object(pdf, CID_FONT);
    fprintf(pdf->file,
            "<</Type/Font/Subtype/CIDFontType0/BaseFont/TWNBOX+Inter/CIDSystemInfo<</Registry(Adobe)"
            "/Ordering(Identity)/Supplement 0>>/FontDescriptor %d 0 R/W[",
            DESCRIPTOR);
    for (int i = 0; i < type_glyph_count; i++) {
        const Glyph *glyph = &type_regular.glyphs[i];
        if (glyph->index < font.glyphs)
            fprintf(pdf->file, "%u[%.3f]", glyph->index, 1000.0 * glyph->advance / type_units);
    }
    fprintf(pdf->file, "]>>\nendobj\n");
    pdf_begin_object(pdf, DESCRIPTOR);
    fprintf(pdf->file,
            "<</Type/FontDescriptor/FontName/TWNBOX+Inter/Flags 4/FontBBox[-1000 -400 2000 1200]/ItalicAngle 0"
            "/Ascent %d/Descent %d/CapHeight %d/StemV 80/FontFile3 %d 0 R>>\nendobj\n",
            FONT_ASCENT, FONT_DESCENT, FONT_CAPS, FONT_FILE);
    return outlines != NULL && pdf_write_stream(pdf, FONT_FILE, "/Subtype/CIDFontType0C", outlines, size) &&
           write_to_unicode(pdf, &font);
}
