/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON (RFC 8259) in and out, for files of records: strict, of bounded depth, UTF-8. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Containers inside each other; members of one object. */
enum { JSON_DEPTH_MAX = 32, JSON_MEMBERS_MAX = 64 };

typedef enum JsonKind { JSON_NULL, JSON_FALSE, JSON_TRUE, JSON_NUMBER, JSON_STRING, JSON_ARRAY, JSON_OBJECT } JsonKind;

typedef struct JsonValue {
    JsonKind kind;
    int line, column; /* in the file, from 1; columns in bytes */
    uint32_t count;   /* items of an array, members of an object */
    uint32_t span;    /* values from this one to its next sibling: 1 and all inside */
    const char *key;  /* of a member of an object, else NULL */
    union {
        const char *text; /* of a string: UTF-8 without a NUL */
        double number;
    };
} JsonValue;

typedef struct Json {
    const char *path;  /* as given; not owned */
    JsonValue *values; /* values[0] is the whole; a container stands before what is in it */
    char *text;        /* what keys and strings point into */
} Json;

/* Reads a file of at most max_size bytes; memory stays below 100 times that. Refused, with file:line:column: all that
   the standard forbids, keys that come twice in an object, \u0000, numbers beyond the reach of float32, too much depth,
   too many members. On failure nothing is to be freed. */
bool json_read(Json *json, const char *path, size_t max_size, Error *error);
void json_free(Json *json);

/* The values in a container, in their order; NULL behind the last: for (item = json_first(v); item != NULL; item =
   json_next(v, item)). */
const JsonValue *json_first(const JsonValue *container);
const JsonValue *json_next(const JsonValue *container, const JsonValue *value);

/* A member of an object; NULL where there is none. */
const JsonValue *json_member(const JsonValue *object, const char *key);

/* A member that must be there and of that kind: else NULL and an input error that tells where. */
const JsonValue *json_need(const Json *json, const JsonValue *object, const char *key, JsonKind kind, Error *error);

/* The whole number that a member must be. */
bool json_need_int(const Json *json, const JsonValue *object, const char *key, int64_t minimum, int64_t maximum,
                   int64_t *value, Error *error);

/* Sets an input error "path:line:column: error: text". Returns false. */
bool json_error(const Json *json, const JsonValue *value, Error *error, const char *format, ...) PRINTF_LIKE(4, 5);

/* Writes to `out`, which must be in the C locale (file_write_text): a line for each value, or all that is in a container
   on one. The same calls give the same bytes. */
typedef struct JsonWriter {
    FILE *out;
    int depth;
    struct {
        char end; /* '}' or ']' */
        bool one_line;
        bool any; /* something is in it */
    } levels[JSON_DEPTH_MAX + 1];
} JsonWriter;

typedef enum JsonLayout { JSON_LINES, JSON_ONE_LINE } JsonLayout;

/* `key` is NULL in an array and for the whole. What is on one line has all inside it on that line. */
void json_begin_object(JsonWriter *writer, const char *key, JsonLayout layout);
void json_begin_array(JsonWriter *writer, const char *key, JsonLayout layout);
void json_end(JsonWriter *writer);

/* Bytes that are no UTF-8 become U+FFFD; NULL becomes null. What has a meaning in HTML is escaped, so that it may stand in
   a script. */
void json_put_text(JsonWriter *writer, const char *key, const char *text);
void json_put_int(JsonWriter *writer, const char *key, int64_t value);

/* The shortest of 15 to 17 digits that gives the number back; what is not finite becomes null. */
void json_put_number(JsonWriter *writer, const char *key, double value);
void json_put_bool(JsonWriter *writer, const char *key, bool value);

/* 16 hex digits, as text: not every reader keeps 64 bits of a number. */
void json_put_hash(JsonWriter *writer, const char *key, uint64_t hash);
