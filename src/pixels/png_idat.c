/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compresses the pixels of PNG files (IDAT).

   Each row goes through the Up filter: pixels that equal those above become zero. Then each run of equal pixels
   becomes one pixel and matches that repeat it. The bits of a row are kept, and its part of the checksum, which is
   computed per run: a row is compressed again only if it or the row above has changed. */
#include "base/base.h"
#include "pixels/pixels_internal.h"
#include "pixels/png.h"

#include <stdlib.h>
#include <string.h>

/* A deflate stream of one block with a constant dynamic code (RFC 1951, 3.2.7), tuned for the rows of flat pictures,
   most of which equal the row above. With a constant code, the bits of a row depend only on that row. */

enum {
    DEFLATE_RUN = 86,           /* pixels of three bytes that one match can repeat: 258 / 3 */
    DEFLATE_LITERAL_BITS = 10,  /* longest code */
    DEFLATE_HEADER_BYTES = 176, /* upper bound of what write_start() writes */
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

static void make_codes(DeflateCodes *codes) {
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

/* Writes the header of a zlib stream (RFC 1950) and of its only block. */
static void write_start(BitWriter *writer) {
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

enum { FILTER_UP = 2, CHANNELS = 3, WORD_BYTES = 8, CHUNK_BITS = 56 };
static const uint64_t ADLER_MODULUS = 65521;

/* The bits, and the row's part of Adler-32: the sum of its bytes, and the sum weighted by the distance from the
   row's end. */
typedef struct Row {
    uint8_t *bits;
    size_t capacity, count;
    uint64_t sum, weighted;
} Row;

struct Idat {
    int width, height;
    DeflateCodes codes;
    uint32_t *differences; /* [width], of a row to the one above, RGBA */
    uint8_t *blank;        /* a row of zeros, above the first row */
    uint8_t *edges;        /* [width + 1], 1 where a run begins; padded by a word */
    uint8_t *scratch;      /* buffer for the largest row */
    uint8_t *data;
    size_t capacity;
    Row rows[]; /* [height]; behind them, in the same block, the four arrays above */
};

static size_t max_row_bytes(int width) {
    return ((size_t)width * CHANNELS + 1) * DEFLATE_LITERAL_BITS / 8 + 1 + BITS_MARGIN;
}

Idat *idat_create(int width, int height, Error *error) {
    const size_t pixels = 4 * (size_t)width, edges = (size_t)width + 1 + WORD_BYTES;
    Idat *idat =
        calloc(1, sizeof *idat + (size_t)height * sizeof *idat->rows + 2 * pixels + edges + max_row_bytes(width));
    if (idat == NULL) return error_memory(error, "image"), NULL;
    idat->width = width, idat->height = height;
    idat->differences = (uint32_t *)(idat->rows + height);
    idat->blank = (uint8_t *)idat->differences + pixels;
    idat->edges = idat->blank + pixels;
    idat->scratch = idat->edges + edges;
    make_codes(&idat->codes);
    return idat;
}

void idat_destroy(Idat *idat) {
    if (idat == NULL) return;
    for (int y = 0; y < idat->height; y++) free(idat->rows[y].bits);
    free(idat->data);
    free(idat);
}

/* The difference of a row to the one above, per byte modulo 256, and the pixels that differ from their left
   neighbour. Simple loops that compilers vectorise: for the baseline instruction set here, for AVX2 below. */
static inline void subtract(uint8_t *differences, const uint8_t *row, const uint8_t *above, int width) {
    for (int i = 0; i < 4 * width; i++) differences[i] = (uint8_t)(row[i] - above[i]);
}

static inline void find_edges(uint8_t *edges, const uint32_t *pixels, int width) {
    static const uint8_t without_alpha[4] = {255, 255, 255, 0};
    uint32_t mask;
    memcpy(&mask, without_alpha, sizeof mask);
    for (int i = 1; i < width; i++) edges[i] = ((pixels[i] ^ pixels[i - 1]) & mask) != 0;
}

static void compare_rows_baseline(Idat *idat, const uint8_t *row, const uint8_t *above) {
    subtract((uint8_t *)idat->differences, row, above, idat->width);
    find_edges(idat->edges, idat->differences, idat->width);
}

#ifdef TWINBOX_AVX
__attribute__((target("avx2"), flatten)) static void compare_rows_avx2(Idat *idat, const uint8_t *row,
                                                                       const uint8_t *above) {
    subtract((uint8_t *)idat->differences, row, above, idat->width);
    find_edges(idat->edges, idat->differences, idat->width);
}
#endif

static void compare_rows(Idat *idat, const uint8_t *row, const uint8_t *above) {
    idat->edges[idat->width] = 1; /* the last run ends with the row */
#ifdef TWINBOX_AVX
    if (__builtin_cpu_supports("avx2")) {
        compare_rows_avx2(idat, row, above);
        return;
    }
#endif
    compare_rows_baseline(idat, row, above);
}

/* Compilers emit one load. */
static uint64_t load_word(const uint8_t *bytes) {
    uint64_t word = 0;
    for (int i = 0; i < WORD_BYTES; i++) word |= (uint64_t)bytes[i] << (8 * i);
    return word;
}

/* Most runs are short: test the next eight edges with one word. */
static int run_length(const uint8_t *edges, int remaining) {
    uint64_t word = load_word(edges + 1);
    if (word != 0) return 1 + __builtin_ctzll(word) / 8;
    return (int)((const uint8_t *)memchr(edges + 1, 1, (size_t)remaining) - edges);
}

static void write_code(BitWriter *writer, DeflateCode code) { bits_write(writer, code.bits, code.count); }

static void write_run(BitWriter *writer, const DeflateCodes *codes, const uint8_t pixel[CHANNELS], int length) {
    DeflateCode a = codes->literals[pixel[0]], b = codes->literals[pixel[1]], c = codes->literals[pixel[2]];
    bits_write(writer, a.bits | (uint64_t)b.bits << a.count | (uint64_t)c.bits << (a.count + b.count),
               a.count + b.count + c.count);
    for (length--; length > DEFLATE_RUN; length -= DEFLATE_RUN) write_code(writer, codes->runs[DEFLATE_RUN]);
    write_code(writer, codes->runs[length]);
}

/* Adds a run to the row's sums. `remaining`: pixels from the run's first to the row's end. The pixels' first bytes
   have the distances 3 * remaining, 3 * (remaining - 1), ... from the end; second and third bytes one and two less. */
static void add_run(Row *row, const uint8_t pixel[CHANNELS], int length, int remaining) {
    uint64_t n = (uint64_t)length, bytes = (uint64_t)pixel[0] + pixel[1] + pixel[2];
    uint64_t places = CHANNELS * (n * (uint64_t)remaining - n * (n - 1) / 2);
    row->sum += n * bytes;
    row->weighted += bytes * places - n * (pixel[1] + 2u * pixel[2]);
}

static bool keep_bits(Row *row, const uint8_t *bits, const BitWriter *end, Error *error) {
    BitWriter writer = *end;
    size_t count = (size_t)(writer.next - bits) * 8 + writer.count;
    bits_end(&writer);
    size_t bytes = (size_t)(writer.next - bits);
    /* write_row() reads whole words. */
    if (!array_reserve((void **)&row->bits, &row->capacity, bytes + WORD_BYTES, 1)) return error_memory(error, "image");
    memcpy(row->bits, bits, bytes);
    row->count = count;
    return true;
}

static bool encode_row(Idat *idat, const uint8_t *pixels, const uint8_t *above, Row *row, Error *error) {
    BitWriter writer = {.next = idat->scratch};
    write_code(&writer, idat->codes.literals[FILTER_UP]);
    row->sum = FILTER_UP;
    row->weighted = FILTER_UP * ((uint64_t)idat->width * CHANNELS + 1);
    if (memcmp(pixels, above, 4 * (size_t)idat->width) == 0) {
        write_run(&writer, &idat->codes, idat->blank, idat->width);
        return keep_bits(row, idat->scratch, &writer, error);
    }
    compare_rows(idat, pixels, above);
    const uint8_t *differences = (const uint8_t *)idat->differences;
    for (int x = 0, length; x < idat->width; x += length) {
        length = run_length(idat->edges + x, idat->width - x);
        write_run(&writer, &idat->codes, differences + 4 * x, length);
        add_run(row, differences + 4 * x, length, idat->width - x);
    }
    return keep_bits(row, idat->scratch, &writer, error);
}

static bool encode_rows(Idat *idat, const Image *image, const bool *changed, Error *error) {
    size_t stride = (size_t)idat->width * 4;
    const uint8_t *pixels = image->pixels, *above = idat->blank;
    for (int y = 0; y < idat->height; y++, above = pixels, pixels += stride) {
        bool kept = changed != NULL && !changed[y] && (y == 0 || !changed[y - 1]);
        if (!kept && !encode_row(idat, pixels, above, &idat->rows[y], error)) return false;
    }
    return true;
}

static void write_row(BitWriter *writer, const Row *row) {
    size_t at = 0;
    for (; at + CHUNK_BITS <= row->count; at += CHUNK_BITS)
        bits_write(writer, load_word(row->bits + at / 8) & (((uint64_t)1 << CHUNK_BITS) - 1), CHUNK_BITS);
    unsigned left = (unsigned)(row->count - at);
    bits_write(writer, load_word(row->bits + at / 8) & (((uint64_t)1 << left) - 1), left);
}

/* Adler-32 (RFC 1950): over a row, b grows by the old a once per byte. */
static uint32_t checksum(const Idat *idat) {
    uint64_t a = 1, b = 0, bytes = (uint64_t)idat->width * CHANNELS + 1;
    for (int y = 0; y < idat->height; y++) {
        const Row *row = &idat->rows[y];
        b = (b + bytes * a + row->weighted) % ADLER_MODULUS;
        a = (a + row->sum) % ADLER_MODULUS;
    }
    return (uint32_t)(b << 16 | a);
}

static size_t joined_size(const Idat *idat) {
    size_t bits = 0;
    for (int y = 0; y < idat->height; y++) bits += idat->rows[y].count;
    return DEFLATE_HEADER_BYTES + bits / 8 + BITS_MARGIN + 16; /* end of block and checksum */
}

bool idat_encode(Idat *idat, const Image *image, const bool *changed, const uint8_t **data, size_t *size,
                 Error *error) {
    if (!encode_rows(idat, image, changed, error)) return false;
    if (!array_reserve((void **)&idat->data, &idat->capacity, joined_size(idat), 1))
        return error_memory(error, "image");
    BitWriter writer = {.next = idat->data};
    write_start(&writer);
    for (int y = 0; y < idat->height; y++) write_row(&writer, &idat->rows[y]);
    write_code(&writer, idat->codes.end);
    bits_end(&writer);
    uint32_t sum = checksum(idat);
    for (int shift = 24; shift >= 0; shift -= 8) *writer.next++ = (uint8_t)(sum >> shift);
    *data = idat->data;
    *size = (size_t)(writer.next - idat->data);
    return true;
}
