/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/json.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

void json_put(FILE *file, const char *text) {
    fputc('"', file);
    for (; *text != '\0'; text++) {
        unsigned char c = (unsigned char)*text;
        if (c == '"' || c == '\\')
            fprintf(file, "\\%c", c);
        else if (c < 0x20 || c == '<' || c == '>' || c == '&')
            fprintf(file, "\\u%04x", c);
        else
            fputc(c, file);
    }
    fputc('"', file);
}

JsonReader json_reader(const char *path, const char *text, Error *error) {
    return (JsonReader){.path = path, .start = text, .next = text, .error = error};
}

bool json_fail(JsonReader *reader, const char *format, ...) {
    char what[512], where[4200];
    int line = 1;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    for (const char *c = reader->start; c < reader->next; c++) line += *c == '\n';
    snprintf(where, sizeof where, "%s:%d", reader->path, line);
    if (!reader->failed) error_input(reader->error, where, "%s", what);
    reader->failed = true;
    return false;
}

static char peek(JsonReader *reader) {
    if (reader->failed) return '\0';
    reader->next += strspn(reader->next, " \t\r\n");
    return *reader->next;
}

static bool take(JsonReader *reader, char c) {
    if (peek(reader) != c) return false;
    reader->next++;
    return true;
}

static bool expect(JsonReader *reader, char c) { return take(reader, c) || json_fail(reader, "'%c' is missing", c); }

static bool next(JsonReader *reader, int *count, char open, char close) {
    if (*count == 0 ? !expect(reader, open) : reader->failed) return false;
    if (take(reader, close)) return false;
    return (*count)++ == 0 || expect(reader, ',');
}

bool json_next_item(JsonReader *reader, int *count) { return next(reader, count, '[', ']'); }

bool json_next_key(JsonReader *reader, int *count, char *key, size_t size) {
    return next(reader, count, '{', '}') && json_string(reader, key, size) && expect(reader, ':');
}

/* Four hex digits; -1 where there are none. */
static int read_unit(const char *text) {
    char digits[5] = "";
    strncat(digits, text, 4);
    if (strspn(digits, "0123456789abcdefABCDEF") != 4) return -1;
    return (int)strtol(digits, NULL, 16);
}

/* Of \u escapes only those that need no second: ours are of control characters. */
static int read_escape(JsonReader *reader) {
    static const char names[] = "\"\\/bfnrt", values[] = "\"\\/\b\f\n\r\t";
    const char *name = *reader->next != '\0' ? strchr(names, *reader->next) : NULL;
    if (name != NULL) {
        reader->next++;
        return values[name - names];
    }
    int unit = *reader->next == 'u' ? read_unit(reader->next + 1) : -1;
    if (unit < 1 || unit > 0x7F) return -1;
    reader->next += 5;
    return unit;
}

bool json_string(JsonReader *reader, char *value, size_t size) {
    size_t length = 0;
    if (!expect(reader, '"')) return false;
    while (*reader->next != '"') {
        int c = (unsigned char)*reader->next;
        if (c < 0x20) return json_fail(reader, "a string does not end");
        reader->next++;
        if (c == '\\' && (c = read_escape(reader)) < 0) return json_fail(reader, "an escape that is none here");
        if (length + 1 >= size) return json_fail(reader, "a string of %zu bytes or more", size);
        value[length++] = (char)c;
    }
    reader->next++;
    value[length] = '\0';
    return true;
}

static bool take_word(JsonReader *reader, const char *word) {
    size_t length = strlen(word);
    peek(reader);
    if (reader->failed || strncmp(reader->next, word, length) != 0) return false;
    reader->next += length;
    return true;
}

bool json_bool(JsonReader *reader, bool *value) {
    *value = take_word(reader, "true");
    return *value || take_word(reader, "false") || json_fail(reader, "neither true nor false");
}

bool json_null(JsonReader *reader) { return take_word(reader, "null"); }

static bool skip_string(JsonReader *reader) {
    reader->next++;
    for (; *reader->next != '"'; reader->next++) {
        if (*reader->next == '\\' && reader->next[1] != '\0') reader->next++;
        if ((unsigned char)*reader->next < 0x20) return json_fail(reader, "a string does not end");
    }
    reader->next++;
    return true;
}

static bool skip(JsonReader *reader, int depth) {
    char key[256];
    int count = 0;
    char c = peek(reader);
    if (depth == 0) return json_fail(reader, "nested too deep");
    if (c == '"') return skip_string(reader);
    if (c == '[')
        while (json_next_item(reader, &count)) skip(reader, depth - 1);
    else if (c == '{')
        while (json_next_key(reader, &count, key, sizeof key)) skip(reader, depth - 1);
    else {
        size_t length = strspn(reader->next, "+-.0123456789abcdefghijklmnopqrstuvwxyzE");
        if (length == 0) return json_fail(reader, "a value is missing");
        reader->next += length;
    }
    return !reader->failed;
}

bool json_skip(JsonReader *reader) {
    enum { DEPTH = 16 };
    return !reader->failed && skip(reader, DEPTH);
}

bool json_end(JsonReader *reader) {
    if (reader->failed) return false;
    return peek(reader) == '\0' || json_fail(reader, "something follows the end");
}
