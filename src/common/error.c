/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/error.h"

#include <stdarg.h>
#include <stdio.h>

#undef error_input
#undef error_system
#undef error_interrupted
#undef error_memory

static bool set(Error *error, ErrorKind kind, const char *where, const char *format, va_list arguments)
    PRINTF_LIKE(4, 0);

static bool set(Error *error, ErrorKind kind, const char *where, const char *format, va_list arguments) {
    if (error->kind != ERROR_NONE) return false;
    error->kind = kind;
    int prefix = snprintf(error->message, sizeof error->message, "%s: error: ", where);
    if (prefix < 0 || (size_t)prefix >= sizeof error->message) return false;
    vsnprintf(error->message + prefix, sizeof error->message - (size_t)prefix, format, arguments);
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

bool error_memory(Error *error, const char *where) { return error_system(error, where, "out of memory"); }
