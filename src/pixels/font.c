/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines of text, and bitmaps of glyphs that are not in the atlas, from their outlines. */
#include "pixels/gl.h"
#include "pixels/pixels_internal.h"
#include "pixels/raster.h"
#include "pixels/type.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = 16 };             /* of a curve: at the largest size a part deviates by less than a hundredth pixel */
enum { LEVELS = 51, LEVEL = 5 }; /* as in the atlas */
static const double OUTLINE_UNIT = 64; /* per pixel, of FontGlyph.advance and of points */

/* An outline in pixels, y down. */
typedef struct Tracer {
    OutlineTracer outline;
    double scale, left, top;
    Raster raster;
} Tracer;

/* Rounded as FreeType does, so that both kinds of glyphs in a word have equally sharp edges. */
static double round_to_grid(double pixels) { return floor(pixels * OUTLINE_UNIT + 0.5) / OUTLINE_UNIT; }

static Point place(const OutlineTracer *outline, const OutlineStep *step) {
    const Tracer *tracer = (const Tracer *)outline;
    return (Point){round_to_grid(step->x * tracer->scale) - tracer->left,
                   tracer->top - round_to_grid(step->y * tracer->scale)};
}

/* Only the bounds. */
static void widen(OutlineTracer *outline, Point from, Point to) {
    Raster *raster = &((Tracer *)outline)->raster;
    raster->x0 = fmin(raster->x0, fmin(from.x, to.x)), raster->x1 = fmax(raster->x1, fmax(from.x, to.x));
    raster->y0 = fmin(raster->y0, fmin(from.y, to.y)), raster->y1 = fmax(raster->y1, fmax(from.y, to.y));
}

FontGlyph glyph_metrics(const Typeface *face, const Glyph *glyph, int pixels) {
    Tracer tracer = {.outline = {place, widen, PARTS}, .scale = (double)pixels / type_units};
    Raster *bounds = &tracer.raster;
    FontGlyph metrics = {.code = glyph->code};
    metrics.advance = (short)floor(OUTLINE_UNIT * glyph->advance * tracer.scale + 0.5);
    if (glyph->steps == 0) return metrics;
    bounds->x0 = bounds->y0 = HUGE_VAL, bounds->x1 = bounds->y1 = -HUGE_VAL;
    outline_trace(&tracer.outline, face, glyph);
    metrics.left = (short)floor(bounds->x0), metrics.top = (short)-floor(bounds->y0);
    metrics.width = (short)(ceil(bounds->x1) - floor(bounds->x0));
    metrics.height = (short)(ceil(bounds->y1) - floor(bounds->y0));
    return metrics;
}

static void add_line(OutlineTracer *outline, Point from, Point to) {
    raster_add(&((Tracer *)outline)->raster, from, to);
}

typedef struct Bitmap {
    uint8_t *alpha;
    int width;
} Bitmap;

static void put_row(void *context, int left, int y, const double *shares, int count) {
    const Bitmap *bitmap = context;
    uint8_t *row = bitmap->alpha + (size_t)y * (size_t)bitmap->width + left;
    for (int x = 0; x < count; x++) row[x] = (uint8_t)((int)(shares[x] * LEVELS + 0.5) * LEVEL);
}

bool glyph_draw(const Typeface *face, const Glyph *glyph, int pixels, const FontGlyph *metrics, uint8_t *alpha) {
    Bitmap bitmap = {alpha, metrics->width};
    Tracer tracer = {.outline = {place, add_line, PARTS},
                     .scale = (double)pixels / type_units,
                     .left = metrics->left,
                     .top = metrics->top};
    outline_trace(&tracer.outline, face, glyph);
    raster_fill(&tracer.raster, &(Rect){0, 0, metrics->width, metrics->height}, put_row, &bitmap);
    const bool ok = !tracer.raster.failed;
    raster_free(&tracer.raster);
    return ok;
}

enum { PEN_UNIT = 64 }; /* pen positions are in 1/64 pixel, so that rounding errors of glyphs do not accumulate */
#define ELLIPSIS "\xE2\x80\xA6"

Font font_pick(FontFace face, double pixels) {
    static const Typeface *const faces[FONT_FACES] = {&type_regular, &type_semibold};
    Font font = {0};
    for (int i = 0; i < FONT_SIZES; i++)
        if (font_sizes[i] <= pixels) font = (Font){font_glyphs[face][i], faces[face], font_sizes[i]};
    return font;
}

static int compare_code(const void *code, const void *glyph) {
    const unsigned wanted = *(const unsigned *)code, found = ((const FontGlyph *)glyph)->code;
    return (wanted > found) - (wanted < found);
}

/* The next character of a text; '?' for one that neither has. `outline` is NULL if the bitmap is in the atlas. */
static FontGlyph next_glyph(const Font *font, const char **text, const Glyph **outline) {
    static const unsigned unknown = '?';
    const unsigned code = type_next_code(text);
    const FontGlyph *glyph = bsearch(&code, font->glyphs, FONT_GLYPHS, sizeof *glyph, compare_code);
    *outline = glyph == NULL ? type_find(font->face, code) : NULL;
    if (*outline != NULL) return glyph_metrics(font->face, *outline, font->pixels);
    if (glyph == NULL) glyph = bsearch(&unknown, font->glyphs, FONT_GLYPHS, sizeof *glyph, compare_code);
    return *glyph;
}

static int next_advance(const Font *font, const char **text) {
    const Glyph *outline;
    return next_glyph(font, text, &outline).advance;
}

static int to_pixels(int pen) { return (pen + PEN_UNIT - 1) / PEN_UNIT; }

int font_width(const Font *font, const char *text) {
    int pen = 0;
    while (font->glyphs != NULL && *text != '\0') pen += next_advance(font, &text);
    return to_pixels(pen);
}

/* Adds the characters before `end` and returns the pen. */
static int add_before(Drawing *drawing, const Font *font, const char *text, const char *end, int x, int baseline,
                      uint32_t color) {
    int pen = 0;
    while (text < end) {
        const Glyph *outline;
        const FontGlyph glyph = next_glyph(font, &text, &outline);
        int left = x + (pen + PEN_UNIT / 2) / PEN_UNIT + glyph.left;
        GlyphInstance instance = {
            {left, baseline - glyph.top, glyph.width, glyph.height}, glyph.offset, (uint32_t)glyph.width, color};
        if (outline != NULL) {
            const size_t size = (size_t)glyph.width * (size_t)glyph.height;
            uint8_t *bitmap = drawing_add_bitmap(drawing, size, &instance.bitmap);
            if (bitmap != NULL && !glyph_draw(font->face, outline, font->pixels, &glyph, bitmap))
                drawing->failed = true;
        }
        if (glyph.width > 0) drawing_add_glyph(drawing, &instance);
        pen += glyph.advance;
    }
    return x + to_pixels(pen);
}

int font_add(Drawing *drawing, const Font *font, const char *text, int x, int baseline, uint32_t color) {
    if (font->glyphs == NULL) return x;
    return add_before(drawing, font, text, text + strlen(text), x, baseline, color);
}

int font_add_fitting(Drawing *drawing, const Font *font, const char *text, int x, int baseline, int max_width,
                     uint32_t color) {
    if (font_width(font, text) <= max_width) return font_add(drawing, font, text, x, baseline, color);
    int room = (max_width - font_width(font, ELLIPSIS)) * PEN_UNIT, pen = 0;
    if (room < 0) return x;
    const char *end = text, *next = text;
    while (*next != '\0' && (pen += next_advance(font, &next)) <= room) end = next;
    while (end > text && end[-1] == ' ') end--;
    int end_x = add_before(drawing, font, text, end, x, baseline, color);
    return font_add(drawing, font, ELLIPSIS, end_x, baseline, color);
}
