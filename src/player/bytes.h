/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Deflated bytes on their way into a page. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

typedef struct Bytes {
    uint8_t *data; /* freed by the caller; NULL: nothing */
    size_t size;
} Bytes;

/* Deflates (RFC 1951, as browsers' DecompressionStream("deflate-raw") reads it). False with error set when memory is short. */
bool bytes_deflate(Bytes *bytes, const void *data, size_t size, Error *error);

/* Differences, small ones of either sign, as small numbers: 0, -1, 1, -2, ... become 0, 1, 2, 3, ... */
static inline uint32_t bytes_zigzag(uint32_t difference) { return difference << 1 ^ (0 - (difference >> 31)); }

/* Puts number i of `count` into four planes of `count` bytes each, the lowest bytes first: equal bytes of like numbers
   follow each other. */
static inline void bytes_put(uint8_t *planes, size_t count, size_t i, uint32_t number) {
    for (int plane = 0; plane < 4; plane++) planes[(size_t)plane * count + i] = (uint8_t)(number >> (8 * plane));
}
