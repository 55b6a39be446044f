/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The data of one array on its way into a file: checksum and deflate. A small array is one deflate stream. A large one
   is deflated block by block, and only blocks that shrink to a quarter: deflate takes a second per 30 MB to save an
   eighth of velocities, but a tenth of that where a world rests. Only npz_stream.c includes this. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>
#include <zlib.h>

/* Four deflate blocks that are stored. */
enum { NPZ_STORED_MAX = 65535, NPZ_BLOCK_SIZE = 4 * NPZ_STORED_MAX };

typedef struct NpzPack {
    int file;         /* a draft (common/file.h) */
    const char *path; /* for messages */
    bool begun;
    z_stream deflating;
    uint32_t crc;          /* of the data before deflate */
    uint64_t size, packed; /* bytes of the data so far, and bytes written */
    unsigned char *block;  /* [block_used] of a large array, [NPZ_BLOCK_SIZE] */
    size_t block_used;
} NpzPack;

bool npz_pack_begin(NpzPack *pack, bool large, int file, const char *path, Error *error);
bool npz_pack_put(NpzPack *pack, const void *data, size_t size, Error *error);
bool npz_pack_end(NpzPack *pack, Error *error);

/* Puts bytes that are not counted in crc and size, as a deflate block that is stored: at most NPZ_STORED_MAX. */
bool npz_pack_put_stored(NpzPack *pack, const void *data, size_t size, Error *error);

/* Frees what a pack that was begun, or is all zero, holds. */
void npz_pack_free(NpzPack *pack);
