/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A deflate stream of one block with one constant code (RFC 1951, 3.2.7), made for the rows of flat pictures of
   which most equal the row above. A constant code makes the bits of a row depend on that row alone. */
#pragma once
#include <stddef.h>
#include <stdint.h>

enum {
    DEFLATE_RUN = 86,           /* pixels, of three bytes each, that one match can repeat: 258 / 3 */
    DEFLATE_LONGEST = 10,       /* bits a literal */
    DEFLATE_HEADER_BYTES = 176, /* what deflate_begin takes, at most */
    BITS_MARGIN = 8             /* bytes that a BitWriter may write behind its last bit */
};

/* Bits, the lowest first, as deflate packs them. */
typedef struct BitWriter {
    uint8_t *next;
    uint64_t pending; /* fewer than 8 bits */
    unsigned count;   /* of them */
} BitWriter;

/* Up to 56 bits. Stores eight bytes each time (compilers make it one store), and moves on by the whole ones. */
static inline void bits_put(BitWriter *writer, uint64_t bits, unsigned count) {
    uint8_t *next = writer->next;
    bits = writer->pending | bits << writer->count;
    count += writer->count;
    for (int i = 0; i < 8; i++) next[i] = (uint8_t)(bits >> (8 * i));
    writer->next = next + count / 8;
    writer->pending = bits >> (count & ~7u);
    writer->count = count % 8;
}

/* The last byte, filled up with zeros. */
static inline void bits_end(BitWriter *writer) {
    if (writer->count > 0) *writer->next++ = (uint8_t)writer->pending;
    writer->pending = writer->count = 0;
}

typedef struct DeflateCode {
    uint32_t bits, count;
} DeflateCode;

typedef struct DeflateCodes {
    DeflateCode literals[256], end;
    DeflateCode runs[DEFLATE_RUN + 1]; /* [n]: the last three bytes n times again, n from 1 */
} DeflateCodes;

void deflate_make_codes(DeflateCodes *codes);

/* The head of a zlib stream (RFC 1950) and of its only block. */
void deflate_begin(BitWriter *writer);
