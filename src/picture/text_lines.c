/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/text_lines.h"

#include <stdio.h>
#include <string.h>

/* Bytes of the first `length` of a text without the spaces at their end. */
static size_t without_spaces(const char *text, size_t length) {
    while (length > 0 && text[length - 1] == ' ') length--;
    return length;
}

static bool fits(const Font *font, const char *text, size_t length, int room) {
    char line[CAPTION_SIZE];
    snprintf(line, sizeof line, "%.*s", (int)length, text);
    return font_width(font, line) <= room;
}

/* Bytes of the first line: whole words, or what fits of the first word, but at least one character. */
static size_t line_length(const Font *font, const char *text, int room) {
    size_t words = 0, characters = 0;
    for (const char *next = text; *next != '\0';) {
        type_next_code(&next);
        const size_t length = (size_t)(next - text);
        if (!fits(font, text, without_spaces(text, length), room)) break;
        characters = length;
        if (*next == ' ' || *next == '\0') words = length;
    }
    if (words > 0 || characters > 0) return words > 0 ? words : characters;
    const char *next = text;
    type_next_code(&next);
    return (size_t)(next - text);
}

/* If no word fits beside the numbers, the text begins below them. */
static bool begins_below(const Font *font, const char *text, int first, int others) {
    const size_t word = strcspn(text, " ");
    return !fits(font, text, word, first) && first < others && fits(font, text, word, others);
}

TextLines text_lines(const Font *font, const char *text, int first, int others) {
    TextLines result = {.count = begins_below(font, text, first, others)};
    do {
        const size_t length = line_length(font, text, result.count == 0 ? first : others);
        const bool last = result.count >= TEXT_LINES_MAX - 1;
        if (result.count < TEXT_LINES_MAX)
            snprintf(result.lines[result.count], CAPTION_SIZE, "%.*s",
                     (int)(last ? strlen(text) : without_spaces(text, length)), text);
        result.count++;
        text += length;
        while (*text == ' ') text++;
    } while (*text != '\0');
    return result;
}
