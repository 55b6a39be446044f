/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The text of a scene file, and messages that show the place in it as a compiler does. */
#pragma once
#include "common/error.h"

#include <stddef.h>

enum {
    SOURCE_MAX_SIZE = 2 << 20, /* bytes: 10,000 bodies written one a line have 200 each */
    SOURCE_MAX_LINE = 4096     /* bytes: libfyaml looks ahead to the end of the line for the colon of a key */
};

typedef struct Source {
    const char *path; /* as the user gave it; not owned */
    char *text;       /* [size] and a NUL */
    size_t size;
} Source;

/* Reads a file that is plain UTF-8 text: no control characters but tab and line end, no line above the limit,
   no YAML directive (a line that begins with '%'). A byte order mark is dropped. On failure nothing is to be
   freed. */
bool source_read(Source *source, const char *path, Error *error);
void source_free(Source *source);

/* Sets an input error "path:line:column: error: text", the line around the byte at `offset`, a caret. Line
   and column count from 1, the column in characters. Returns false. */
bool source_error(const Source *source, size_t offset, Error *error, const char *format, ...)
    PRINTF_LIKE(4, 5);

/* Copies UTF-8 text for a message: what does not print becomes '?', what does not fit is cut to "...". */
void source_printable(char *out, size_t room, const char *text);
