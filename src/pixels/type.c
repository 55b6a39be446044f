/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Characters and the glyphs that draw them, the check of texts, and the font as files. */
#include "pixels/type.h"

#include "base/base.h"

#include <limits.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_MARK = 0x300, LAST_MARK = 0x36F };

typedef struct Composition {
    unsigned short letter, mark, composed;
} Composition;

static const Composition compositions[] = {
#include "pixels/compositions.inc"
};

static unsigned compose(unsigned letter, unsigned mark) {
    size_t low = 0, high = sizeof compositions / sizeof compositions[0];
    while (low < high) {
        const size_t middle = (low + high) / 2;
        const Composition *at = &compositions[middle];
        if (at->letter == letter && at->mark == mark) return at->composed;
        if (at->letter < letter || (at->letter == letter && at->mark < mark))
            low = middle + 1;
        else
            high = middle;
    }
    return 0;
}

static int compare_code(const void *code, const void *glyph) {
    const unsigned wanted = *(const unsigned *)code, found = ((const Glyph *)glyph)->code;
    return (wanted > found) - (wanted < found);
}

const Glyph *type_find(const Typeface *face, unsigned code) {
    return bsearch(&code, face->glyphs, (size_t)type_glyph_count, sizeof *face->glyphs, compare_code);
}

void outline_trace(OutlineTracer *tracer, const Typeface *face, const Glyph *glyph) {
    const OutlineStep *first = face->steps + glyph->first, *step = first, *end = first + glyph->steps;
    Point start = {0}, at = {0};
    for (; step < end; step += step->kind == OUTLINE_CURVE ? 3 : 1) {
        const Point next = tracer->place(tracer, step->kind == OUTLINE_CURVE ? step + 2 : step);
        if (step->kind == OUTLINE_CURVE) {
            const Point b = tracer->place(tracer, step), c = tracer->place(tracer, step + 1);
            Point from = at;
            for (int i = 1; i <= tracer->parts; i++) {
                const double t = (double)i / tracer->parts, s = 1 - t;
                const Point to = {s * s * s * at.x + 3 * s * s * t * b.x + 3 * s * t * t * c.x + t * t * t * next.x,
                                  s * s * s * at.y + 3 * s * s * t * b.y + 3 * s * t * t * c.y + t * t * t * next.y};
                tracer->line(tracer, from, to);
                from = to;
            }
        } else if (step->kind == OUTLINE_LINE)
            tracer->line(tracer, at, next);
        else {
            if (step > first) tracer->line(tracer, at, start);
            start = next;
        }
        at = next;
    }
    if (glyph->steps > 0) tracer->line(tracer, at, start);
}

unsigned type_next_code(const char **text) {
    unsigned code = utf8_next(text);
    for (const char *next = *text; *next != '\0'; *text = next) {
        const unsigned mark = utf8_next(&next),
                       composed = mark >= FIRST_MARK && mark <= LAST_MARK ? compose(code, mark) : 0;
        if (composed == 0) break;
        code = composed;
    }
    return code;
}

const Glyph *type_next(const char **text) {
    const Glyph *glyph = type_find(&type_regular, type_next_code(text));
    return glyph != NULL ? glyph : type_find(&type_regular, '?');
}

int type_advance(const char *text) {
    int advance = 0;
    while (*text != '\0') advance += type_next(&text)->advance;
    return advance;
}

double type_width(const char *text, double points) { return type_advance(text) * points * MM_PER_POINT / type_units; }

bool type_check(const char *text, const char *where, Error *error) {
    if (text == NULL) return true;
    for (const char *next = text; *next != '\0';) {
        const char *from = next;
        uint32_t first;
        if (utf8_decode(from, strnlen(from, 4), &first) == 0)
            return error_input(error, where, "byte %d of the text is 0x%02X, which is not UTF-8",
                               (int)(from - text) + 1, (unsigned)(unsigned char)*from);
        const unsigned code = type_next_code(&next);
        if (type_find(&type_regular, code) != NULL) continue;
        if (code < 0x20 || (code >= 0x7F && code < 0xA0))
            return error_input(error, where, "the text has the control character U+%04X, which cannot be drawn", code);
        if (code >= FIRST_MARK && code <= LAST_MARK) /* alone it would be drawn over the quotation mark */
            return error_input(error, where,
                               "the text has the combining mark U+%04X after a letter that it does not compose with; "
                               "write the composed character",
                               code);
        return error_input(
            error, where, "the font has no character '%.*s' (U+%04X); it has Latin, Greek, Cyrillic and common symbols",
            (int)(next - from), from, code);
    }
    return true;
}

bool font_file_suffices(const char *text) {
    while (*text != '\0')
        if (type_next(&text)->index >= type_small_count) return false;
    return true;
}

FontFile font_file(bool small) {
    return small ? (FontFile){font_inter_regular_subset_otf, font_inter_regular_subset_otf_size, type_small_count}
                 : (FontFile){font_inter_regular_otf, font_inter_regular_otf_size, UINT_MAX};
}
