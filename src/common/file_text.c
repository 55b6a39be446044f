/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/file.h"

#include <locale.h>
#include <stdlib.h>

/* The text is made in memory first. */
bool file_write_text(const char *path, void (*print)(FILE *out, const void *context), const void *context,
                     Error *error) {
    char *text = NULL;
    size_t size = 0;
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    FILE *out = c != (locale_t)0 ? open_memstream(&text, &size) : NULL;
    bool done = out != NULL;
    if (done) {
        locale_t previous = uselocale(c);
        print(out, context);
        uselocale(previous);
        done = ferror(out) == 0;
        done = fclose(out) == 0 && done;
    }
    done = done ? file_write(path, text, size, error) : error_memory(error, path);
    if (c != (locale_t)0) freelocale(c);
    free(text);
    return done;
}
