/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE
/* Text that is printed into memory. */
#include "base/file.h"

#include <locale.h>
#include <stdlib.h>
#include <string.h>

typedef struct MemoryStream {
    char **text;
    size_t *size, capacity;
    bool full;
} MemoryStream;

static bool stream_reserve(MemoryStream *stream, size_t wanted) {
    if (wanted <= stream->capacity) return true;
    size_t capacity = stream->capacity;
    while (capacity < wanted) capacity *= 2;
    char *text = realloc(*stream->text, capacity);
    if (text == NULL) return false;
    *stream->text = text;
    stream->capacity = capacity;
    return true;
}

static ssize_t stream_add(void *cookie, const char *data, size_t size) {
    MemoryStream *stream = cookie;
    /* A text without its middle would be worse than one without its end. */
    stream->full = stream->full || !stream_reserve(stream, *stream->size + size + 1);
    if (stream->full) return 0;
    memcpy(*stream->text + *stream->size, data, size);
    *stream->size += size;
    (*stream->text)[*stream->size] = '\0';
    return (ssize_t)size;
}

/* For ftell(). */
static int stream_tell(void *cookie, off64_t *offset, int whence) {
    const MemoryStream *stream = cookie;
    if (whence == SEEK_SET || *offset != 0) return -1;
    *offset = (off64_t)*stream->size;
    return 0;
}

static int stream_end(void *cookie) {
    free(cookie);
    return 0;
}

FILE *memory_stream(char **text, size_t *size) {
    enum { FIRST = 1024 };
    MemoryStream *stream = malloc(sizeof *stream);
    char *first = malloc(FIRST);
    FILE *file = NULL;
    if (stream != NULL && first != NULL)
        file = fopencookie(stream, "w",
                           (cookie_io_functions_t){.write = stream_add, .seek = stream_tell, .close = stream_end});
    if (file == NULL) {
        free(first);
        free(stream);
        return NULL;
    }
    first[0] = '\0';
    *text = first;
    *size = 0;
    *stream = (MemoryStream){.text = text, .size = size, .capacity = FIRST};
    return file;
}

char *file_print(void (*print)(FILE *out, const void *context), const void *context, size_t *size) {
    char *text = NULL;
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    FILE *out = c != (locale_t)0 ? memory_stream(&text, size) : NULL;
    bool done = out != NULL;
    if (done) {
        locale_t previous = uselocale(c);
        print(out, context);
        uselocale(previous);
        done = ferror(out) == 0;
        done = fclose(out) == 0 && done;
    }
    if (c != (locale_t)0) freelocale(c);
    if (done) return text;
    free(text);
    return NULL;
}
