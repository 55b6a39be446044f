/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes JSON as a stream. */
#pragma once
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* The writer, UTF-8 only. jansson cannot write these files: it puts either everything or nothing on
   lines of its own, where a line is a record here (manifest.json grows by a line for each picture, and what a killed
   program left is compared line by line); it prints 0.1 with 17 digits; and it does not escape '<', which would end the
   script that results.json is part of in report.html. */

/* Containers inside each other. */
enum { JSON_DEPTH_MAX = 32 };

/* Writes to `out`, which must be in the C locale (file_write_text): a line for each value, or all that is in a
   container on one. The same calls give the same bytes. */
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

/* Bytes that are no UTF-8 become U+FFFD; NULL becomes null. What has a meaning in HTML is escaped, so that it may stand
   in a script. */
void json_put_text(JsonWriter *writer, const char *key, const char *text);
void json_put_int(JsonWriter *writer, const char *key, int64_t value);

/* The shortest of 15 to 17 digits that gives the number back; what is not finite becomes null. */
void json_put_number(JsonWriter *writer, const char *key, double value);
void json_put_bool(JsonWriter *writer, const char *key, bool value);

/* null where there is no value; returns whether it is absent. */
bool json_put_absent(JsonWriter *writer, const char *key, bool absent);

/* 16 hex digits, as text: not every reader keeps 64 bits of a number. */
void json_put_hash(JsonWriter *writer, const char *key, uint64_t hash);
