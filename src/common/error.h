/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Why a function failed, as a message that main() prints unchanged.

   A function that can fail returns bool or NULL and takes an Error * as its last argument. Both setters return false,
   so a failing function ends in `return error_input(error, ...)`. The first error stays: a caller passes it on
   unchanged. Arguments may be any text: control characters in them become visible (visible_text.h). Ends of lines do, too,
   unless the format has one. */
#pragma once
#include <stdbool.h>

/* The values are the program's exit statuses. */
typedef enum ErrorKind {
    ERROR_NONE = 0,
    ERROR_INCOMPLETE = 1,
    ERROR_INPUT = 2,
    ERROR_SYSTEM = 3,
    ERROR_INTERRUPTED = 130
} ErrorKind;

typedef struct Error {
    ErrorKind kind;
    char message[2048];
} Error;

#define PRINTF_LIKE(text, first) __attribute__((format(printf, text, first)))

/* Bad usage or input. The message becomes "where: error: text"; where names a file, `file:line:column` or an option.
   The text may have further lines (an excerpt of the file with a caret). */
bool error_input(Error *error, const char *where, const char *format, ...) PRINTF_LIKE(3, 4);

/* The system failed: disk, memory, a missing library or program. */
bool error_system(Error *error, const char *where, const char *format, ...) PRINTF_LIKE(3, 4);

/* Work was stopped on request (common/progress.h): by SIGINT or SIGTERM. */
bool error_interrupted(Error *error, const char *where, const char *format, ...) PRINTF_LIKE(3, 4);

/* Other processes have not finished what this one needs. */
bool error_incomplete(Error *error, const char *where, const char *format, ...) PRINTF_LIKE(3, 4);

/* Out of memory: a system error whose text needs no arguments. */
bool error_memory(Error *error, const char *where);

/* Appends to the message of an error that is set. */
void error_add(Error *error, const char *format, ...) PRINTF_LIKE(2, 3);

#ifdef __clang_analyzer__ /* It reads one source at a time. This tells it what they return. */
static inline bool error_false(bool set) {
    (void)set;
    return false;
}
#define error_input(...) error_false(error_input(__VA_ARGS__))
#define error_incomplete(...) error_false(error_incomplete(__VA_ARGS__))
#define error_system(...) error_false(error_system(__VA_ARGS__))
#define error_interrupted(...) error_false(error_interrupted(__VA_ARGS__))
#define error_memory(...) error_false(error_memory(__VA_ARGS__))
#endif
