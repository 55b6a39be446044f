/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes PNG files: pictures with libpng, whose pixels are compressed here or by libpng; and files of few colours. */
#include "base/base.h"
#include "base/file.h"
#include "pixels/pixels_internal.h"
#include "pixels/png.h"

#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

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

/* The word whose bytes are stored from the lowest up. */
static inline uint64_t as_stored(uint64_t word) {
    return __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? word : __builtin_bswap64(word);
}

/* Writes up to 56 bits. Stores eight bytes and advances by the complete ones. */
static inline void bits_write(BitWriter *writer, uint64_t bits, unsigned count) {
    bits = writer->pending | bits << writer->count;
    count += writer->count;
    memcpy(writer->next, &(uint64_t){as_stored(bits)}, sizeof bits);
    writer->next += count / 8;
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

/* The smallest match of each length symbol, and its number of extra bits (3.2.5). */
static const uint8_t extra_bits[LENGTHS] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                            2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};
static const uint16_t min_match[LENGTHS] = {3,  4,  5,  6,  7,  8,  9,  10, 11,  13,  15,  17,  19,  23, 27,
                                            31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258};

static void make_codes(DeflateCodes *codes) {
    /* The canonical code (RFC 1951, 3.2.2): ascending by length, then by symbol. */
    DeflateCode symbols[SYMBOLS] = {{0, 0}};
    uint32_t next = 0;
    for (unsigned length = 1; length <= DEFLATE_LITERAL_BITS; length++, next <<= 1)
        for (int symbol = 0; symbol < SYMBOLS; symbol++)
            if (code_length(symbol) == length) symbols[symbol] = (DeflateCode){reversed(next++, length), length};
    for (int i = 0; i < LITERALS; i++) codes->literals[i] = symbols[i];
    codes->end = symbols[END_OF_BLOCK];
    codes->runs[0] = (DeflateCode){0, 0};
    for (int n = 1; n <= DEFLATE_RUN; n++) {
        /* The length symbol with its extra bits, then the only distance, whose code is one 0 bit. */
        int i = LENGTHS - 1;
        while (min_match[i] > MATCHED_BYTES * n) i--;
        const DeflateCode code = symbols[FIRST_LENGTH + i];
        codes->runs[n] = (DeflateCode){code.bits | (uint32_t)(MATCHED_BYTES * n - min_match[i]) << code.count,
                                       code.count + extra_bits[i] + 1u};
    }
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
    /* The code lengths are themselves Huffman-coded, here with four bits each; of distances the third is three
       bytes. */
    for (int i = 0; i < SYMBOLS; i++) bits_write(writer, reversed(code_length(i), LENGTH_BITS), LENGTH_BITS);
    for (int i = 1; i <= DISTANCES; i++) bits_write(writer, reversed(i == DISTANCES, LENGTH_BITS), LENGTH_BITS);
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

/* Compresses the pixels of PNG files (IDAT). Each row goes through the Up filter: pixels that equal those above become
   zero. Then each run of equal pixels becomes one pixel and matches that repeat it. The bits of a row are kept, and its
   part of the checksum, which is computed per run: a row is compressed again only if it or the row above has
   changed. */
typedef struct Idat {
    int width, height;
    DeflateCodes codes;
    uint32_t *differences; /* [width], of a row to the one above, RGBA */
    uint8_t *blank;        /* a row of zeros, above the first row */
    uint8_t *edges;        /* [width + 1], 1 where a run begins; padded by a word */
    uint8_t *scratch;      /* buffer for the largest row */
    uint8_t *data;
    size_t capacity;
    Row rows[]; /* [height]; behind them, in the same block, the four arrays above */
} Idat;

static Idat *idat_create(int width, int height, Error *error) {
    const size_t pixels = 4 * (size_t)width, edges = (size_t)width + 1 + WORD_BYTES,
                 row = ((size_t)width * CHANNELS + 1) * DEFLATE_LITERAL_BITS / 8 + 1 + BITS_MARGIN;
    Idat *idat = calloc(1, sizeof *idat + (size_t)height * sizeof *idat->rows + 2 * pixels + edges + row);
    if (idat == NULL) return error_memory(error, "image"), NULL;
    idat->width = width, idat->height = height;
    idat->differences = (uint32_t *)(idat->rows + height);
    idat->blank = (uint8_t *)idat->differences + pixels;
    idat->edges = idat->blank + pixels;
    idat->scratch = idat->edges + edges;
    make_codes(&idat->codes);
    return idat;
}

/* The difference of a row to the one above, per byte modulo 256, and the pixels that differ from their left neighbour.
   Simple loops that compilers vectorise: for the baseline instruction set here, for AVX2 below. */
static inline void compare_rows(Idat *idat, const uint8_t *row, const uint8_t *above) {
    static const uint8_t without_alpha[4] = {255, 255, 255, 0};
    uint8_t *differences = (uint8_t *)idat->differences, *edges = idat->edges;
    const uint32_t *pixels = idat->differences;
    const int width = idat->width;
    uint32_t mask;
    memcpy(&mask, without_alpha, sizeof mask);
    for (int i = 0; i < 4 * width; i++) differences[i] = (uint8_t)(row[i] - above[i]);
    for (int i = 1; i < width; i++) edges[i] = ((pixels[i] ^ pixels[i - 1]) & mask) != 0;
    edges[width] = 1; /* the last run ends with the row */
}

#ifdef TWINBOX_AVX
__attribute__((target("avx2"), flatten)) static void compare_rows_avx2(Idat *idat, const uint8_t *row,
                                                                       const uint8_t *above) {
    compare_rows(idat, row, above);
}
#endif

static inline uint64_t load_word(const uint8_t *bytes) {
    uint64_t word;
    memcpy(&word, bytes, sizeof word);
    return as_stored(word);
}

static void write_code(BitWriter *writer, DeflateCode code) { bits_write(writer, code.bits, code.count); }

static void write_run(BitWriter *writer, const DeflateCodes *codes, const uint8_t pixel[CHANNELS], int length) {
    DeflateCode a = codes->literals[pixel[0]], b = codes->literals[pixel[1]], c = codes->literals[pixel[2]];
    bits_write(writer, a.bits | (uint64_t)b.bits << a.count | (uint64_t)c.bits << (a.count + b.count),
               a.count + b.count + c.count);
    for (length--; length > DEFLATE_RUN; length -= DEFLATE_RUN) write_code(writer, codes->runs[DEFLATE_RUN]);
    write_code(writer, codes->runs[length]);
}

static bool encode_row(Idat *idat, const uint8_t *pixels, const uint8_t *above, Row *row, Error *error) {
    BitWriter writer = {.next = idat->scratch};
    const int width = idat->width;
    write_code(&writer, idat->codes.literals[FILTER_UP]);
    row->sum = FILTER_UP;
    row->weighted = FILTER_UP * ((uint64_t)width * CHANNELS + 1);
    const bool same = memcmp(pixels, above, 4 * (size_t)width) == 0;
    if (same) write_run(&writer, &idat->codes, idat->blank, width);
#ifdef TWINBOX_AVX
    else if (__builtin_cpu_supports("avx2"))
        compare_rows_avx2(idat, pixels, above);
#endif
    else
        compare_rows(idat, pixels, above);
    for (int x = 0, length; !same && x < width; x += length) {
        const uint8_t *pixel = (const uint8_t *)idat->differences + 4 * x, *edges = idat->edges + x;
        const uint64_t word = load_word(edges + 1); /* most runs are short: the next eight edges at once */
        length = word != 0 ? 1 + __builtin_ctzll(word) / 8
                           : (int)((const uint8_t *)memchr(edges + 1, 1, (size_t)(width - x)) - edges);
        write_run(&writer, &idat->codes, pixel, length);
        /* The first bytes of the run's pixels have the distances 3 * (width - x), 3 * (width - x - 1), ... from the
           row's end; second and third bytes one and two less. */
        const uint64_t n = (uint64_t)length, bytes = (uint64_t)pixel[0] + pixel[1] + pixel[2],
                       places = CHANNELS * (n * (uint64_t)(width - x) - n * (n - 1) / 2);
        row->sum += n * bytes;
        row->weighted += bytes * places - n * (pixel[1] + 2u * pixel[2]);
    }
    row->count = (size_t)(writer.next - idat->scratch) * 8 + writer.count;
    bits_end(&writer);
    const size_t bytes = (size_t)(writer.next - idat->scratch);
    /* idat_encode() reads whole words. */
    if (!array_reserve((void **)&row->bits, &row->capacity, bytes + WORD_BYTES, 1)) return error_memory(error, "image");
    memcpy(row->bits, idat->scratch, bytes);
    return true;
}

/* *data is valid until the next call. changed: as for png_encode(). */
static bool idat_encode(Idat *idat, const Image *image, const bool *changed, const uint8_t **data, size_t *size,
                        Error *error) {
    const size_t stride = (size_t)idat->width * 4;
    const uint8_t *pixels = image->pixels, *above = idat->blank;
    size_t bits = 0;
    for (int y = 0; y < idat->height; y++, above = pixels, pixels += stride) {
        const bool kept = changed != NULL && !changed[y] && (y == 0 || !changed[y - 1]);
        if (!kept && !encode_row(idat, pixels, above, &idat->rows[y], error)) return false;
        bits += idat->rows[y].count;
    }
    /* The end of the block and the checksum take less than 16 bytes. */
    if (!array_reserve((void **)&idat->data, &idat->capacity, DEFLATE_HEADER_BYTES + bits / 8 + BITS_MARGIN + 16, 1))
        return error_memory(error, "image");
    BitWriter writer = {.next = idat->data};
    write_start(&writer);
    /* Adler-32 (RFC 1950): over a row, b grows by the old a once per byte. */
    uint64_t a = 1, b = 0, row_bytes = (uint64_t)idat->width * CHANNELS + 1;
    for (int y = 0; y < idat->height; y++) {
        const Row *row = &idat->rows[y];
        for (size_t at = 0; at < row->count; at += CHUNK_BITS) {
            const size_t left = row->count - at;
            const unsigned part = left < CHUNK_BITS ? (unsigned)left : CHUNK_BITS;
            bits_write(&writer, load_word(row->bits + at / 8) & (((uint64_t)1 << part) - 1), part);
        }
        b = (b + row_bytes * a + row->weighted) % ADLER_MODULUS;
        a = (a + row->sum) % ADLER_MODULUS;
    }
    write_code(&writer, idat->codes.end);
    bits_end(&writer);
    for (int shift = 24; shift >= 0; shift -= 8) *writer.next++ = (uint8_t)((b << 16 | a) >> shift);
    *data = idat->data;
    *size = (size_t)(writer.next - idat->data);
    return true;
}

enum { IDAT_PART = 1 << 15 }; /* bytes */

/* Everything that encoding modifies is in this struct, as longjmp would clobber locals. */
struct PngEncoder {
    int width, height;
    Idat *idat; /* NULL: libpng compresses */
    png_structp png;
    png_infop info;
    uint8_t *data;
    size_t size, capacity;
    bool memory_short; /* also of libpng (png_memory_take) */
    char problem[256];
};

PngEncoder *png_encoder_create(int width, int height, PngEffort effort, Error *error) {
    PngEncoder *encoder = calloc(1, sizeof *encoder);
    if (encoder == NULL) return error_memory(error, "image"), NULL;
    *encoder = (PngEncoder){.width = width, .height = height};
    if (effort == PNG_SMALL || (encoder->idat = idat_create(width, height, error)) != NULL) return encoder;
    png_encoder_destroy(encoder);
    return NULL;
}

void png_encoder_destroy(PngEncoder *encoder) {
    if (encoder == NULL) return;
    for (int y = 0; encoder->idat != NULL && y < encoder->idat->height; y++) free(encoder->idat->rows[y].bits);
    if (encoder->idat != NULL) free(encoder->idat->data);
    free(encoder->idat);
    free(encoder->data);
    free(encoder);
}

static void append(png_structp png, png_bytep data, size_t size) {
    PngEncoder *encoder = png_get_io_ptr(png);
    encoder->memory_short = !array_reserve((void **)&encoder->data, &encoder->capacity, encoder->size + size, 1);
    if (encoder->memory_short) png_error(png, "out of memory");
    memcpy(encoder->data + encoder->size, data, size);
    encoder->size += size;
}

static void flush_png_write(png_structp png) { (void)png; }

static PNG_FUNCTION(void, fail, (png_structp png, png_const_charp message), PNG_NORETURN) {
    PngEncoder *encoder = png_get_error_ptr(png);
    snprintf(encoder->problem, sizeof encoder->problem, "%s", message);
    png_longjmp(png, 1);
}

static void ignore_warning(png_structp png, png_const_charp message) { (void)png, (void)message; }

/* pixels NULL: libpng compresses the image. */
static bool write_file(PngEncoder *encoder, const Image *image, const ImageText *texts, int count,
                       const uint8_t *pixels, size_t pixels_size) {
    if (setjmp(png_jmpbuf(encoder->png)) != 0) return false;
    png_structp png = encoder->png;
    png_set_write_fn(png, encoder, append, flush_png_write);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_compression_level(png, 9);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_ALL_FILTERS);
    png_set_IHDR(png, encoder->info, (png_uint_32)image->width, (png_uint_32)image->height, 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    for (int i = 0; i < count; i++) {
        png_text text = {.compression = PNG_ITXT_COMPRESSION_NONE,
                         .key = (png_charp)texts[i].key,
                         .text = (png_charp)texts[i].value};
        png_set_text(png, encoder->info, &text, 1);
    }
    png_write_info(png, encoder->info);
    if (pixels == NULL) {
        png_set_filler(png, 0, PNG_FILLER_AFTER);
        for (int y = 0; y < image->height; y++)
            png_write_row(png, image->pixels + (size_t)y * (size_t)image->width * 4);
        png_write_end(png, NULL);
        return true;
    }
    /* Split, as decoders refuse an IDAT chunk larger than the picture, which noise would produce. */
    for (size_t at = 0; at < pixels_size; at += IDAT_PART)
        png_write_chunk(png, (png_const_bytep) "IDAT", pixels + at,
                        pixels_size - at < IDAT_PART ? pixels_size - at : IDAT_PART);
    png_write_chunk(png, (png_const_bytep) "IEND", NULL, 0);
    return true;
}

bool png_encode(PngEncoder *encoder, const Image *image, const bool *changed, const ImageText *texts, int count,
                const uint8_t **data, size_t *size, Error *error) {
    const uint8_t *pixels = NULL;
    size_t pixels_size = 0;
    if (encoder->idat != NULL && !idat_encode(encoder->idat, image, changed, &pixels, &pixels_size, error))
        return false;
    encoder->size = 0;
    encoder->memory_short = false;
    encoder->png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, encoder, fail, ignore_warning,
                                             &encoder->memory_short, png_memory_take, png_memory_release);
    encoder->info = encoder->png == NULL ? NULL : png_create_info_struct(encoder->png);
    bool ok = encoder->info != NULL || error_memory(error, "image");
    if (ok && !write_file(encoder, image, texts, count, pixels, pixels_size))
        ok =
            encoder->memory_short ? error_memory(error, "image") : error_system(error, "image", "%s", encoder->problem);
    png_destroy_write_struct(&encoder->png, &encoder->info);
    *data = encoder->data;
    *size = encoder->size;
    return ok;
}

bool image_write_png(const Image *image, const char *path, const ImageText *texts, int count, Error *error) {
    const uint8_t *data;
    size_t size;
    PngEncoder *encoder = png_encoder_create(image->width, image->height, PNG_FAST, error);
    bool ok = encoder != NULL && png_encode(encoder, image, NULL, texts, count, &data, &size, error) &&
              file_write(path, data, size, error);
    png_encoder_destroy(encoder);
    return ok;
}

/* A file of few colours, written row by row with zlib. */

enum { IHDR_SIZE = 13, DEPTH = 8 };

struct IndexedPng {
    int width;
    z_stream stream;
    uint8_t *file;
    size_t size, capacity;
    uint8_t part[IDAT_PART]; /* of the compressed pixels */
    uint8_t row[];           /* [1 + width]: PNG's mark of an unfiltered row, 0, and the pixels */
};

static void put_number(uint8_t *to, uint32_t value) {
    for (int i = 0; i < 4; i++) to[i] = (uint8_t)(value >> (24 - 8 * i));
}

/* Length, type, data, CRC of type and data. */
static bool put_chunk(IndexedPng *png, const char *type, const uint8_t *data, size_t size, Error *error) {
    if (!array_reserve((void **)&png->file, &png->capacity, png->size + size + PNG_CHUNK_FRAME, 1))
        return error_memory(error, "image");
    uint8_t *to = png->file + png->size;
    put_number(to, (uint32_t)size);
    memcpy(to + 4, type, 4);
    if (size > 0) memcpy(to + 8, data, size);
    put_number(to + 8 + size, (uint32_t)crc32_z(0, to + 4, size + 4));
    png->size += size + PNG_CHUNK_FRAME;
    return true;
}

IndexedPng *indexed_png_create(int width, int height, const Palette *palette, Error *error) {
    enum { LEVEL = 3 }; /* from 4 on, time doubles for a tenth of the bytes */
    uint8_t header[IHDR_SIZE] = {[8] = DEPTH, [9] = PNG_PALETTE};
    IndexedPng *png = calloc(1, sizeof *png + (size_t)width + 1);
    if (png == NULL || deflateInit(&png->stream, LEVEL) != Z_OK) {
        free(png);
        error_memory(error, "image");
        return NULL;
    }
    png->width = width;
    png->stream.next_out = png->part, png->stream.avail_out = IDAT_PART;
    put_number(header, (uint32_t)width);
    put_number(header + 4, (uint32_t)height);
    bool ok = array_reserve((void **)&png->file, &png->capacity, PNG_SIGNATURE, 1) || error_memory(error, "image");
    if (ok) memcpy(png->file, png_signature, png->size = PNG_SIGNATURE);
    ok = ok && put_chunk(png, "IHDR", header, sizeof header, error) &&
         put_chunk(png, "PLTE", palette->rgb[0], 3 * (size_t)palette->count, error) &&
         (!palette->clear || put_chunk(png, "tRNS", &(uint8_t){0}, 1, error));
    if (ok) return png;
    indexed_png_destroy(png);
    return NULL;
}

void indexed_png_destroy(IndexedPng *png) {
    if (png == NULL) return;
    deflateEnd(&png->stream);
    free(png->file);
    free(png);
}

uint8_t *indexed_png_row(IndexedPng *png) { return png->row + 1; }

/* Each full part becomes a chunk: decoders refuse an IDAT chunk that is larger than the picture. */
static bool put_part(IndexedPng *png, Error *error) {
    if (!put_chunk(png, "IDAT", png->part, IDAT_PART - png->stream.avail_out, error)) return false;
    png->stream.next_out = png->part, png->stream.avail_out = IDAT_PART;
    return true;
}

bool indexed_png_add(IndexedPng *png, Error *error) {
    png->stream.next_in = png->row, png->stream.avail_in = (uInt)png->width + 1;
    do {
        deflate(&png->stream, Z_NO_FLUSH);
        if (png->stream.avail_out == 0 && !put_part(png, error)) return false;
    } while (png->stream.avail_in > 0);
    return true;
}

uint8_t *indexed_png_end(IndexedPng *png, size_t *size, Error *error) {
    for (bool ended = false; !ended;) {
        ended = deflate(&png->stream, Z_FINISH) == Z_STREAM_END;
        if (!put_part(png, error)) return NULL;
    }
    if (!put_chunk(png, "IEND", NULL, 0, error)) return NULL;
    uint8_t *file = png->file;
    *size = png->size;
    png->file = NULL;
    return file;
}
