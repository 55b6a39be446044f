/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/visible_text.h"

#include "common/utf8.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* A character as it is shown. */
typedef struct Shown {
    char text[8];
    size_t length, read; /* bytes, of the text that is shown and of the original */
} Shown;

static bool is_control(uint32_t c) { return c < 0x20 || (c >= 0x7f && c < 0xa0); }

unsigned control_in_text(const char *text) {
    while (*text != '\0') {
        const uint32_t c = utf8_next(&text);
        if (is_control(c)) return c;
    }
    return 0;
}

/* C1 controls, direction marks, ends of lines and paragraphs, and directional overrides (Unicode 15, chapter 23). */
static bool is_obeyed(uint32_t c) {
    return is_control(c) || c == 0x61c || c == 0x200e || c == 0x200f || (c >= 0x2028 && c <= 0x202e) ||
           (c >= 0x2066 && c <= 0x2069);
}

static Shown show(const char *text, VisibleLines lines) {
    uint32_t c = 0;
    const unsigned byte = (unsigned char)text[0];
    const size_t read = utf8_decode(text, strnlen(text, 4), &c);
    Shown shown = {.read = read > 0 ? read : 1};
    if (read == 1 && (c == '\n' || c == '\t') && lines == VISIBLE_LINES)
        shown.text[0] = (char)c;
    else if (read == 1 && c == '\n')
        strcpy(shown.text, "\\n");
    else if (read == 0 || c < 0x20 || c == 0x7f)
        snprintf(shown.text, sizeof shown.text, "\\x%02x", byte);
    else if (is_obeyed(c))
        snprintf(shown.text, sizeof shown.text, "\\u%04x", (unsigned)(uint16_t)c);
    else
        memcpy(shown.text, text, read);
    shown.length = strlen(shown.text);
    return shown;
}

/* Shows text from *at while it is at most `most` bytes; moves *at behind it. */
static size_t put(char *out, const char **at, size_t most, VisibleLines lines) {
    size_t length = 0;
    while (**at != '\0') {
        const Shown shown = show(*at, lines);
        if (length + shown.length > most) break;
        if (out != NULL) memcpy(out + length, shown.text, shown.length);
        length += shown.length;
        *at += shown.read;
    }
    return length;
}

size_t visible_text(char *out, size_t size, const char *text, VisibleLines lines) {
    static const char gap[] = "...";
    const char *at = text;
    size_t left = put(NULL, &at, SIZE_MAX, lines), length = 0;
    at = text;
    if (left >= size) {
        const size_t half = (size - sizeof gap) / 2;
        length = put(out, &at, half, lines);
        for (left -= length; left > half; at += show(at, lines).read) left -= show(at, lines).length;
        memcpy(out + length, gap, sizeof gap - 1);
        length += sizeof gap - 1;
    }
    length += put(out + length, &at, SIZE_MAX, lines);
    out[length] = '\0';
    return length;
}
