/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The objects of a PDF file and of its font. */
#include "base/base.h"
#include "base/file.h"
#include "figures/sketch.h"
#include "figures/sketch_writers.h"
#include "pixels/png.h"
#include "pixels/type.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* Object numbers. Pictures follow, each with its alpha after it. */
enum { CATALOG = 1, PAGES, PDF_PAGE, CONTENT, FONT, CID_FONT, DESCRIPTOR, FONT_FILE, TO_UNICODE, INFO, FIRST_IMAGE };

typedef struct Pdf {
    FILE *file;
    const Sketch *sketch;
    size_t *offsets; /* byte offset of each object, by number */
    int count;       /* number of objects, including number 0 */
} Pdf;

/* Metrics of Inter, in 1/1000 em: viewers use them only if the embedded font fails. */
enum { FONT_ASCENT = 969, FONT_DESCENT = -241, FONT_CAPS = 727 };

static void pdf_begin_object(Pdf *pdf, int number) {
    pdf->offsets[number] = (size_t)ftell(pdf->file);
    fprintf(pdf->file, "%d 0 obj\n", number);
}

/* A compressed stream; `keys`: dictionary entries besides length and filter. False if out of memory. */
static bool pdf_write_stream(Pdf *pdf, int number, const char *keys, const void *data, size_t size) {
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

/* A text string in UTF-16, "<FEFF...>": titles, and texts that replace others. */
static void pdf_put_text(FILE *file, const char *text) {
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

/* The character of each glyph, so that text can be copied. */
static bool write_to_unicode(Pdf *pdf, const FontFile *font) {
    enum { MAX_ENTRIES = 100 }; /* the maximum length of a list */
    char *text = NULL;
    size_t size = 0;
    FILE *map = memory_stream(&text, &size);
    if (map == NULL) return false;
    fprintf(map, "/CIDInit /ProcSet findresource begin\n12 dict begin\nbegincmap\n/CMapName /Inter def\n"
                 "/CMapType 2 def\n1 begincodespacerange\n<0000> <FFFF>\nendcodespacerange\n");
    int left = 0, listed = 0;
    for (int i = 0; i < type_glyph_count; i++) left += type_regular.glyphs[i].index < font->glyphs;
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

/* Writes the objects FONT to TO_UNICODE. False if out of memory. */
static bool pdf_write_font(Pdf *pdf) {
    size_t size = 0;
    const FontFile font = sketch_font(pdf->sketch);
    /* The table of an OpenType file that holds the outlines; PDF embeds it alone. */
    const unsigned char *outlines = NULL;
    const unsigned tables = read_big_endian(font.bytes + 4, 2);
    for (unsigned i = 0; i < tables && outlines == NULL; i++) {
        const unsigned char *entry = font.bytes + 12 + 16 * i;
        if (memcmp(entry, "CFF ", 4) != 0) continue;
        size = read_big_endian(entry + 12, 4);
        outlines = font.bytes + read_big_endian(entry + 8, 4);
    }
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

/* A sketch as PDF 1.5 (ISO 32000-1): one page with its embedded font and its title, without date and document ID. Text
   can be searched and copied. */

static void write_colour(FILE *content, uint32_t colour, bool line) {
    fprintf(content, "%.4f %.4f %.4f %s\n", (colour >> 16 & 255) / 255.0, (colour >> 8 & 255) / 255.0,
            (colour & 255) / 255.0, line ? "RG" : "rg");
}

/* Opacities are named by their value in thousandths. */
static int opacity_number(const Pen *pen) { return (int)lrint(1000 * pen->opacity); }

static bool is_filled(const SketchMark *mark) { return mark->closed && mark->pen.fill != NO_COLOUR; }

static void write_path(FILE *content, const Sketch *sketch, const SketchMark *mark) {
    const Pen *pen = &mark->pen;
    double dashes[DASHES_MAX];
    bool line = pen->line != NO_COLOUR;
    if (!line && !is_filled(mark)) return;
    fprintf(content, "q 1 j\n");
    if (is_filled(mark)) {
        write_colour(content, pen->fill, false);
        if (pen->opacity < 1) fprintf(content, "/o%d gs\n", opacity_number(pen));
    }
    if (line) {
        write_colour(content, pen->line, true);
        fprintf(content, "%.3f w\n", pen->width * LINE_UNIT);
        int count = pen_dashes(pen, dashes);
        for (int i = 0; i < count; i++) fprintf(content, "%s%.3f", i == 0 ? "[" : " ", dashes[i]);
        if (count > 0) fprintf(content, "] 0 d\n");
    }
    for (size_t i = 0; i < mark->count; i++) {
        Point p = sketch->points[mark->first + i];
        fprintf(content, "%.3f %.3f %s\n", p.x, p.y, i == 0 ? "m" : "l");
    }
    const char *const paints[2][2] = {{"n", "S"}, {"f", "B"}};
    fprintf(content, "%s%s Q\n", mark->closed ? "h " : "", paints[is_filled(mark)][line]);
}

/* As a path: a second text in the same place would be extracted, too. In font units. */
static void write_halo(FILE *content, const TextPlace *place, const char *text) {
    static const char operators[] = {[OUTLINE_MOVE] = 'm', [OUTLINE_LINE] = 'l', [OUTLINE_CURVE] = 'c'};
    const double unit = place->em / type_units;
    fprintf(content, "q %.8f %.8f %.8f %.8f %.3f %.3f cm\n", unit * place->cosine, unit * place->sine,
            -unit * place->sine, unit * place->cosine, place->from.x, place->from.y);
    write_colour(content, 0xFFFFFF, true);
    fprintf(content, "%.0f w 1 J 1 j\n", 2 * HALO_SHARE * type_units);
    for (int x = 0; *text != '\0';) {
        const Glyph *glyph = type_next(&text);
        for (int i = glyph->first; i < glyph->first + glyph->steps; i++) {
            const OutlineStep *step = &type_regular.steps[i];
            const int points = step->kind == OUTLINE_CURVE ? 3 : 1;
            if (step->kind == OUTLINE_MOVE && i > glyph->first) fprintf(content, "h\n");
            for (int k = 0; k < points; k++) fprintf(content, "%d %d ", x + step[k].x, step[k].y);
            fprintf(content, "%c\n", operators[step->kind]);
            i += points - 1;
        }
        if (glyph->steps > 0) fprintf(content, "h\n");
        x += glyph->advance;
    }
    fprintf(content, "S Q\n");
}

static void write_text(FILE *content, const Sketch *sketch, const SketchMark *mark) {
    const TextPlace place = text_place(sketch, mark);
    const char *text = sketch->texts + mark->text;
    if (mark->style.halo) write_halo(content, &place, text);
    if (mark->has_reads) {
        fprintf(content, "/Span<</ActualText");
        pdf_put_text(content, sketch->texts + mark->reads);
        fprintf(content, ">>BDC\n");
    }
    fprintf(content, "BT /F %.4f Tf %.5f %.5f %.5f %.5f %.3f %.3f Tm\n", place.em, place.cosine, place.sine,
            -place.sine, place.cosine, place.from.x, place.from.y);
    write_colour(content, mark->style.colour, false);
    fputc('<', content);
    while (*text != '\0') fprintf(content, "%04X", type_next(&text)->index);
    fprintf(content, "> Tj\nET\n");
    if (mark->has_reads) fprintf(content, "EMC\n");
}

static bool write_content(Pdf *pdf, const SketchOutput *output, const size_t *order) {
    const Sketch *sketch = pdf->sketch;
    const double points = 1 / MM_PER_POINT;
    char *text = NULL;
    size_t size = 0;
    int image = 0;
    FILE *content = memory_stream(&text, &size);
    if (content == NULL) return false;
    fprintf(content, "%.6f 0 0 %.6f 0 0 cm\n", points, points);
    if (!output->transparent) fprintf(content, "1 1 1 rg 0 0 %.3f %.3f re f\n", sketch->width, sketch->height);
    for (size_t i = 0; i < sketch->mark_count; i++) {
        const SketchMark *mark = &sketch->marks[order[i]];
        switch (mark->kind) {
        case MARK_IMAGE:
            fprintf(content, "q %.3f 0 0 %.3f %.3f %.3f cm /I%d Do Q\n", mark->width,
                    mark->width * mark->image->height / mark->image->width, mark->at.x, mark->at.y, image++);
            break;
        case MARK_PATH: write_path(content, sketch, mark); break;
        case MARK_TEXT: write_text(content, sketch, mark); break;
        }
    }
    bool whole = !ferror(content);
    whole = fclose(content) == 0 && whole && pdf_write_stream(pdf, CONTENT, "", text, size);
    free(text);
    return whole;
}

/* Writes consecutive channels of the pixels. */
static bool write_channels(Pdf *pdf, int number, const Image *image, int first, int channels, const char *keys) {
    size_t pixels = (size_t)image->width * (size_t)image->height;
    unsigned char *data = malloc(pixels * (size_t)channels);
    char all_keys[256];
    if (data == NULL) return false;
    for (size_t i = 0; i < pixels; i++)
        memcpy(data + i * (size_t)channels, image->pixels + 4 * i + first, (size_t)channels);
    snprintf(all_keys, sizeof all_keys, "/Type/XObject/Subtype/Image/Width %d/Height %d/BitsPerComponent 8%s",
             image->width, image->height, keys);
    bool done = pdf_write_stream(pdf, number, all_keys, data, pixels * (size_t)channels);
    free(data);
    return done;
}

static bool write_images(Pdf *pdf, const size_t *order) {
    int number = FIRST_IMAGE;
    for (size_t i = 0; i < pdf->sketch->mark_count; i++) {
        const SketchMark *mark = &pdf->sketch->marks[order[i]];
        if (mark->kind != MARK_IMAGE) continue;
        char keys[64];
        snprintf(keys, sizeof keys, "/ColorSpace/DeviceRGB/SMask %d 0 R", number + 1);
        if (!write_channels(pdf, number, mark->image, 0, 3, keys) ||
            !write_channels(pdf, number + 1, mark->image, 3, 1, "/ColorSpace/DeviceGray"))
            return false;
        number += 2;
    }
    return true;
}

static void write_page(Pdf *pdf, int images) {
    const double points = 1 / MM_PER_POINT;
    FILE *file = pdf->file;
    pdf_begin_object(pdf, CATALOG);
    fprintf(file, "<</Type/Catalog/Pages %d 0 R/Lang(en)/ViewerPreferences<</DisplayDocTitle true>>>>\nendobj\n",
            PAGES);
    pdf_begin_object(pdf, PAGES);
    fprintf(file, "<</Type/Pages/Kids[%d 0 R]/Count 1>>\nendobj\n", PDF_PAGE);
    pdf_begin_object(pdf, PDF_PAGE);
    fprintf(file,
            "<</Type/Page/Parent %d 0 R/MediaBox[0 0 %.3f %.3f]/Contents %d 0 R/Group<</S/Transparency"
            "/CS/DeviceRGB>>/Resources<</Font<</F %d 0 R>>/ExtGState<<",
            PAGES, points * pdf->sketch->width, points * pdf->sketch->height, CONTENT, FONT);
    bool named[1000] = {false};
    for (size_t i = 0; i < pdf->sketch->mark_count; i++) {
        const SketchMark *mark = &pdf->sketch->marks[i];
        if (mark->kind != MARK_PATH || !is_filled(mark)) continue;
        int number = opacity_number(&mark->pen);
        if (number < 0 || number >= 1000 || named[number]) continue;
        named[number] = true;
        fprintf(file, "/o%d<</ca %.3f>>", number, number / 1000.0);
    }
    fprintf(file, ">>/XObject<<");
    for (int i = 0; i < images; i++) fprintf(file, "/I%d %d 0 R", i, FIRST_IMAGE + 2 * i);
    fprintf(file, ">>>>>>\nendobj\n");
}

static bool write_document(Pdf *pdf, const SketchOutput *output, int images) {
    FILE *file = pdf->file;
    size_t *order = sketch_order(pdf->sketch);
    bool whole = order != NULL;
    fprintf(file, "%%PDF-1.5\n%%\xE2\xE3\xCF\xD3\n");
    if (whole) {
        write_page(pdf, images);
        /* Of the document's information only the title: a date or a program's version would change the bytes. */
        pdf_begin_object(pdf, INFO);
        fprintf(file, "<<");
        if (pdf->sketch->title[0] != '\0') {
            fprintf(file, "/Title");
            pdf_put_text(file, pdf->sketch->title);
        }
        fprintf(file, ">>\nendobj\n");
        whole = write_content(pdf, output, order) && pdf_write_font(pdf) && write_images(pdf, order);
    }
    if (whole) {
        const size_t start = (size_t)ftell(file);
        fprintf(file, "xref\n0 %d\n0000000000 65535 f \n", pdf->count);
        for (int i = 1; i < pdf->count; i++) fprintf(file, "%010zu 00000 n \n", pdf->offsets[i]);
        fprintf(file, "trailer\n<</Size %d/Root %d 0 R/Info %d 0 R>>\nstartxref\n%zu\n%%%%EOF\n", pdf->count, CATALOG,
                INFO, start);
    }
    free(order);
    return whole && !ferror(file);
}

char *sketch_as_pdf(const Sketch *sketch, const SketchOutput *output, size_t *size, Error *error) {
    int images = 0;
    for (size_t i = 0; i < sketch->mark_count; i++) images += sketch->marks[i].kind == MARK_IMAGE;
    char *data = NULL;
    Pdf pdf = {memory_stream(&data, size), sketch, NULL, FIRST_IMAGE + 2 * images};
    pdf.offsets = calloc((size_t)pdf.count, sizeof *pdf.offsets);
    bool whole = pdf.file != NULL && pdf.offsets != NULL && write_document(&pdf, output, images);
    if (pdf.file != NULL) whole = fclose(pdf.file) == 0 && whole;
    free(pdf.offsets);
    if (whole) return data;
    free(data);
    return error_memory(error, "figure"), NULL;
}
