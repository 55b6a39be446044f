/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The text of a YAML file: checks before parsing, and excerpts with a caret. */
#include "yaml/source.h"

#include "common/file.h"
#include "common/utf8.h"

#include <limits.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Characters of the line in an excerpt, and the most of them before the caret. */
enum { EXCERPT_WIDTH = 100, EXCERPT_BEFORE = 70 };

/* Control characters could control the terminal; direction marks could disguise the line. */
static bool prints(uint32_t c) {
    if (c < 0x20 || (c >= 0x7f && c < 0xa0)) return false;
    return !((c >= 0x200b && c <= 0x200f) || (c >= 0x2028 && c <= 0x202e) || (c >= 0x2060 && c <= 0x206f) ||
             c == 0xfeff);
}

/* Copies one character or '?' to out (room for 5 bytes); returns the bytes read and adds those written. */
static size_t copy_character(char *out, size_t *written, const char *text, size_t size) {
    uint32_t character;
    size_t length = utf8_decode(text, size, &character);
    if (length > 0 && (prints(character) || character == '\t')) {
        memcpy(out + *written, text, length);
        *written += length;
    } else {
        out[(*written)++] = '?';
    }
    out[*written] = '\0';
    return length > 0 ? length : 1;
}

void source_printable(char *out, size_t room, const char *text) {
    size_t size = strlen(text), written = 0, read = 0;
    out[0] = '\0';
    while (read < size) {
        if (written + 8 > room) { /* one character of 4 bytes, "..." and the NUL */
            strcpy(out + written, "...");
            return;
        }
        read += copy_character(out, &written, text + read, size - read);
        if (out[written - 1] == '\t') out[written - 1] = ' ';
    }
}

static bool ends_line(char c) { return c == '\n' || c == '\r'; }

/* The end of the line that contains `at`; "\r\n" is one end, as in YAML. */
static size_t next_line(const Source *source, size_t at) {
    while (at < source->size && !ends_line(source->text[at])) at++;
    if (at < source->size) at += source->text[at] == '\r' && source->text[at + 1] == '\n' ? 2 : 1;
    return at;
}

static bool in_line(const Source *source, size_t at) { return at < source->size && !ends_line(source->text[at]); }

/* Bytes of the character at `at`; 1 for a byte that is not UTF-8. */
static size_t character_length(const Source *source, size_t at) {
    uint32_t character;
    size_t length = utf8_decode(source->text + at, source->size - at, &character);
    return length > 0 ? length : 1;
}

/* Start of a place's line. The end of the file is shown after its last line, not on an empty line below. *place is
   moved into the line if it is beyond its end. */
static size_t find_place(const Source *source, Place *place) {
    size_t start = 0;
    for (int line = 0; line < place->line; line++) {
        size_t next = next_line(source, start);
        if (next >= source->size) *place = (Place){line, INT_MAX};
        start = next < source->size ? next : start;
    }
    int column = 0;
    for (size_t at = start; column < place->column && in_line(source, at); column++) at += character_length(source, at);
    place->column = column;
    return start;
}

size_t source_offset(const Source *source, Place place) {
    size_t at = find_place(source, &place);
    for (int column = 0; column < place.column; column++) at += character_length(source, at);
    return at;
}

/* Prints the excerpt of the line, and below it blanks up to the caret. */
typedef struct Excerpt {
    char line[4 * EXCERPT_WIDTH + 8], blanks[EXCERPT_WIDTH];
} Excerpt;

static Excerpt excerpt_line(const Source *source, size_t start, int column) {
    Excerpt excerpt;
    size_t written = 0, blanks = 0, at = start;
    int first = column > EXCERPT_BEFORE ? column - EXCERPT_BEFORE : 0;
    for (int i = 0; i < first; i++) at += character_length(source, at);
    if (first > 0) {
        written = blanks = strlen(strcpy(excerpt.line, "..."));
        memset(excerpt.blanks, ' ', blanks);
    }
    for (int i = first; in_line(source, at); i++) {
        if (i == first + EXCERPT_WIDTH) {
            memcpy(excerpt.line + written, "...", 3);
            written += 3;
            break;
        }
        if (i < column) excerpt.blanks[blanks++] = source->text[at] == '\t' ? '\t' : ' ';
        at += copy_character(excerpt.line, &written, source->text + at, source->size - at);
    }
    excerpt.line[written] = excerpt.blanks[blanks] = '\0';
    return excerpt;
}

bool source_error(const Source *source, Place place, Error *error, const char *format, ...) {
    char what[512], where[1280], number[16];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);

    size_t start = find_place(source, &place);
    Excerpt excerpt = excerpt_line(source, start, place.column);
    snprintf(where, sizeof where, "%.1200s:%d:%d", source->path, place.line + 1, place.column + 1);
    snprintf(number, sizeof number, "%5d", place.line + 1);
    return error_input(error, where, "%s\n%s | %s\n%*s | %s^", what, number, excerpt.line, (int)strlen(number), "",
                       excerpt.blanks);
}

/* What libyaml refuses without a place, and what it takes for the end of a line but editors do not. */
static bool is_allowed(uint32_t character) {
    return !(character >= 0x80 && character < 0xa0) && character != 0x2028 && character != 0x2029 &&
           character != 0xfeff && character != 0xfffe && character != 0xffff;
}

static bool check_character(const Source *source, size_t at, uint32_t character, Place *place, Error *error) {
    if (ends_line(source->text[at])) {
        bool inside_pair = source->text[at] == '\r' && source->text[at + 1] == '\n';
        *place = (Place){place->line + !inside_pair, 0};
        return true;
    }
    if ((character < 0x20 && character != '\t') || character == 0x7f)
        return source_error(source, *place, error, "control character 0x%02x", (unsigned)character);
    if (!is_allowed(character))
        return source_error(source, *place, error, "the character U+%04X is not allowed", (unsigned)character);
    if (place->column == 0 && character == '%')
        return source_error(source, *place, error, "YAML directives are not allowed");
    place->column++;
    return true;
}

static bool check_text(const Source *source, Error *error) {
    Place place = {0, 0};
    for (size_t at = 0, length; at < source->size; at += length) {
        uint32_t character;
        length = utf8_decode(source->text + at, source->size - at, &character);
        if (length == 0) return source_error(source, place, error, "not UTF-8 text");
        if (!check_character(source, at, character, &place, error)) return false;
    }
    return true;
}

bool source_read(Source *source, const char *path, Error *error) {
    static const char byte_order_mark[] = "\xef\xbb\xbf";
    *source = (Source){.path = path};
    source->text = file_read(path, SOURCE_MAX_SIZE, &source->size, error);
    if (source->text == NULL) return false;
    if (source->size >= 3 && memcmp(source->text, byte_order_mark, 3) == 0) {
        source->size -= 3;
        memmove(source->text, source->text + 3, source->size + 1);
    }
    if (check_text(source, error)) return true;
    source_free(source);
    return false;
}

void source_free(Source *source) {
    free(source->text);
    source->text = NULL;
}
