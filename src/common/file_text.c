/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/file.h"

#include "common/memory_stream.h"

#include <locale.h>
#include <stdlib.h>

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

bool file_write_text(const char *path, void (*print)(FILE *out, const void *context), const void *context,
                     Error *error) {
    size_t size;
    char *text = file_print(print, context, &size);
    bool done = text != NULL ? file_write(path, text, size, error) : error_memory(error, path);
    free(text);
    return done;
}
