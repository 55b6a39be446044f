/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The chunks of a PNG file in memory, which may be damaged (PNG specification, section 5.3). */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum { PNG_SIGNATURE = 8, PNG_CHUNK_FRAME = 12 }; /* bytes; of a chunk: length, type and checksum */

typedef struct PngChunk {
    const uint8_t *type; /* [4], followed by the data and the checksum */
    const uint8_t *data;
    size_t length;
} PngChunk;

static inline uint32_t png_number(const uint8_t bytes[4]) {
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* Reads the chunk at *at and moves *at behind it. False at the end of the file, and if the file ends within the chunk. */
static inline bool png_chunk_next(const uint8_t *file, size_t size, size_t *at, PngChunk *chunk) {
    if (*at > size || size - *at < PNG_CHUNK_FRAME) return false;
    *chunk = (PngChunk){file + *at + 4, file + *at + 8, png_number(file + *at)};
    if (chunk->length > size - *at - PNG_CHUNK_FRAME) return false;
    *at += chunk->length + PNG_CHUNK_FRAME;
    return true;
}

static inline bool png_chunk_is(const PngChunk *chunk, const char *type) { return memcmp(chunk->type, type, 4) == 0; }
