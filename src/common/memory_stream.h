/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include <stddef.h>
#include <stdio.h>

/* open_memstream(), but memory that runs out sets the stream's error flag: the C library's own stream then drops what does
   not fit, and ferror() and fclose() report success. What cannot be written is dropped from there to the end.

   Returns NULL when memory is short. After fclose(), *text is a malloc'ed string of *size characters, for the caller to
   free, even if writing failed; fflush() makes both current, too. */
FILE *memory_stream(char **text, size_t *size);

/* fwrite() of an array that may be empty, and then NULL. */
static inline void stream_put(FILE *stream, const void *items, size_t size, size_t count) {
    if (count > 0) fwrite(items, size, count, stream);
}
