/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON (RFC 8259): a reader of files that others may have written, and a writer of streams.

   The reader takes one value at a time, with jansson. The caller walks the outer containers; jansson parses each value
   inside them.

   Parsed at once, a file of {} takes 77 times its size in memory. Value by value it takes its size and a fixed block,
   and each value has a line and a column, which jansson does not store.

   Refused, with path:line:column: invalid JSON and UTF-8, duplicate keys inside a value, \u0000, numbers beyond double
   or int64, more than 2048 levels, values that exceed the limits below.

   Not thread-safe: jansson has one allocator per process. */
#pragma once
#include "base/base.h"

#include <jansson.h>
#include <stdio.h>

/* Bytes of one value in the file, and in memory. */
enum { JSON_VALUE_SIZE = 1 << 16, JSON_VALUE_MEMORY = 1 << 20 };

typedef struct JsonReader {
    const char *path; /* as given; not owned */
    char *text;
    const char *at, *end;         /* unread text */
    int line, column;             /* of `at`, from 1; columns in characters */
    int value_line, value_column; /* where the last value begins */
    struct JsonMemory *memory;    /* of the last value */
} JsonReader;

/* Opens a file of at most max_size bytes. On failure nothing needs to be freed. */
bool json_read_open(JsonReader *reader, const char *path, size_t max_size, Error *error);
void json_read_close(JsonReader *reader);

/* The next value, of any kind; NULL with error set if there is no valid one. The reader owns it (no json_decref); it is
   valid until the next call. */
const json_t *json_read_value(JsonReader *reader, Error *error);

/* Reads `c` if it is the next character after white space; otherwise false, and nothing is read. */
bool json_read_char(JsonReader *reader, char c);

/* After an item of a container: *more is whether another follows. False with error set unless there is ',' or `end`. */
bool json_read_more(JsonReader *reader, char end, bool *more, Error *error);

/* False with error set unless only white space is left. */
bool json_read_end(JsonReader *reader, Error *error);

/* Sets an input error "path:line:column: error: text" at the last value. Returns false. */
bool json_read_error(const JsonReader *reader, Error *error, const char *format, ...) PRINTF_LIKE(3, 4);

/* The writer, UTF-8 only. jansson cannot write these files: it puts either everything or nothing on
   lines of its own, where a line is a record here (manifest.json grows by a line for each picture, and what a killed
   program left is compared line by line); it prints 0.1 with 17 digits; and it does not escape '<', which would end the
   script that results.json is part of in report.html. */

/* Containers inside each other. */
enum { JSON_DEPTH_MAX = 32 };

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

/* null where there is no value; returns whether it is absent. */
bool json_put_absent(JsonWriter *writer, const char *key, bool absent);

/* 16 hex digits, as text: not every reader keeps 64 bits of a number. */
void json_put_hash(JsonWriter *writer, const char *key, uint64_t hash);
