/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every file may need, in the order of base.h; settings and numbers from text are in parse.c. */
#include "base/base.h"

#include "base/numbers.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#undef error_input
#undef error_failure
#undef error_system
#undef error_interrupted
#undef error_memory

/* Messages contain text of others: names of files, keys, values. Here, in one place, it is made visible. */

/* A path can be longer than a message: what is wrong must still be in it. */
enum { WHERE_SIZE = 1024, RAW_SIZE = 8192 };

/* Only a format with lines (an excerpt of a file, the output of a program) gets lines from its arguments: a name must
   not look like a message of its own. */
PRINTF_LIKE(2, 0) static void append(Error *error, const char *format, va_list arguments) {
    char raw[RAW_SIZE];
    const size_t used = strlen(error->message), room = sizeof error->message - used;
    if (room <= 16) return; /* what visible_text() needs */
    vsnprintf(raw, sizeof raw, format, arguments);
    for (size_t end = strlen(raw); end > 0 && (raw[end - 1] == '\n' || raw[end - 1] == '\r'); end--)
        raw[end - 1] = '\0';
    visible_text(error->message + used, room, raw, strchr(format, '\n') != NULL ? VISIBLE_LINES : VISIBLE_ONE_LINE);
}

PRINTF_LIKE(4, 0)
static void set(Error *error, ErrorKind kind, const char *where, const char *format, va_list arguments) {
    if (error->kind != ERROR_NONE) return;
    error->kind = kind;
    const size_t length = visible_text(error->message, WHERE_SIZE, where, VISIBLE_ONE_LINE);
    strcpy(error->message + length, ": error: ");
    append(error, format, arguments);
}

#define SETTER(name, kind)                                                \
    bool name(Error *error, const char *where, const char *format, ...) { \
        va_list arguments;                                                \
        va_start(arguments, format);                                      \
        set(error, kind, where, format, arguments);                       \
        va_end(arguments);                                                \
        return false;                                                     \
    }
SETTER(error_input, ERROR_INPUT)
SETTER(error_system, ERROR_SYSTEM)
SETTER(error_interrupted, ERROR_INTERRUPTED)

bool error_failure(Error *error, MethodFailure failure, const char *where, const char *format, ...) {
    va_list arguments;
    if (error->kind == ERROR_NONE) error->failure = failure;
    va_start(arguments, format);
    set(error, ERROR_INPUT, where, format, arguments);
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

bool cause_is_system(int cause) {
    static const int causes[] = {ENOMEM, EMFILE, ENFILE, EIO, EAGAIN, EINTR, ENOBUFS, ESTALE, ETIMEDOUT};
    for (size_t i = 0; i < sizeof causes / sizeof *causes; i++)
        if (cause == causes[i]) return true;
    return false;
}

bool cause_error(int cause, const char *path, Error *error) {
    return cause == ENOMEM ? error_memory(error, path) : error_system(error, path, "cannot read: %s", strerror(cause));
}

static TraceListener *heard_by;

void trace_listen(TraceListener *listener) { heard_by = listener; }

void trace_line(const char *format, ...) {
    char line[1001];
    if (heard_by == NULL) return;
    PRINT_ARGUMENTS(line, sizeof line, format);
    heard_by(line);
}

void text_add(char *text, size_t size, const char *format, ...) {
    size_t used = strlen(text);
    PRINT_ARGUMENTS(text + used, size - used, format);
}

void text_join(char *text, size_t size, const char *between, const char *format, ...) {
    if (text[0] != '\0') text_add(text, size, "%s", between);
    const size_t used = strlen(text);
    PRINT_ARGUMENTS(text + used, size - used, format);
}

/* A character as it is shown. */
typedef struct Shown {
    char text[8];
    size_t length, read; /* bytes, of the text that is shown and of the original */
} Shown;

static bool is_control(uint32_t c) { return c < 0x20 || (c >= 0x7f && c < 0xa0); }

/* C1 controls, direction marks, ends of lines and paragraphs, and directional overrides (Unicode 15, chapter 23). */
static bool is_obeyed(uint32_t c) {
    return is_control(c) || c == 0x61c || c == 0x200e || c == 0x200f || (c >= 0x2028 && c <= 0x202e) ||
           (c >= 0x2066 && c <= 0x2069);
}

static Shown show(const char *text, VisibleLines lines) {
    uint32_t c = 0;
    const unsigned byte = (unsigned char)text[0];
    const size_t read = utf8_decode(text, strnlen(text, 4), &c);
    Shown shown = {.read = read > 0 ? read : 1};
    if (read == 1 && (c == '\n' || c == '\t') && lines == VISIBLE_LINES)
        shown.text[0] = (char)c;
    else if (read == 1 && c == '\n')
        strcpy(shown.text, "\\n");
    else if (read == 0 || c < 0x20 || c == 0x7f)
        snprintf(shown.text, sizeof shown.text, "\\x%02x", byte);
    else if (is_obeyed(c))
        snprintf(shown.text, sizeof shown.text, "\\u%04x", (unsigned)(uint16_t)c);
    else
        memcpy(shown.text, text, read);
    shown.length = strlen(shown.text);
    return shown;
}

/* Shows text from *at while it is at most `most` bytes; moves *at behind it. */
static size_t put(char *out, const char **at, size_t most, VisibleLines lines) {
    size_t length = 0;
    while (**at != '\0') {
        const Shown shown = show(*at, lines);
        if (length + shown.length > most) break;
        if (out != NULL) memcpy(out + length, shown.text, shown.length);
        length += shown.length;
        *at += shown.read;
    }
    return length;
}

size_t visible_text(char *out, size_t size, const char *text, VisibleLines lines) {
    static const char gap[] = "...";
    const char *at = text;
    size_t left = put(NULL, &at, SIZE_MAX, lines), length = 0;
    at = text;
    if (left >= size) {
        const size_t half = (size - sizeof gap) / 2;
        length = put(out, &at, half, lines);
        for (left -= length; left > half; at += show(at, lines).read) left -= show(at, lines).length;
        memcpy(out + length, gap, sizeof gap - 1);
        length += sizeof gap - 1;
    }
    length += put(out + length, &at, SIZE_MAX, lines);
    out[length] = '\0';
    return length;
}

bool text_is_utf8(const char *text) {
    uint32_t character;
    for (size_t length; *text != '\0'; text += length)
        if ((length = utf8_decode(text, strnlen(text, 4), &character)) == 0) return false;
    return true;
}

unsigned control_in_text(const char *text) {
    while (*text != '\0') {
        const uint32_t c = utf8_next(&text);
        if (is_obeyed(c)) return c;
    }
    return 0;
}

enum { WORD_SIZE = 32 };

/* The edit distance (Levenshtein 1966), computed row by row. */
static size_t edits(const char *a, const char *b) {
    size_t row[WORD_SIZE], columns = strlen(b);
    for (size_t j = 0; j <= columns; j++) row[j] = j;
    for (size_t i = 0; a[i] != '\0'; i++) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < columns; j++) {
            size_t replaced = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = size_min(replaced, 1 + size_min(row[j], diagonal));
        }
    }
    return row[columns];
}

const char *nearest_word(const char *word, const char *const *words, int count) {
    const char *nearest = NULL;
    size_t length = strlen(word), best = 1 + length / 3;
    if (length >= WORD_SIZE) return NULL;
    for (int i = 0; i < count; i++) {
        if (strlen(words[i]) >= WORD_SIZE) continue;
        size_t distance = edits(word, words[i]);
        if (distance > best || (distance == best && nearest != NULL)) continue;
        best = distance;
        nearest = words[i];
    }
    return nearest;
}

void name_list_add(NameList *list, const char *name) {
    const size_t length = strlen(name);
    if (length == 0 || list->used + length + 3 > sizeof list->text) return;
    for (const char *at = list->text; (at = strstr(at, name)) != NULL; at++)
        if ((at == list->text || at[-1] == ' ') && (at[length] == '\0' || at[length] == ',')) return; /* it has it */
    list->used += (size_t)snprintf(list->text + list->used, sizeof list->text - list->used, "%s%s",
                                   list->used > 0 ? ", " : "", name);
}

bool error_unknown(Error *error, const char *where, const char *name, const char *what, const NameList *known) {
    enum { WORDS = 256 };
    char text[sizeof known->text], *rest = NULL;
    const char *words[WORDS];
    int count = 0;
    memcpy(text, known->text, sizeof text);
    for (char *word = strtok_r(text, ", ", &rest); word != NULL && count < WORDS; word = strtok_r(NULL, ", ", &rest))
        words[count++] = word;
    const char *nearest = nearest_word(name, words, count);
    if (nearest != NULL) return error_input(error, where, "'%.64s' is not %s; did you mean '%s'?", name, what, nearest);
    return error_input(error, where, "'%.64s' is not %s; known: %s", name, what,
                       known->used > 0 ? known->text : "none");
}

size_t utf8_decode(const char *text, size_t size, uint32_t *character) {
    static const uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
    if (size == 0) return 0;
    unsigned char lead = (unsigned char)text[0];
    size_t length = lead < 0x80 ? 1 : lead < 0xc0 ? 0 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : lead < 0xf8 ? 4 : 0;
    if (length == 0 || length > size) return 0;
    uint32_t c = length == 1 ? lead : lead & (0x7fu >> length);
    for (size_t i = 1; i < length; i++) {
        if (((unsigned char)text[i] & 0xc0) != 0x80) return 0;
        c = c << 6 | ((unsigned char)text[i] & 0x3fu);
    }
    if (c < smallest[length] || c > 0x10ffff || (c >= 0xd800 && c <= 0xdfff)) return 0;
    *character = c;
    return length;
}

uint32_t utf8_next(const char **text) {
    uint32_t character;
    size_t length = utf8_decode(*text, strnlen(*text, 4), &character);
    *text += length > 0 ? length : 1;
    return length > 0 ? character : 0xfffd;
}

size_t utf8_cut(const char *text, size_t limit) {
    const char *end = text;
    for (const char *next = text; *next != '\0'; end = next) {
        utf8_next(&next);
        if ((size_t)(next - text) > limit) break;
    }
    return (size_t)(end - text);
}

size_t utf8_put(char *out, uint32_t character) {
    static const uint32_t above[] = {0x80, 0x800, 0x10000};
    static const unsigned char leads[] = {0, 0xc0, 0xe0, 0xf0};
    size_t length = 1;
    while (length < 4 && character >= above[length - 1]) length++;
    for (size_t i = length; i-- > 1; character >>= 6) out[i] = (char)(0x80 | (character & 0x3f));
    out[0] = (char)(leads[length - 1] | character);
    return length;
}

bool array_grow(void **items, size_t *capacity, size_t wanted, size_t item_size) {
    size_t room = *capacity < 8 ? 8 : *capacity;
    while (room < wanted) {
        if (room > SIZE_MAX / 2) return false;
        room *= 2;
    }
    if (room > SIZE_MAX / item_size) return false;
    void *grown = realloc(*items, room * item_size);
    if (grown == NULL) return false;
    *items = grown;
    *capacity = room;
    return true;
}

enum { CACHE_LINE = 64 }; /* bytes: vectors that cross one cost twice */

static size_t whole_lines(size_t size) { return (size + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE; }

bool array_block_reserve(ArrayBlock *block, const ArrayPart *parts, size_t count) {
    size_t size = CACHE_LINE;
    for (size_t i = 0; i < count; i++) size += whole_lines(parts[i].size);
    if (size > block->capacity) {
        const size_t room = size / 2 > block->capacity ? size : 2 * block->capacity;
        void *memory = malloc(room);
        if (memory == NULL) return false;
        free(block->memory);
        *block = (ArrayBlock){memory, room};
    }
    char *next = (char *)block->memory + (whole_lines((uintptr_t)block->memory) - (uintptr_t)block->memory);
    for (size_t i = 0; i < count; i++) {
        memcpy(parts[i].array, &next, sizeof next);
        next += whole_lines(parts[i].size);
    }
    return true;
}
