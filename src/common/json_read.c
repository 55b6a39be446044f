/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One pass over the text, in which strings are unescaped in place: they only become shorter. */
#include "common/json.h"

#include "common/array.h"
#include "common/file.h"
#include "common/parse.h"
#include "common/utf8.h"

#include <limits.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

typedef struct Parser {
    Json *json;
    char *at, *end;         /* *end is NUL */
    const char *line_start; /* of the line that `at` is in */
    int line, depth;
    size_t count, capacity; /* values */
    Error *error;
} Parser;

bool json_error(const Json *json, const JsonValue *value, Error *error, const char *format, ...) {
    char text[1024], where[PATH_MAX];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    snprintf(where, sizeof where, "%s:%d:%d", json->path, value->line, value->column);
    return error_input(error, where, "%s", text);
}

static JsonValue here(const Parser *parser) {
    return (JsonValue){.line = parser->line, .column = (int)(parser->at - parser->line_start) + 1, .span = 1};
}

static bool refuse(const Parser *parser, const char *text) {
    JsonValue place = here(parser);
    return json_error(parser->json, &place, parser->error, "%s", text);
}

static void skip_space(Parser *parser) {
    for (;; parser->at++) {
        char c = *parser->at;
        if (c != ' ' && c != '\t' && c != '\r' && c != '\n') return;
        if (c != '\n') continue;
        parser->line++;
        parser->line_start = parser->at + 1;
    }
}

/* Four hex digits; -1 where they are not. */
static long take_hex(Parser *parser) {
    long value = 0;
    for (int i = 0; i < 4; i++, parser->at++) {
        char c = *parser->at;
        int digit = c >= '0' && c <= '9' ? c - '0' : (c | 32) >= 'a' && (c | 32) <= 'f' ? (c | 32) - 'a' + 10 : -1;
        if (digit < 0) return -1;
        value = value * 16 + digit;
    }
    return value;
}

/* \uXXXX, or two of them for what lies beyond 0xffff. */
static bool take_unicode(Parser *parser, char **out) {
    long c = take_hex(parser);
    if (c >= 0xd800 && c < 0xdc00 && parser->at[0] == '\\' && parser->at[1] == 'u') {
        parser->at += 2;
        long low = take_hex(parser);
        c = low >= 0xdc00 && low < 0xe000 ? 0x10000 + (c - 0xd800) * 0x400 + (low - 0xdc00) : -1;
    }
    if (c <= 0 || (c >= 0xd800 && c < 0xe000)) return refuse(parser, "no character that a text here can hold");
    *out += utf8_encode(*out, (uint32_t)c);
    return true;
}

static bool take_escape(Parser *parser, char **out) {
    static const char names[] = "\"\\/bfnrt", meanings[] = "\"\\/\b\f\n\r\t";
    char c = *++parser->at;
    const char *name = c == '\0' ? NULL : strchr(names, c);
    if (c != 'u' && name == NULL) return refuse(parser, "no escape of JSON");
    parser->at++;
    if (c == 'u') return take_unicode(parser, out);
    *(*out)++ = meanings[name - names];
    return true;
}

static bool take_string(Parser *parser, const char **text) {
    char *out = ++parser->at;
    *text = out;
    while (*parser->at != '"') {
        uint32_t character;
        if (*parser->at == '\\') {
            if (!take_escape(parser, &out)) return false;
            continue;
        }
        size_t length = utf8_decode(parser->at, (size_t)(parser->end - parser->at), &character);
        if (length == 0 || character < 0x20)
            return refuse(parser, length == 0 ? "no UTF-8 text" : "a control character in a text, or no end of it");
        memmove(out, parser->at, length);
        out += length;
        parser->at += length;
    }
    parser->at++;
    *out = '\0';
    return true;
}

/* What JSON calls a number: no plus, no point at an end, no zero before other digits. */
static bool take_number(Parser *parser, JsonValue *value) {
    const char *rest, *at = parser->at, *digits = at + (*at == '-');
    bool zero_first = digits[0] == '0' && digits[1] >= '0' && digits[1] <= '9';
    if (*digits < '0' || *digits > '9' || zero_first) return refuse(parser, "no value of JSON");
    const char *point = strpbrk(digits, ".,]} \t\r\n");
    if (point != NULL && *point == '.' && (point[1] < '0' || point[1] > '9')) return refuse(parser, "no value of JSON");
    if (!parse_leading_double(at, &value->number, &rest)) return refuse(parser, "no number that can be held");
    parser->at += rest - at;
    return true;
}

static bool take_word(Parser *parser, JsonValue *value) {
    static const char *const words[] = {[JSON_NULL] = "null", [JSON_FALSE] = "false", [JSON_TRUE] = "true"};
    for (int kind = JSON_NULL; kind <= JSON_TRUE; kind++) {
        if (strncmp(parser->at, words[kind], strlen(words[kind])) != 0) continue;
        value->kind = (JsonKind)kind;
        parser->at += strlen(words[kind]);
        return true;
    }
    return refuse(parser, "no value of JSON");
}

static bool take_value(Parser *parser, const char *key);

static bool take_key(Parser *parser, size_t object, const char **key) {
    const JsonValue *container = &parser->json->values[object];
    if (*parser->at != '"') return refuse(parser, "a key in quotes is needed");
    JsonValue place = here(parser);
    if (!take_string(parser, key)) return false;
    if (json_member(container, *key) != NULL)
        return json_error(parser->json, &place, parser->error, "the key comes twice");
    if (container->count == JSON_MEMBERS_MAX) return refuse(parser, "too many members in one object");
    skip_space(parser);
    if (*parser->at != ':') return refuse(parser, "':' is needed");
    parser->at++;
    skip_space(parser);
    return true;
}

/* The values inside, and the end. `index`: of the container, which moves when the array grows. */
static bool take_inside(Parser *parser, size_t index, char end) {
    JsonValue *container;
    parser->at++;
    skip_space(parser);
    for (bool more = *parser->at != end; more;) {
        const char *key = NULL;
        if (end == '}' && !take_key(parser, index, &key)) return false;
        if (!take_value(parser, key)) return false;
        container = &parser->json->values[index];
        container->count++;
        container->span = (uint32_t)(parser->count - index);
        skip_space(parser);
        more = *parser->at == ',';
        if (!more && *parser->at != end)
            return refuse(parser, end == '}' ? "',' or '}' is needed" : "',' or ']' is needed");
        if (more) parser->at++;
        skip_space(parser);
    }
    parser->at++;
    return true;
}

static bool take_container(Parser *parser, size_t index, char end) {
    if (parser->depth == JSON_DEPTH_MAX) return refuse(parser, "too many values inside each other");
    parser->depth++;
    bool ok = take_inside(parser, index, end);
    parser->depth--;
    return ok;
}

static bool take_value(Parser *parser, const char *key) {
    size_t index = parser->count;
    if (index == UINT32_MAX ||
        !array_reserve((void **)&parser->json->values, &parser->capacity, index + 1, sizeof *parser->json->values))
        return error_memory(parser->error, parser->json->path);
    JsonValue *value = &parser->json->values[parser->count++];
    *value = here(parser);
    value->key = key;
    char c = *parser->at;
    value->kind = c == '{' ? JSON_OBJECT : c == '[' ? JSON_ARRAY : c == '"' ? JSON_STRING : JSON_NUMBER;
    switch (c) {
    case '{': return take_container(parser, index, '}');
    case '[': return take_container(parser, index, ']');
    case '"': return take_string(parser, &value->text);
    case 'n':
    case 'f':
    case 't': return take_word(parser, value);
    default: return take_number(parser, value);
    }
}

bool json_read(Json *json, const char *path, size_t max_size, Error *error) {
    size_t size;
    *json = (Json){.path = path, .text = file_read(path, max_size, &size, error)};
    if (json->text == NULL) return false;
    Parser parser = {json, json->text, json->text + size, json->text, 1, 0, 0, 0, error};
    skip_space(&parser);
    bool ok = take_value(&parser, NULL);
    if (ok) skip_space(&parser);
    if (ok && parser.at != parser.end) ok = refuse(&parser, "something behind the value");
    if (!ok) json_free(json);
    return ok;
}

void json_free(Json *json) {
    free(json->values);
    free(json->text);
    *json = (Json){0};
}
