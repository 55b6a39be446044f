/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "type/type_check.h"

#include "common/utf8.h"
#include "type/type.h"

#include <stddef.h>
#include <stdint.h>
#include <string.h>

static bool is_control(unsigned code) { return code < 0x20 || (code >= 0x7F && code < 0xA0); }

/* Marks are not shown: alone they would be drawn over the quotation mark. */
static bool is_mark(unsigned code) { return code >= 0x300 && code <= 0x36F; }

static bool refuse(unsigned code, const char *from, const char *end, const char *where, Error *error) {
    if (is_control(code))
        return error_input(error, where, "the text has the control character U+%04X, which cannot be drawn", code);
    if (is_mark(code))
        return error_input(error, where,
                           "the text has the combining mark U+%04X after a letter that it does not compose with; write "
                           "the composed character",
                           code);
    return error_input(error, where,
                       "the font has no character '%.*s' (U+%04X); it has Latin, Greek, Cyrillic and common symbols",
                       (int)(end - from), from, code);
}

bool type_check(const char *text, const char *where, Error *error) {
    if (text == NULL) return true;
    for (const char *next = text; *next != '\0';) {
        const char *from = next;
        uint32_t first;
        if (utf8_decode(from, strnlen(from, 4), &first) == 0)
            return error_input(error, where, "byte %d of the text is 0x%02X, which is not UTF-8",
                               (int)(from - text) + 1, (unsigned)(unsigned char)*from);
        const unsigned code = type_next_code(&next);
        if (type_find(&type_regular, code) == NULL) return refuse(code, from, next, where, error);
    }
    return true;
}
