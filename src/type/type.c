/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "type/type.h"

#include "common/utf8.h"

#include <stddef.h>

enum { FIRST_MARK = 0x300, LAST_MARK = 0x36F };

typedef struct Composition {
    unsigned short letter, mark, composed;
} Composition;

static const Composition compositions[] = {
#include "type/compositions.inc"
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

const Glyph *type_find(const Typeface *face, unsigned code) {
    int low = 0, high = type_glyph_count;
    while (low < high) {
        int middle = (low + high) / 2;
        if (face->glyphs[middle].code < code)
            low = middle + 1;
        else
            high = middle;
    }
    return low < type_glyph_count && face->glyphs[low].code == code ? &face->glyphs[low] : NULL;
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
