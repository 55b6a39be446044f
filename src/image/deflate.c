/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/deflate.h"

enum { LITERALS = 256, END_OF_BLOCK = 256, FIRST_LENGTH = 257, LENGTHS = 29, SYMBOLS = FIRST_LENGTH + LENGTHS };
enum { LENGTH_BITS = 4, MATCHED_BYTES = 3 };

/* Code length in bits of each symbol, in hexadecimal: Huffman lengths for the filtered rows of frames of all scenes
   at 720p, 1080p and 4K, with 0.0008 added to each symbol's frequency to bound the lengths. Match lengths that are
   not whole pixels have none. */
static const char code_lengths[SYMBOLS + 1] = "297888888879879788a898899899999989999999999998a99a9999999999999999999a99"
                                              "a9999a99a999a999aa99aaa99a99a99a9999aaa9aa99aaaa99aa99a999aa9aa99aaaa9aa"
                                              "a9aaa9aa9a99a99a99aaaa9aa999aa99a99a9a99a99a999a999999999999999999a99999"
                                              "9999999989998999998898988787887888888889a700800808099999a9997779888893";

static unsigned code_length(int symbol) {
    char digit = code_lengths[symbol];
    return (unsigned)(digit < 'a' ? digit - '0' : digit - 'a' + 10);
}

/* Huffman codes are packed from their highest bit, everything else from the lowest. */
static uint32_t reversed(uint32_t bits, unsigned count) {
    uint32_t result = 0;
    for (unsigned i = 0; i < count; i++) result |= (bits >> i & 1) << (count - 1 - i);
    return result;
}

/* The canonical code (RFC 1951, 3.2.2): ascending by length, then by symbol. */
static void make_canonical(DeflateCode codes[SYMBOLS]) {
    uint32_t next = 0;
    for (unsigned length = 1; length <= DEFLATE_LITERAL_BITS; length++, next <<= 1)
        for (int symbol = 0; symbol < SYMBOLS; symbol++)
            if (code_length(symbol) == length) codes[symbol] = (DeflateCode){reversed(next++, length), length};
}

/* The smallest match of each length symbol, and its number of extra bits (3.2.5). */
static const uint8_t extra_bits[LENGTHS] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                            2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
static const uint16_t min_match[LENGTHS] = {3,  4,  5,  6,  7,  8,  9,  10, 11,  13,  15,  17,  19,  23, 27,
                                            31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258};

/* The length symbol with its extra bits, then the only distance, whose code is one 0 bit. */
static DeflateCode match_code(const DeflateCode codes[SYMBOLS], int pixels) {
    int match = MATCHED_BYTES * pixels, i = LENGTHS - 1;
    while (min_match[i] > match) i--;
    DeflateCode code = codes[FIRST_LENGTH + i];
    code.bits |= (uint32_t)(match - min_match[i]) << code.count;
    code.count += extra_bits[i] + 1u;
    return code;
}

void deflate_make_codes(DeflateCodes *codes) {
    DeflateCode symbols[SYMBOLS] = {{0, 0}};
    make_canonical(symbols);
    for (int i = 0; i < LITERALS; i++) codes->literals[i] = symbols[i];
    codes->end = symbols[END_OF_BLOCK];
    codes->runs[0] = (DeflateCode){0, 0};
    for (int n = 1; n <= DEFLATE_RUN; n++) codes->runs[n] = match_code(symbols, n);
}

/* The code lengths are themselves Huffman-coded, here with four bits each. */
static void write_code_length(BitWriter *writer, unsigned length) {
    bits_write(writer, reversed(length, LENGTH_BITS), LENGTH_BITS);
}

void deflate_begin(BitWriter *writer) {
    enum { DISTANCES = 3, LENGTH_SYMBOLS = 19, REPEATS = 3 };
    bits_write(writer, 0x0178, 16); /* zlib: deflate, window of 32 KiB, fastest */
    bits_write(writer, 1, 1);       /* last block */
    bits_write(writer, 2, 2);       /* dynamic Huffman codes */
    bits_write(writer, SYMBOLS - FIRST_LENGTH, 5);
    bits_write(writer, DISTANCES - 1, 5);
    bits_write(writer, LENGTH_SYMBOLS - 4, 4);
    bits_write(writer, 0, 3 * REPEATS); /* the symbols that repeat lengths come first and are unused */
    for (int i = REPEATS; i < LENGTH_SYMBOLS; i++) bits_write(writer, LENGTH_BITS, 3);
    for (int i = 0; i < SYMBOLS; i++) write_code_length(writer, code_length(i));
    for (int i = 1; i < DISTANCES; i++) write_code_length(writer, 0);
    write_code_length(writer, 1); /* the third distance symbol: three bytes */
}
