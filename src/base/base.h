/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every file may need: errors, text, numbers from text, arrays. No files, no threads.

     bool half(const char *text, float *value, Error *error) {
         return parse_float(text, value) || error_input(error, "--half", "'%s' is not a number", text);
     } */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Why a function failed, as a message that main() prints unchanged.

   A function that can fail returns bool or NULL and takes an Error * as its last argument. Both setters return false,
   so a failing function ends in `return error_input(error, ...)`. The first error stays: a caller passes it on
   unchanged. Arguments may be any text: control characters in them become visible (visible_text()). Ends of lines do,
   too, unless the format has one. */

/* The values are the program's exit statuses. */
typedef enum ErrorKind { ERROR_NONE = 0, ERROR_INPUT = 2, ERROR_SYSTEM = 3, ERROR_INTERRUPTED = 130 } ErrorKind;

/* Whether a method failed at its work, rather than what it was given: to a study that is a result. */
typedef enum MethodFailure {
    FAILURE_NONE,
    FAILURE_NOT_FINITE, /* the state of the run became NaN or infinite */
    FAILURE_ADAPTER     /* the program of the method `exec` */
} MethodFailure;

typedef struct Error {
    ErrorKind kind;
    char message[2048];
    MethodFailure failure; /* of ERROR_INPUT */
} Error;

#define PRINTF_LIKE(text, first) __attribute__((format(printf, text, first)))

/* In such a function: prints what it was given into text[size], with va_list and vsnprintf(). */
#define PRINT_ARGUMENTS(text, size, format)            \
    do {                                               \
        va_list arguments_;                            \
        va_start(arguments_, format);                  \
        vsnprintf((text), (size), format, arguments_); \
        va_end(arguments_);                            \
    } while (0)

/* Bad usage or input. The message becomes "where: error: text"; where names a file, `file:line:column` or an option.
   The text may have further lines (an excerpt of the file with a caret). */
bool error_input(Error *error, const char *where, const char *format, ...) PRINTF_LIKE(3, 4);

/* The same, of a method that failed. */
bool error_failure(Error *error, MethodFailure failure, const char *where, const char *format, ...) PRINTF_LIKE(4, 5);

/* The system failed: disk, memory, a missing library or program. */
bool error_system(Error *error, const char *where, const char *format, ...) PRINTF_LIKE(3, 4);

/* Work was stopped on request (base/machine.h): by SIGINT or SIGTERM. */
bool error_interrupted(Error *error, const char *where, const char *format, ...) PRINTF_LIKE(3, 4);

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
#define error_failure(...) error_false(error_failure(__VA_ARGS__))
#define error_system(...) error_false(error_system(__VA_ARGS__))
#define error_interrupted(...) error_false(error_interrupted(__VA_ARGS__))
#define error_memory(...) error_false(error_memory(__VA_ARGS__))
#endif

/* Libraries that read a file report a lack of memory or of descriptors as damage of the file. What they leave in errno
   tells the truth, if it was 0 before. */

/* Whether this errno says that the machine failed (memory, descriptors, disk), not the file. */
bool cause_is_system(int cause);

/* Sets a system error: "path: error: out of memory", "path: error: cannot read: Input/output error". Returns false. */
bool cause_error(int cause, const char *path, Error *error);

/* What a program does on its way to a result: files read and written, programs started, the OpenGL context. The library
   never prints: cli/ listens if the user wants to know (-v). */

/* Gets one line without its end; called from several threads at once, and in forked processes. */
typedef void TraceListener(const char *line);

/* Call it before threads begin; NULL ends it, which is the start, too. */
void trace_listen(TraceListener *listener);

/* Does nothing unless somebody listens. What is longer than 1,000 bytes is cut. */
void trace_line(const char *format, ...) PRINTF_LIKE(1, 2);

/* Text that grows in a fixed array. */

/* Appends as printf does; what does not fit is cut off. */
void text_add(char *text, size_t size, const char *format, ...) PRINTF_LIKE(3, 4);

/* The same, with `between` before it if there is a text already. */
void text_join(char *text, size_t size, const char *between, const char *format, ...) PRINTF_LIKE(4, 5);

/* The ending of a noun: "1 frame", "2 frames". */
static inline const char *plural(int count) { return count == 1 ? "" : "s"; }
static inline const char *plural_es(int count) { return count == 1 ? "" : "es"; } /* "1 launch" */

/* Text of others, such as names of files, in messages: what a terminal or a log would obey becomes visible. */

typedef enum VisibleLines { VISIBLE_ONE_LINE, VISIBLE_LINES } VisibleLines;

/* Copies text to out[size], size > 16. Control characters, bytes that are not UTF-8 and characters that turn the
   direction of text become "\x1b", "\xff", "\u202e"; ends of lines "\n", unless `lines` keeps them. Text that does not
   fit loses its middle: "begin...end". Returns the length. */
size_t visible_text(char *out, size_t size, const char *text, VisibleLines lines);

bool text_is_utf8(const char *text);

/* The first character of the text that a terminal or a page would obey: a control character (C0, DEL, C1, which
   includes ends of lines), or one that turns the direction of text; 0 without one. */
unsigned control_in_text(const char *text);

/* Suggestions for mistyped words, and lists of names. Own code: no library in use has an edit distance. */

/* The nearest of the words by edit distance, or NULL if none is near. Words of more than 31 bytes are never near. */
const char *nearest_word(const char *word, const char *const *words, int count);

/* "a, b, c", for messages; begin with {0}. */
typedef struct NameList {
    size_t used;
    char text[1536];
} NameList;

/* Appends a name that the list does not have yet; ignores it if there is no room. */
void name_list_add(NameList *list, const char *name);

/* The error for a name that a table lacks: "'fo' is not a method; did you mean 'foo'?" or, if no known name is near,
   "'x' is not a method; known: foo, bar", where `what` is "a method". */
bool error_unknown(Error *error, const char *where, const char *name, const char *what, const NameList *known);

/* UTF-8. */

/* The character that text of `size` bytes begins with (Unicode 15, table 3-7): its length in bytes, or 0 if it is not
   well-formed. */
size_t utf8_decode(const char *text, size_t size, uint32_t *character);

/* The next character of NUL-terminated text that is not empty; moves *text behind it. Returns U+FFFD for a byte that is
   not well-formed. */
uint32_t utf8_next(const char **text);

/* Length of the first whole characters of NUL-terminated text, at most `limit` bytes. */
size_t utf8_cut(const char *text, size_t limit);

/* Writes a character (not a surrogate, at most 0x10ffff) to `out`, which has room for 4 bytes; returns its length. */
size_t utf8_put(char *out, uint32_t character);

/* Arrays that grow. */

/* Grows *items (a malloc'ed block or NULL, freed by the caller) to `wanted` items of `item_size` bytes; `wanted`
   exceeds the capacity. The capacity at least doubles, so that appending costs O(1). False when memory is short; *items
   stays valid. */
bool array_grow(void **items, size_t *capacity, size_t wanted, size_t item_size);

/* The same, but does nothing if the capacity suffices. Inline: a step of a few microseconds reserves a dozen arrays. */
static inline bool array_reserve(void **items, size_t *capacity, size_t wanted, size_t item_size) {
    return wanted <= *capacity || array_grow(items, capacity, wanted, item_size);
}

/* Arrays of an object whose sizes grow together, in one block of memory. Zero-initialise; to free it, free `memory`. */
typedef struct ArrayBlock {
    void *memory;
    size_t capacity; /* bytes */
} ArrayBlock;

typedef struct ArrayPart {
    void *array; /* address of the pointer to its items */
    size_t size; /* bytes */
} ArrayPart;

#define ARRAY_PART(items, count) \
    { &(items), (size_t)(count) * sizeof *(items) }

/* Lets the pointers of all parts point into the block; each array begins at a cache line. The items are undefined
   afterwards. Allocates nothing if the block was as large before; the block at least doubles otherwise. False when
   memory is short; pointers and items then stay. */
bool array_block_reserve(ArrayBlock *block, const ArrayPart *parts, size_t count);

#define ARRAY_BLOCK_RESERVE(block, ...)                            \
    array_block_reserve((block), (const ArrayPart[]){__VA_ARGS__}, \
                        sizeof((const ArrayPart[]){__VA_ARGS__}) / sizeof(ArrayPart))

/* Numbers from text, for scene files and options. The whole text must be a number: no locale, no surrounding space, no
   NaN, no infinity. */

/* A decimal number, rounded to the nearest float32, or a fraction of two such as 1/60, divided in float32. */
bool parse_float(const char *text, float *value);

/* The same in double, in the range of float32. */
bool parse_double(const char *text, double *value);

/* The decimal number that text begins with, in the range of float32; *rest is what follows it. */
bool parse_leading_double(const char *text, double *value, const char **rest);

bool parse_int(const char *text, int64_t minimum, int64_t maximum, int64_t *value);

/* The same of the number that text begins with; *rest is what follows it. */
bool parse_leading_int(const char *text, int64_t minimum, int64_t maximum, int64_t *value, const char **rest);

/* "A:B:STEP", three floats with STEP > 0 and A <= B. Value i of the range is the decimal A + i * STEP (computed
   in double, then rounded to float32, so that -5:5:0.05 gives the floats of the decimals -5.00, -4.95, ...). */
typedef struct FloatRange {
    double first, step;
    int count;
} FloatRange;
bool parse_range(const char *text, int max_count, FloatRange *range);
float range_value(const FloatRange *range, int i);
