/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/utf8.h"

#include <string.h>

size_t utf8_decode(const char *text, size_t size, uint32_t *character) {
    static const uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
    if (size == 0) return 0;
    unsigned char lead = (unsigned char)text[0];
    size_t length = lead < 0x80 ? 1 : lead < 0xc0 ? 0 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : lead < 0xf8 ? 4 : 0;
    if (length == 0 || length > size) return 0;
    uint32_t c = length == 1 ? lead : lead & (0x7fu >> length);
    for (size_t i = 1; i < length; i++) {
        if (((unsigned char)text[i] & 0xc0) != 0x80) return 0;
        c = c << 6 | ((unsigned char)text[i] & 0x3fu);
    }
    if (c < smallest[length] || c > 0x10ffff || (c >= 0xd800 && c <= 0xdfff)) return 0;
    *character = c;
    return length;
}

uint32_t utf8_next(const char **text) {
    uint32_t character;
    size_t length = utf8_decode(*text, strnlen(*text, 4), &character);
    *text += length > 0 ? length : 1;
    return length > 0 ? character : 0xfffd;
}

size_t utf8_cut(const char *text, size_t limit) {
    const char *end = text;
    for (const char *next = text; *next != '\0'; end = next) {
        utf8_next(&next);
        if ((size_t)(next - text) > limit) break;
    }
    return (size_t)(end - text);
}

size_t utf8_encode(char *out, uint32_t character) {
    static const uint32_t above[] = {0x80, 0x800, 0x10000};
    static const unsigned char leads[] = {0, 0xc0, 0xe0, 0xf0};
    size_t length = 1;
    while (length < 4 && character >= above[length - 1]) length++;
    for (size_t i = length; i-- > 1; character >>= 6) out[i] = (char)(0x80 | (character & 0x3f));
    out[0] = (char)(leads[length - 1] | character);
    return length;
}
