/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "pixels/internal.h"
#include "pixels/png.h"

#include <stdlib.h>
#include <string.h>

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

typedef struct Side {
    PngRows rows;
    const uint8_t *filtered; /* the last row, [1 + bytes] */
    const uint8_t *row;      /* the same unfiltered; zeros before the first */
    uint8_t *unfiltered[2];  /* [bytes], in turns */
    uint8_t *memory;
    Image *image;
} Side;

static bool side_open(Side *side, const uint8_t *data, size_t size, int64_t max_pixels) {
    *side = (Side){.image = NULL};
    if (!png_rows_open(&side->rows, data, size, max_pixels)) return false;
    size_t bytes = side->rows.bytes + 1;
    side->memory = calloc(2, bytes);
    if (side->memory == NULL) return false;
    side->unfiltered[0] = side->memory;
    side->row = side->unfiltered[1] = side->memory + bytes;
    return true;
}

static void side_close(Side *side) {
    png_rows_close(&side->rows);
    free(side->memory);
}

/* Filtered rows are at the end of the picture's own memory: a row of RGBA, which has at least as many bytes as a filtered
   row but for the filter's number, never reaches the next filtered row. */
static bool start(Side *side) {
    Error ignored = {0};
    const PngLayout *layout = &side->rows.layout;
    size_t size = (size_t)layout->width * layout->height * 4 + layout->height;
    side->image = image_create_unset((int)layout->width, (int)layout->height, layout->height, &ignored);
    return side->image != NULL && png_rows_start(&side->rows, side->image->pixels + size - png_rows_size(&side->rows));
}

static bool next(Side *side) { return (side->filtered = png_rows_next(&side->rows)) != NULL; }

static bool unfilter(Side *side, int y) {
    uint8_t *row = side->unfiltered[y % 2];
    bool ok = png_unfilter(side->filtered, side->row, side->rows.bytes, side->rows.step, row);
    side->row = row;
    return ok;
}

static uint8_t *pixels_of(const Image *image, int y) { return image->pixels + (size_t)y * (size_t)image->width * 4; }

static bool expand(const Side *side, int y) {
    return png_expand(&side->rows.layout, side->row, pixels_of(side->image, y));
}

static bool decode(Side *side) {
    if (!start(side)) return false;
    image_provide(side->image);
    for (int y = 0; y < side->image->height; y++)
        if (!next(side) || !unfilter(side, y) || !expand(side, y)) return false;
    return png_rows_end(&side->rows);
}

bool png_fast_decode(const uint8_t *data, size_t size, int64_t max_pixels, Image **image) {
    Side side;
    bool ok = side_open(&side, data, size, max_pixels) && decode(&side);
    side_close(&side);
    if (!ok) image_destroy(side.image);
    *image = ok ? side.image : NULL;
    return ok;
}

/* Two files, row by row. */
typedef struct Pair {
    Side sides[2];
    bool equal;     /* the last row */
    bool all_equal; /* and all above; then the second image is not filled */
} Pair;

static void copy_rows(const Image *from, Image *to, int y, int count) {
    memcpy(pixels_of(to, y), pixels_of(from, y), (size_t)count * (size_t)from->width * 4);
}

/* The rows above are equal. */
static void begin_second(const Image *first, Image *second, int y) {
    image_provide(second);
    copy_rows(first, second, 0, y);
}

/* Equal bytes below equal rows need no unfiltering. */
static bool decode_rows(Pair *pair, int y) {
    Side *first = &pair->sides[0], *second = &pair->sides[1];
    size_t bytes = first->rows.bytes;
    if (!next(first) || !next(second)) return false;
    bool same = pair->equal && memcmp(first->filtered, second->filtered, bytes + 1) == 0;
    if (!unfilter(first, y) || (!same && !unfilter(second, y)) || !expand(first, y)) return false;
    if (same) second->row = first->row;
    pair->equal = same || memcmp(first->row, second->row, bytes) == 0;
    if (pair->all_equal && !pair->equal) begin_second(first->image, second->image, y);
    pair->all_equal = pair->all_equal && pair->equal;
    if (!pair->equal) return expand(second, y);
    if (!pair->all_equal) copy_rows(first->image, second->image, y, 1);
    return true;
}

static bool decode_both(Pair *pair) {
    Side *first = &pair->sides[0], *second = &pair->sides[1];
    if (!png_same_layout(&first->rows.layout, &second->rows.layout) || !start(first) || !start(second)) return false;
    image_provide(first->image);
    for (int y = 0; y < first->image->height; y++)
        if (!decode_rows(pair, y)) return false;
    return png_rows_end(&first->rows) && png_rows_end(&second->rows);
}

bool png_fast_decode_pair(const uint8_t *const data[2], const size_t sizes[2], int64_t max_pixels, Image *images[2]) {
    Pair pair = {.sides = {{.image = NULL}}, .equal = true, .all_equal = true};
    Side *first = &pair.sides[0], *second = &pair.sides[1];
    bool ok = side_open(first, data[0], sizes[0], max_pixels) && side_open(second, data[1], sizes[1], max_pixels) &&
              decode_both(&pair);
    side_close(first);
    side_close(second);
    if (!ok || pair.all_equal) image_destroy(second->image);
    if (!ok) image_destroy(first->image);
    images[0] = ok ? first->image : NULL;
    images[1] = ok && !pair.all_equal ? second->image : images[0];
    return ok;
}
