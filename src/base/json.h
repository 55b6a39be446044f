/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON (RFC 8259): a reader of files that others may have written; and the writer of json_write.h.

   The reader takes one value at a time, with jansson. The caller walks the outer containers; jansson parses each value
   inside them.

   Parsed at once, a file of {} takes 77 times its size in memory. Value by value it takes its size and a fixed block,
   and each value has a line and a column, which jansson does not store.

   Refused, with path:line:column: invalid JSON and UTF-8, duplicate keys inside a value, \u0000, numbers beyond double
   or int64, more than 2048 levels, values that exceed the limits below.

   Not thread-safe: jansson has one allocator per process. */
#pragma once
#include "base/base.h"
#include "base/json_write.h"

#include <jansson.h>
#include <stdio.h>

/* Bytes of one value in a file, and in memory; of text in memory, a value may have all bytes, and so many times these
   more. */
enum { JSON_VALUE_SIZE = 1 << 16, JSON_VALUE_MEMORY = 1 << 20 };

typedef struct JsonReader {
    const char *path; /* as given; not owned */
    char *text;
    const char *at, *end;         /* unread text */
    size_t most;                  /* bytes of a value */
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
