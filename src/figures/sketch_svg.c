/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sketch as SVG 1.1, in mm. Text is text: it can be searched and edited. The font is embedded; programs that ignore
   it take the next of its family, and alignment holds with any. As outlines text looks the same everywhere; then
   aria-label holds its content. */
#include "base/base.h"
#include "base/file.h"
#include "figures/sketch.h"
#include "figures/sketch_writers.h"
#include "pictures/page.h"
#include "pixels/png.h"
#include "pixels/type.h"

#include <math.h>
#include <stdlib.h>

/* The fonts of texts, best first. */
#define SVG_FONTS "Inter, 'Helvetica Neue', Helvetica, Arial, 'Liberation Sans', sans-serif"

static void write_glyph(FILE *file, const Glyph *glyph) {
    static const char letters[] = "MLC";
    fprintf(file, "<path id=\"g%u\" d=\"", glyph->index);
    for (int i = glyph->first; i < glyph->first + glyph->steps; i++) {
        const OutlineStep *step = &type_regular.steps[i];
        if (step->kind == OUTLINE_MOVE && i > glyph->first) fputc('Z', file);
        fprintf(file, "%c%d %d", letters[step->kind], step->x, step->y);
        if (step->kind != OUTLINE_CURVE) continue;
        fprintf(file, " %d %d %d %d", step[1].x, step[1].y, step[2].x, step[2].y);
        i += 2;
    }
    fprintf(file, "Z\"/>\n");
}

/* Defines the glyphs that the texts use. */
static bool write_glyphs(FILE *file, const Sketch *sketch) {
    bool *used = calloc((size_t)type_glyph_count, sizeof *used);
    if (used == NULL) return false;
    for (size_t i = 0; i < sketch->mark_count; i++) {
        if (sketch->marks[i].kind != MARK_TEXT) continue;
        for (const char *text = sketch->texts + sketch->marks[i].text; *text != '\0';)
            used[type_next(&text) - type_regular.glyphs] = true;
    }
    fprintf(file, "<defs>\n");
    for (int i = 0; i < type_glyph_count; i++)
        if (used[i] && type_regular.glyphs[i].steps > 0) write_glyph(file, &type_regular.glyphs[i]);
    fprintf(file, "</defs>\n");
    free(used);
    return true;
}

/* Characters not allowed in XML and bytes that are not UTF-8 become '?'. */
static void write_escaped(FILE *file, const char *text) {
    for (const char *begin = text; *text != '\0';) {
        const char *from = text;
        unsigned code = utf8_next(&text);
        switch (code) {
        case '&': fputs("&amp;", file); break;
        case '<': fputs("&lt;", file); break;
        case '"': fputs("&quot;", file); break;
        default:
            if (code == '>' && from - begin >= 2 && from[-1] == ']' && from[-2] == ']') /* ends a CDATA section only */
                fputs("&gt;", file);
            else if (code < ' ' || code == 0xFFFD || code >= 0xFFFE)
                fputc('?', file);
            else
                fwrite(from, 1, (size_t)(text - from), file);
        }
    }
}

static void write_halo(FILE *file, double width) {
    fprintf(file, " stroke=\"#FFFFFF\" stroke-width=\"%.4g\" stroke-linejoin=\"round\" paint-order=\"stroke\"", width);
}

/* The point of a text's baseline at its anchor, and its turn. */
static void write_text(FILE *file, const Sketch *sketch, const SketchMark *mark) {
    static const char *const anchors[] = {"start", "middle", "end"};
    const TextStyle *style = &mark->style;
    const double em = style->points * MM_PER_POINT, down = TYPE_MIDDLE * em, angle = style->degrees * M_PI / 180;
    fprintf(file, "<text transform=\"translate(%.3f %.3f)", mark->at.x + down * sin(angle),
            sketch->height - mark->at.y + down * cos(angle));
    if (style->degrees != 0) fprintf(file, " rotate(%g)", -style->degrees);
    fprintf(file, "\" font-size=\"%.4f\" fill=\"#%06X\"", em, style->colour);
    if (style->align != TEXT_LEFT) fprintf(file, " text-anchor=\"%s\"", anchors[style->align]);
    if (style->halo) write_halo(file, 2 * HALO_SHARE * em);
    fputs(">", file);
    write_escaped(file, sketch->texts + mark->text);
    fputs("</text>\n", file);
}

static void write_outlines(FILE *file, const Sketch *sketch, const SketchMark *mark) {
    const char *text = sketch->texts + mark->text;
    const TextPlace place = text_place(sketch, mark);
    const double unit = place.em / type_units;
    fprintf(file, "<g role=\"img\" aria-label=\"");
    write_escaped(file, text);
    fprintf(file, "\" transform=\"matrix(%.6f %.6f %.6f %.6f %.3f %.3f)\" fill=\"#%06X\"", unit * place.cosine,
            -unit * place.sine, -unit * place.sine, -unit * place.cosine, place.from.x, sketch->height - place.from.y,
            mark->style.colour);
    if (mark->style.halo) write_halo(file, 2 * HALO_SHARE * type_units);
    fputs(">", file);
    for (int x = 0; *text != '\0';) {
        const Glyph *glyph = type_next(&text);
        if (glyph->steps > 0) fprintf(file, "<use xlink:href=\"#g%u\" x=\"%d\"/>", glyph->index, x);
        x += glyph->advance;
    }
    fputs("</g>\n", file);
}

static void write_path(FILE *file, const Sketch *sketch, const SketchMark *mark) {
    const Pen *pen = &mark->pen;
    double dashes[DASHES_MAX];
    fprintf(file, "<path d=\"");
    for (size_t i = 0; i < mark->count; i++) {
        Point p = sketch->points[mark->first + i];
        fprintf(file, "%s%.3f %.3f", i == 0 ? "M" : "L", p.x, sketch->height - p.y);
    }
    fprintf(file, "%s\"", mark->closed ? "Z" : "");
    if (mark->closed && pen->fill != NO_COLOUR) {
        fprintf(file, " fill=\"#%06X\"", pen->fill);
        if (pen->opacity < 1) fprintf(file, " fill-opacity=\"%.3f\"", pen->opacity);
    } else
        fprintf(file, " fill=\"none\"");
    if (pen->line != NO_COLOUR)
        fprintf(file, " stroke=\"#%06X\" stroke-width=\"%.3f\" stroke-linejoin=\"round\"", pen->line,
                pen->width * LINE_UNIT);
    int count = pen->line != NO_COLOUR ? pen_dashes(pen, dashes) : 0;
    for (int i = 0; i < count; i++) fprintf(file, "%s%.3f", i == 0 ? " stroke-dasharray=\"" : " ", dashes[i]);
    fprintf(file, "%s/>\n", count > 0 ? "\"" : "");
}

static bool write_image(FILE *file, const Sketch *sketch, const SketchMark *mark, Error *error) {
    size_t size;
    char *png = picture_as_png(mark->image, 0, false, &size, error);
    if (png == NULL) return false;
    const double height = mark->width * mark->image->height / mark->image->width;
    fprintf(file,
            "<image x=\"%.3f\" y=\"%.3f\" width=\"%.3f\" height=\"%.3f\" preserveAspectRatio=\"none\" "
            "xlink:href=\"data:image/png;base64,",
            mark->at.x, sketch->height - mark->at.y - height, mark->width, height);
    base64_put(file, png, size);
    fprintf(file, "\"/>\n");
    free(png);
    return true;
}

static bool write_head(FILE *file, const Sketch *sketch, const SketchOutput *output) {
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" version=\"1.1\" "
            "width=\"%.3fmm\" height=\"%.3fmm\" viewBox=\"0 0 %.3f %.3f\"",
            sketch->width, sketch->height, sketch->width, sketch->height);
    if (!output->outlines) fprintf(file, " font-family=\"" SVG_FONTS "\"");
    fprintf(file, ">\n");
    if (sketch->title[0] != '\0') {
        fprintf(file, "<title>");
        write_escaped(file, sketch->title);
        fprintf(file, "</title>\n");
    }
    if (output->outlines) return write_glyphs(file, sketch);
    /* For texts the font, so that browsers show the same letters on every machine. */
    const FontFile font = sketch_font(sketch);
    fprintf(file, "<style>@font-face{font-family:Inter;src:url(data:font/otf;base64,");
    base64_put(file, (const char *)font.bytes, font.size);
    fprintf(file, ")}</style>\n");
    return true;
}

static bool write_document(FILE *file, const Sketch *sketch, const SketchOutput *output, Error *error) {
    size_t *order = sketch_order(sketch);
    bool whole = (order != NULL && write_head(file, sketch, output)) || error_memory(error, "figure");
    if (!output->transparent) fprintf(file, "<rect width=\"100%%\" height=\"100%%\" fill=\"#FFFFFF\"/>\n");
    for (size_t i = 0; whole && i < sketch->mark_count; i++) {
        const SketchMark *mark = &sketch->marks[order[i]];
        switch (mark->kind) {
        case MARK_IMAGE: whole = write_image(file, sketch, mark, error); break;
        case MARK_PATH: write_path(file, sketch, mark); break;
        case MARK_TEXT: (output->outlines ? write_outlines : write_text)(file, sketch, mark); break;
        }
    }
    fprintf(file, "</svg>\n");
    free(order);
    return whole;
}

char *sketch_as_svg(const Sketch *sketch, const SketchOutput *output, size_t *size, Error *error) {
    char *data = NULL;
    FILE *file = memory_stream(&data, size);
    if (file == NULL) return error_memory(error, "figure"), NULL;
    bool whole = write_document(file, sketch, output, error);
    whole = whole && (!ferror(file) || error_memory(error, "figure"));
    if (fclose(file) == 0 && whole) return data;
    free(data);
    if (whole) error_memory(error, "figure");
    return NULL;
}
