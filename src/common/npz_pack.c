/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/npz_pack.h"

#include "common/file.h"

#include <libdeflate.h>

/* zlib's default. Level 9 made a file of positions no smaller. */
enum { DEFLATE_LEVEL = 6 };

/* Raw deflate, as in a zip, with the largest window and memory. */
enum { RAW_WINDOW = -MAX_WBITS };

bool npz_pack_begin(NpzPack *pack, bool deflates, int file, const char *path, Error *error) {
    *pack = (NpzPack){.file = file, .path = path, .deflates = deflates, .crc = libdeflate_crc32(0, NULL, 0)};
    pack->begun = !deflates || deflateInit2(&pack->deflating, DEFLATE_LEVEL, Z_DEFLATED, RAW_WINDOW, MAX_MEM_LEVEL,
                                            Z_DEFAULT_STRATEGY) == Z_OK;
    return pack->begun || error_memory(error, path);
}

/* Deflates what is given; with Z_FINISH, all that is left. */
static bool deflate_all(NpzPack *pack, int flush, Error *error) {
    unsigned char packed[1 << 15];
    z_stream *deflating = &pack->deflating;
    do {
        deflating->next_out = packed;
        deflating->avail_out = sizeof packed;
        if (deflate(deflating, flush) == Z_STREAM_ERROR) return error_system(error, pack->path, "cannot deflate");
        size_t size = sizeof packed - deflating->avail_out;
        if (!file_draft_write(pack->file, pack->path, packed, size, error)) return false;
        pack->packed += size;
    } while (deflating->avail_out == 0);
    return true;
}

/* zlib counts in unsigned int. */
static bool put_piece(NpzPack *pack, const unsigned char *data, unsigned size, Error *error) {
    pack->crc = libdeflate_crc32(pack->crc, data, size); /* ten times as fast as zlib's */
    pack->size += size;
    if (!pack->deflates) {
        pack->packed += size;
        return file_draft_write(pack->file, pack->path, data, size, error);
    }
    pack->deflating.next_in = (unsigned char *)data;
    pack->deflating.avail_in = size;
    return deflate_all(pack, Z_NO_FLUSH, error);
}

bool npz_pack_put(NpzPack *pack, const void *data, size_t size, Error *error) {
    enum { PIECE = 1 << 18 }; /* in the cache between checksum and copy */
    for (size_t at = 0; at < size; at += PIECE)
        if (!put_piece(pack, (const unsigned char *)data + at, (unsigned)(size - at < PIECE ? size - at : PIECE),
                       error))
            return false;
    return true;
}

bool npz_pack_end(NpzPack *pack, Error *error) {
    if (!pack->deflates) return true;
    pack->deflating.avail_in = 0;
    return deflate_all(pack, Z_FINISH, error);
}

void npz_pack_free(NpzPack *pack) {
    if (pack->begun && pack->deflates) deflateEnd(&pack->deflating);
    pack->begun = false;
}
