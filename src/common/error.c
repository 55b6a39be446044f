/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Messages contain text of others: names of files, keys, values. Here, in one place, it is made visible. */
#include "common/error.h"

#include "common/visible_text.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#undef error_input
#undef error_incomplete
#undef error_system
#undef error_interrupted
#undef error_memory

/* A path can be longer than a message: what is wrong must still be in it. */
enum { WHERE_SIZE = 1024, RAW_SIZE = 8192 };

static void append(Error *error, const char *format, va_list arguments) PRINTF_LIKE(2, 0);

/* Only a format with lines (an excerpt of a file, the output of a program) gets lines from its arguments: a name must not
   look like a message of its own. */
static void append(Error *error, const char *format, va_list arguments) {
    char raw[RAW_SIZE];
    const size_t used = strlen(error->message), room = sizeof error->message - used;
    if (room <= 16) return; /* what visible_text() needs */
    vsnprintf(raw, sizeof raw, format, arguments);
    for (size_t end = strlen(raw); end > 0 && (raw[end - 1] == '\n' || raw[end - 1] == '\r'); end--)
        raw[end - 1] = '\0';
    visible_text(error->message + used, room, raw, strchr(format, '\n') != NULL ? VISIBLE_LINES : VISIBLE_ONE_LINE);
}

static bool set(Error *error, ErrorKind kind, const char *where, const char *format, va_list arguments)
    PRINTF_LIKE(4, 0);

static bool set(Error *error, ErrorKind kind, const char *where, const char *format, va_list arguments) {
    if (error->kind != ERROR_NONE) return false;
    error->kind = kind;
    const size_t length = visible_text(error->message, WHERE_SIZE, where, VISIBLE_ONE_LINE);
    strcpy(error->message + length, ": error: ");
    append(error, format, arguments);
    return false;
}

bool error_input(Error *error, const char *where, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    set(error, ERROR_INPUT, where, format, arguments);
    va_end(arguments);
    return false;
}

bool error_system(Error *error, const char *where, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    set(error, ERROR_SYSTEM, where, format, arguments);
    va_end(arguments);
    return false;
}

bool error_interrupted(Error *error, const char *where, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    set(error, ERROR_INTERRUPTED, where, format, arguments);
    va_end(arguments);
    return false;
}

bool error_incomplete(Error *error, const char *where, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    set(error, ERROR_INCOMPLETE, where, format, arguments);
    va_end(arguments);
    return false;
}

bool error_memory(Error *error, const char *where) { return error_system(error, where, "out of memory"); }

void error_add(Error *error, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    append(error, format, arguments);
    va_end(arguments);
}
