/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A deflate stream of one block with a constant dynamic code (RFC 1951, 3.2.7), tuned for the rows of flat pictures,
   most of which equal the row above. With a constant code, the bits of a row depend only on that row. */
#pragma once
#include <stddef.h>
#include <stdint.h>

enum {
    DEFLATE_RUN = 86,           /* pixels of three bytes that one match can repeat: 258 / 3 */
    DEFLATE_LITERAL_BITS = 10,  /* longest code */
    DEFLATE_HEADER_BYTES = 176, /* upper bound of what deflate_begin() writes */
    BITS_MARGIN = 8             /* bytes that a BitWriter may write past its last bit */
};

/* Writes bits from the lowest up, as deflate packs them. */
typedef struct BitWriter {
    uint8_t *next;
    uint64_t pending; /* fewer than 8 bits */
    unsigned count;   /* of pending bits */
} BitWriter;

/* Writes up to 56 bits. Stores eight bytes (compilers emit one store) and advances by the complete ones. */
static inline void bits_write(BitWriter *writer, uint64_t bits, unsigned count) {
    uint8_t *next = writer->next;
    bits = writer->pending | bits << writer->count;
    count += writer->count;
    for (int i = 0; i < 8; i++) next[i] = (uint8_t)(bits >> (8 * i));
    writer->next = next + count / 8;
    writer->pending = bits >> (count & ~7u);
    writer->count = count % 8;
}

/* Completes the last byte with zeros. */
static inline void bits_end(BitWriter *writer) {
    if (writer->count > 0) *writer->next++ = (uint8_t)writer->pending;
    writer->pending = writer->count = 0;
}

typedef struct DeflateCode {
    uint32_t bits, count;
} DeflateCode;

typedef struct DeflateCodes {
    DeflateCode literals[256], end;
    DeflateCode runs[DEFLATE_RUN + 1]; /* [n], n >= 1: repeats the last three bytes n times */
} DeflateCodes;

void deflate_make_codes(DeflateCodes *codes);

/* Writes the header of a zlib stream (RFC 1950) and of its only block. */
void deflate_begin(BitWriter *writer);
