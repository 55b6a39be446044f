/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes JSON, value by value. */
#include "base/json_write.h"

#include "base/base.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void put_quoted(FILE *out, const char *text) {
    putc('"', out);
    for (size_t at = 0, size = strlen(text), length; at < size; at += length) {
        uint32_t character;
        length = utf8_decode(text + at, size - at, &character);
        if (length == 0) {
            fputs("\xef\xbf\xbd", out); /* U+FFFD */
            length = 1;
        } else if (character == '"' || character == '\\') {
            fprintf(out, "\\%c", (char)character);
        } else if (character < 0x20 || character == 0x7f || character == '<' || character == '>' || character == '&') {
            fprintf(out, "\\u%04" PRIx32, character);
        } else {
            fwrite(text + at, 1, length, out);
        }
    }
    putc('"', out);
}

/* The end of the value before, the line, and the key. */
static void begin_value(JsonWriter *writer, const char *key) {
    if (writer->depth > 0) {
        bool one_line = writer->levels[writer->depth].one_line, any = writer->levels[writer->depth].any;
        if (any) putc(',', writer->out);
        if (!one_line)
            fprintf(writer->out, "\n%*s", 2 * writer->depth, "");
        else if (any)
            putc(' ', writer->out);
        writer->levels[writer->depth].any = true;
    }
    if (key == NULL) return;
    put_quoted(writer->out, key);
    fputs(": ", writer->out);
}

static void begin_container(JsonWriter *writer, const char *key, JsonLayout layout, const char *ends) {
    begin_value(writer, key);
    putc(ends[0], writer->out);
    bool one_line = layout == JSON_ONE_LINE || (writer->depth > 0 && writer->levels[writer->depth].one_line);
    assert(writer->depth < JSON_DEPTH_MAX);
    writer->depth++;
    writer->levels[writer->depth].end = ends[1];
    writer->levels[writer->depth].one_line = one_line;
    writer->levels[writer->depth].any = false;
}

void json_begin_object(JsonWriter *writer, const char *key, JsonLayout layout) {
    begin_container(writer, key, layout, "{}");
}

void json_begin_array(JsonWriter *writer, const char *key, JsonLayout layout) {
    begin_container(writer, key, layout, "[]");
}

void json_end(JsonWriter *writer) {
    bool lines = !writer->levels[writer->depth].one_line && writer->levels[writer->depth].any;
    char end = writer->levels[writer->depth--].end;
    if (lines) fprintf(writer->out, "\n%*s", 2 * writer->depth, "");
    putc(end, writer->out);
    if (writer->depth == 0) putc('\n', writer->out);
}

void json_put_text(JsonWriter *writer, const char *key, const char *text) {
    begin_value(writer, key);
    if (text == NULL)
        fputs("null", writer->out);
    else
        put_quoted(writer->out, text);
}

bool json_put_absent(JsonWriter *writer, const char *key, bool absent) {
    if (absent) json_put_text(writer, key, NULL);
    return absent;
}

void json_put_int(JsonWriter *writer, const char *key, int64_t value) {
    begin_value(writer, key);
    fprintf(writer->out, "%" PRId64, value);
}

void json_put_number(JsonWriter *writer, const char *key, double value) {
    char text[32] = "null";
    begin_value(writer, key);
    for (int digits = 15; isfinite(value) && digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value) break;
    }
    fputs(text, writer->out);
}

void json_put_bool(JsonWriter *writer, const char *key, bool value) {
    begin_value(writer, key);
    fputs(value ? "true" : "false", writer->out);
}

void json_put_hash(JsonWriter *writer, const char *key, uint64_t hash) {
    begin_value(writer, key);
    fprintf(writer->out, "\"%016" PRIx64 "\"", hash);
}
