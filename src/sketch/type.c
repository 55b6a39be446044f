/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sketch/type.h"

#include "common/utf8.h"

static const Glyph *find(unsigned code) {
    int low = 0, high = type_glyph_count;
    while (low < high) {
        int middle = (low + high) / 2;
        if (type_glyphs[middle].code < code)
            low = middle + 1;
        else
            high = middle;
    }
    return low < type_glyph_count && type_glyphs[low].code == code ? &type_glyphs[low] : find('?');
}

const Glyph *type_next(const char **text) { return find(utf8_next(text)); }

int type_advance(const char *text) {
    int advance = 0;
    while (*text != '\0') advance += type_next(&text)->advance;
    return advance;
}

double type_width(const char *text, double points) { return type_advance(text) * points * MM_PER_POINT / type_units; }
