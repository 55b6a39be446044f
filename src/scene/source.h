/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The text of a scene file, and messages that show the place in it as a compiler does. */
#pragma once
#include "common/error.h"

#include <stddef.h>

/* libfyaml looks ahead to the end of the line for the colon of a key, and skips blanks in time that grows
   with the square of their number: these limits keep any file below a tenth of a second. */
enum {
    SOURCE_MAX_SIZE = 3 << 19,   /* bytes: 10,000 bodies written one a line have 157 each */
    SOURCE_MAX_LINE = 4096,      /* bytes */
    SOURCE_MAX_BLANKS = 50000000 /* sum over the runs of blanks and line ends of their length squared */
};

/* Line and column from 0, the column in characters, as libfyaml counts them. */
typedef struct Place {
    int line, column;
} Place;

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

/* Sets an input error "path:line:column: error: text", the line, a caret; shown line and column count from 1.
   Returns false. */
bool source_error(const Source *source, Place place, Error *error, const char *format, ...) PRINTF_LIKE(4, 5);

/* Copies UTF-8 text for a message: what does not print becomes '?', what does not fit is cut to "...". */
void source_printable(char *out, size_t room, const char *text);
