/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "player/bytes.h"

#include <limits.h>
#include <stdlib.h>
#include <zlib.h>

enum { RAW_WINDOW = -15, MOST_MEMORY = 9 };

bool bytes_deflate(Bytes *bytes, const void *data, size_t size, Error *error) {
    z_stream stream = {0};
    *bytes = (Bytes){0};
    if (size > UINT_MAX / 2 ||
        deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, RAW_WINDOW, MOST_MEMORY, Z_DEFAULT_STRATEGY) != Z_OK)
        return error_memory(error, "page");
    const uLong bound = deflateBound(&stream, (uLong)size);
    bytes->data = malloc(bound);
    stream.next_in = (z_const Bytef *)data, stream.avail_in = (uInt)size;
    stream.next_out = bytes->data, stream.avail_out = (uInt)bound;
    const bool ok = bytes->data != NULL && deflate(&stream, Z_FINISH) == Z_STREAM_END;
    bytes->size = ok ? stream.total_out : 0;
    deflateEnd(&stream);
    return ok || error_memory(error, "page");
}
