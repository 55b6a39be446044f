/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "npz/npz_pack.h"

#include "common/file.h"

#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

/* zlib's default for small arrays; level 9 made a file of positions no smaller. For large ones the fastest. */
enum { SMALL_LEVEL = 6, LARGE_LEVEL = 1 };

/* Raw deflate, as in a zip, with the largest window and memory. */
enum { RAW_WINDOW = -MAX_WBITS };

/* The start of a block, which tells whether the rest is worth deflating: if it shrinks to a quarter. */
enum { SAMPLE_SIZE = 1 << 14, SHRINKS_TO = 4 };

bool npz_pack_begin(NpzPack *pack, bool large, int file, const char *path, Error *error) {
    *pack = (NpzPack){.file = file, .path = path, .crc = libdeflate_crc32(0, NULL, 0)};
    if (large && (pack->block = malloc(NPZ_BLOCK_SIZE)) == NULL) return error_memory(error, path);
    pack->begun = deflateInit2(&pack->deflating, large ? LARGE_LEVEL : SMALL_LEVEL, Z_DEFLATED, RAW_WINDOW,
                               MAX_MEM_LEVEL, Z_DEFAULT_STRATEGY) == Z_OK;
    return pack->begun || error_memory(error, path);
}

static bool put_bytes(NpzPack *pack, const void *data, size_t size, Error *error) {
    pack->packed += size;
    return file_draft_write(pack->file, pack->path, data, size, error);
}

/* Deflates as much as the output takes and returns its size. */
static size_t deflate_some(NpzPack *pack, int flush, unsigned char *out, size_t room) {
    pack->deflating.next_out = out;
    pack->deflating.avail_out = (unsigned)room;
    deflate(&pack->deflating, flush);
    return room - pack->deflating.avail_out;
}

static bool deflate_all(NpzPack *pack, const void *data, size_t size, int flush, Error *error) {
    unsigned char out[1 << 15];
    pack->deflating.next_in = (unsigned char *)data;
    pack->deflating.avail_in = (unsigned)size;
    for (size_t used = sizeof out; used == sizeof out;) {
        used = deflate_some(pack, flush, out, sizeof out);
        if (!put_bytes(pack, out, used, error)) return false;
    }
    return true;
}

bool npz_pack_put_stored(NpzPack *pack, const void *data, size_t size, Error *error) {
    const unsigned char head[] = {0, (unsigned char)(size & 0xff), (unsigned char)(size >> 8),
                                  (unsigned char)(~size & 0xff), (unsigned char)(~size >> 8 & 0xff)};
    return put_bytes(pack, head, sizeof head, error) && put_bytes(pack, data, size, error);
}

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

/* A full flush ends the sample at a whole byte, and nothing after it refers back: it may be dropped. */
static bool put_block(NpzPack *pack, Error *error) {
    unsigned char out[2 * SAMPLE_SIZE];
    const size_t size = pack->block_used, sample = least(size, SAMPLE_SIZE);
    pack->block_used = 0;
    pack->deflating.next_in = pack->block;
    pack->deflating.avail_in = (unsigned)sample;
    const size_t used = deflate_some(pack, Z_FULL_FLUSH, out, sizeof out);
    if (used <= sample / SHRINKS_TO)
        return put_bytes(pack, out, used, error) &&
               (size == sample || deflate_all(pack, pack->block + sample, size - sample, Z_FULL_FLUSH, error));
    bool done = true;
    for (size_t at = 0; done && at < size; at += NPZ_STORED_MAX)
        done = npz_pack_put_stored(pack, pack->block + at, least(size - at, NPZ_STORED_MAX), error);
    return done;
}

static bool put_large(NpzPack *pack, const unsigned char *data, size_t size, Error *error) {
    for (size_t at = 0, piece; at < size; at += piece) {
        piece = least(size - at, NPZ_BLOCK_SIZE - pack->block_used);
        memcpy(pack->block + pack->block_used, data + at, piece);
        pack->block_used += piece;
        if (pack->block_used == NPZ_BLOCK_SIZE && !put_block(pack, error)) return false;
    }
    return true;
}

bool npz_pack_put(NpzPack *pack, const void *data, size_t size, Error *error) {
    if (size == 0) return true;
    pack->crc = libdeflate_crc32(pack->crc, data, size); /* ten times as fast as zlib's */
    pack->size += size;
    return pack->block != NULL ? put_large(pack, data, size, error) : deflate_all(pack, data, size, Z_NO_FLUSH, error);
}

bool npz_pack_end(NpzPack *pack, Error *error) {
    static const unsigned char last[] = {3, 0}; /* an empty block that says that it is the last */
    if (pack->block == NULL) return deflate_all(pack, NULL, 0, Z_FINISH, error);
    return (pack->block_used == 0 || put_block(pack, error)) && put_bytes(pack, last, sizeof last, error);
}

void npz_pack_free(NpzPack *pack) {
    if (pack->begun) deflateEnd(&pack->deflating);
    free(pack->block);
    pack->block = NULL;
    pack->begun = false;
}
