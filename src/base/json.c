/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads JSON value by value. */
#include "base/json.h"

#include "base/base.h"
#include "base/file.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* A stack that jansson's memory comes from. When it is full, longjmp leaves jansson: it (2.14, 2.15) must never see
   malloc() fail, because it ignores a failure to lengthen a token and then runs past the end of its buffers. */
typedef struct JsonMemory {
    jmp_buf full;
    size_t used, room; /* blocks */
    max_align_t blocks[];
} JsonMemory;

/* Of the value that is being read: jansson's allocator has no context argument. */
static JsonMemory *current;

static void *memory_take(size_t size) {
    size_t left = current->room - current->used;
    if (size > left * sizeof *current->blocks) longjmp(current->full, 1);
    void *block = &current->blocks[current->used];
    current->used += (size + sizeof *current->blocks - 1) / sizeof *current->blocks;
    return block;
}

/* The memory is freed as a whole, before the next value. */
static void memory_keep(void *block) { (void)block; }

/* json_loadb(); false when the memory is full. */
static bool json_load(JsonMemory *memory, const char *text, size_t size, json_t **value, json_error_t *failure) {
    json_malloc_t allocate;
    json_free_t release;
    json_get_alloc_funcs(&allocate, &release);
    memory->used = 0;
    current = memory;
    json_set_alloc_funcs(memory_take, memory_keep);
    if (setjmp(memory->full) != 0) {
        json_set_alloc_funcs(allocate, release);
        return false;
    }
    *value = json_loadb(text, size, JSON_DECODE_ANY | JSON_DISABLE_EOF_CHECK | JSON_REJECT_DUPLICATES, failure);
    json_set_alloc_funcs(allocate, release);
    return true;
}

bool json_read_error(const JsonReader *reader, Error *error, const char *format, ...) {
    char text[1024], where[PATH_MAX];
    PRINT_ARGUMENTS(text, sizeof text, format);
    snprintf(where, sizeof where, "%s:%d:%d", reader->path, reader->value_line, reader->value_column);
    return error_input(error, where, "%s", text);
}

static void json_advance(JsonReader *reader, size_t size) {
    for (const char *to = reader->at + size; reader->at < to; reader->at++) {
        if (*reader->at == '\n') {
            reader->line++;
            reader->column = 1;
        } else if ((*reader->at & 0xc0) != 0x80) { /* not inside a character of UTF-8 */
            reader->column++;
        }
    }
}

/* Errors refer to the place after the white space. */
static void skip_space(JsonReader *reader) {
    while (reader->at < reader->end && *reader->at != '\0' && strchr(" \t\r\n", *reader->at) != NULL)
        json_advance(reader, 1);
    reader->value_line = reader->line;
    reader->value_column = reader->column;
}

/* Sets jansson's error; its lines and columns are relative to the start of the value. */
static void set_error(JsonReader *reader, json_error_t *failure, Error *error) {
    /* Omits the excerpt of the file: it may contain terminal escape sequences. */
    char *excerpt = strstr(failure->text, " near '");
    if (excerpt != NULL) *excerpt = '\0';
    int column = failure->column > 0 ? failure->column : 1;
    reader->value_column = failure->line > 1 ? column : reader->value_column + column - 1;
    reader->value_line += failure->line - 1;
    json_read_error(reader, error, "%s", failure->text);
}

const json_t *json_read_value(JsonReader *reader, Error *error) {
    json_t *value;
    json_error_t failure;
    skip_space(reader);
    size_t left = (size_t)(reader->end - reader->at), size = left < reader->most ? left : reader->most;
    if (!json_load(reader->memory, reader->at, size, &value, &failure))
        return json_read_error(reader, error, "a value must take at most %zu bytes of memory",
                               reader->memory->room * sizeof *reader->memory->blocks),
               NULL;
    if (value != NULL)
        json_advance(reader, (size_t)failure.position);
    else if (size < left && (size_t)failure.position + 4 > size) /* or in the middle of a character of 4 bytes */
        json_read_error(reader, error, "a value must have at most %zu bytes", reader->most);
    else
        set_error(reader, &failure, error);
    return value;
}

bool json_read_char(JsonReader *reader, char c) {
    skip_space(reader);
    if (reader->at == reader->end || *reader->at != c) return false;
    json_advance(reader, 1);
    return true;
}

bool json_read_more(JsonReader *reader, char end, bool *more, Error *error) {
    *more = json_read_char(reader, ',');
    return *more || json_read_char(reader, end) || json_read_error(reader, error, "',' or '%c' expected", end);
}

bool json_read_end(JsonReader *reader, Error *error) {
    skip_space(reader);
    return reader->at == reader->end || json_read_error(reader, error, "end of file expected");
}

bool json_read_open(JsonReader *reader, const char *path, size_t max_size, Error *error) {
    size_t size;
    char *text = file_read(path, max_size, &size, error);
    if (text == NULL) return false;
    *reader = (JsonReader){.path = path, .text = text, .at = text, .end = text + size, .most = JSON_VALUE_SIZE};
    reader->line = reader->column = reader->value_line = reader->value_column = 1;
    reader->memory = malloc(sizeof *reader->memory + JSON_VALUE_MEMORY);
    if (reader->memory != NULL) {
        reader->memory->room = JSON_VALUE_MEMORY / sizeof *reader->memory->blocks;
        return true;
    }
    free(text);
    return error_memory(error, path);
}

void json_read_close(JsonReader *reader) {
    free(reader->memory);
    free(reader->text);
}
