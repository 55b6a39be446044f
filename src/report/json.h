/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON (RFC 8259), out and in. Reading is by pulling: who reads knows what may come, passes over what it does not know, and
   stops at the first mistake, which is told with its line. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* A string with its quotes; text is UTF-8. What has a meaning in HTML is escaped, too, so that it may stand in a script. */
void json_put(FILE *file, const char *text);

typedef struct JsonReader {
    const char *path; /* for messages */
    const char *start, *next;
    Error *error;
    bool failed;
} JsonReader;

/* text ends in a NUL and outlives the reader. */
JsonReader json_reader(const char *path, const char *text, Error *error);

/* Sets the error "path:line: error: text" unless there is one. Returns false. */
bool json_fail(JsonReader *reader, const char *format, ...) PRINTF_LIKE(2, 3);

/* Of a list or an object: true while there is a further item, whose value is to be read or skipped next. *count, 0 at first,
   is the items so far. json_next_key hands out the key, cut to size. */
bool json_next_item(JsonReader *reader, int *count);
bool json_next_key(JsonReader *reader, int *count, char *key, size_t size);

/* Values. A string with \0 or one that does not fit is a mistake. json_string_or_null leaves value empty at null. */
bool json_string(JsonReader *reader, char *value, size_t size);
bool json_bool(JsonReader *reader, bool *value);
bool json_null(JsonReader *reader); /* true, and past it, where the value is null */
bool json_skip(JsonReader *reader); /* any value, nested up to 16 deep */
bool json_end(JsonReader *reader);  /* nothing may follow */
