/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The text of a YAML file, and messages that show a place in it, as a compiler does. */
#pragma once
#include "common/error.h"

#include <stddef.h>

enum { SOURCE_MAX_SIZE = 3 << 19 }; /* bytes: 157 for each of 10,000 bodies, one per line */

/* Line and column from 0, the column in characters, as libyaml counts them. */
typedef struct Place {
    int line, column;
} Place;

typedef struct Source {
    const char *path; /* as given by the user; not owned */
    char *text;       /* [size] and a NUL */
    size_t size;
} Source;

/* Reads a file of UTF-8 text: no control characters but tab and line end, no YAML directive (a line that begins with '%').
   A byte order mark is dropped. On failure there is nothing to free. */
bool source_read(Source *source, const char *path, Error *error);
void source_free(Source *source);

/* Sets an input error "path:line:column: error: text", the line, a caret; the message counts line and column from 1.
   Returns false. */
bool source_error(const Source *source, Place place, Error *error, const char *format, ...) PRINTF_LIKE(4, 5);

/* The byte at a place; beyond the end of a line, its end. */
size_t source_offset(const Source *source, Place place);

/* Copies UTF-8 text for a message: non-printable characters become '?', text that does not fit ends with "...". */
void source_printable(char *out, size_t room, const char *text);
