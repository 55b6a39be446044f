/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The data of one array on its way into a file: checksum, and deflate where the array is deflated. Only npz_stream.c
   includes this. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>
#include <zlib.h>

typedef struct NpzPack {
    int file;         /* a draft (common/file.h) */
    const char *path; /* for messages */
    bool deflates, begun;
    z_stream deflating;
    uint32_t crc;          /* of the data before deflate */
    uint64_t size, packed; /* bytes of the data so far, and bytes written */
} NpzPack;

bool npz_pack_begin(NpzPack *pack, bool deflates, int file, const char *path, Error *error);
bool npz_pack_put(NpzPack *pack, const void *data, size_t size, Error *error);
bool npz_pack_end(NpzPack *pack, Error *error);

/* Frees what a pack that was begun, or is all zero, holds. */
void npz_pack_free(NpzPack *pack);
