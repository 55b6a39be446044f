/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fast decoder against libpng, on thousands of files: of every layout, filter, compression and split into chunks;
   then the same files damaged, with checksums that are made right again. What it accepts, libpng accepts, with the same
   pixels; and it accepts what it is for. */
#include "owned.h"

#include "regression/image_compare.h"
#include "pixels/pixels_internal.h"

#include "png_parts.h"

static uint32_t seed = 1;

static uint32_t draw(uint32_t below) {
    seed = seed * 1664525 + 1013904223;
    return (uint32_t)((uint64_t)(seed >> 8) * below >> 24);
}

enum { SIDE = 48, ROOM = sizeof((PngParts *)NULL)->data, CHUNKS = 4096 };

typedef struct Kind {
    int color, depth, channels;
} Kind;

static const Kind kinds[] = {{0, 1, 1}, {0, 2, 1}, {0, 4, 1}, {0, 8, 1},  {2, 8, 3},  {3, 1, 1},  {3, 2, 1}, {3, 4, 1},
                             {3, 8, 1}, {4, 8, 2}, {6, 8, 4}, {0, 16, 1}, {2, 16, 3}, {4, 16, 2}, {6, 16, 4}};
enum { KINDS = sizeof kinds / sizeof kinds[0], SHALLOW = 11 };

/* Flat, stripes, or noise. */
static size_t make_rows(const Kind *kind, int width, int height, uint32_t filters, uint8_t *rows) {
    uint32_t look = draw(3);
    size_t bytes = ((size_t)width * (size_t)(kind->channels * kind->depth) + 7) / 8;
    uint8_t *to = rows;
    for (int y = 0; y < height; y++) {
        *to++ = (uint8_t)(look == 0 ? 0 : draw(filters));
        for (size_t i = 0; i < bytes; i++) *to++ = (uint8_t)(look == 0 ? 0 : look == 1 ? i / 7 % 3 : draw(256));
    }
    return (size_t)(to - rows);
}

static void put_palette(PngParts *file, const Kind *kind, bool whole) {
    uint8_t data[768];
    uint32_t most = kind->color == 3 ? 1u << kind->depth : 256, count = whole ? most : 1 + draw(most);
    for (uint32_t i = 0; i < 3 * count; i++) data[i] = (uint8_t)draw(256);
    if (kind->color == 3 || (kind->color == 2 && draw(8) == 0)) put_chunk(file, "PLTE", data, 3 * count);
    if (draw(3) > 0) return;
    for (int i = 0; i < 6; i++) data[i] = (uint8_t)(i % 2 == 0 ? 0 : draw(2));
    if (kind->color == 0) put_chunk(file, "tRNS", data, 2);
    if (kind->color == 2) put_chunk(file, "tRNS", data, 6);
    if (kind->color == 3) put_chunk(file, "tRNS", data, 1 + draw(count));
}

static void put_other(PngParts *file) {
    static const char *const types[] = {"tEXt", "gAMA", "bKGD", "sBIT", "pHYs", "zTXt",
                                        "iCCP", "heLo", "eXIf", "tIME", "hIST"};
    uint8_t data[40];
    for (size_t i = 0; i < sizeof data; i++) data[i] = (uint8_t)draw(256);
    if (draw(4) == 0) put_chunk(file, types[draw(11)], data, draw(sizeof data));
}

/* Window of 2^bits. */
static size_t compress_rows(const uint8_t *rows, size_t size, int bits, uint8_t *packed) {
    z_stream stream = {0};
    assert_int_equal(deflateInit2(&stream, (int)draw(10), Z_DEFLATED, bits, 8, (int)draw(5)), Z_OK);
    stream.next_in = (z_const Bytef *)rows, stream.avail_in = (uInt)size;
    stream.next_out = packed, stream.avail_out = ROOM / 2;
    assert_int_equal(deflate(&stream, Z_FINISH), Z_STREAM_END);
    deflateEnd(&stream);
    return stream.total_out;
}

static void put_pixels(PngParts *file, const uint8_t *packed, size_t size) {
    for (size_t at = 0, part; at < size; at += part) {
        part = draw(2) == 0 ? size : draw(40);
        if (part > size - at) part = size - at;
        put_chunk(file, "IDAT", packed + at, part);
    }
}

/* Bytes of the rows that are replaced, and whether the rows are then compressed otherwise, in the next file. */
static struct {
    int bytes;
    bool otherwise;
} changes;

static void change_rows(uint8_t *rows, size_t size, int height) {
    uint32_t row = (uint32_t)(size / (size_t)height);
    for (int i = 0; i < changes.bytes; i++) {
        uint32_t place = draw((uint32_t)size);
        if (i % 2 == 0) place -= place % row; /* the filter */
        rows[place] = (uint8_t)draw(place % row == 0 ? 5 : 2);
    }
    if (changes.otherwise) draw(1);
}

/* sound: every filter is known, every colour in the palette, and the window as large as usual. */
static void make_file(PngParts *file, const Kind *kind, bool sound) {
    static uint8_t rows[SIDE * (SIDE * 8 + 1)], packed[ROOM / 2];
    int width = 1 + (int)draw(SIDE), height = 1 + (int)draw(SIDE);
    put_header(file, (uint32_t)width, (uint32_t)height, kind->depth, kind->color);
    put_other(file);
    put_palette(file, kind, sound);
    put_other(file);
    size_t size = make_rows(kind, width, height, sound || draw(4) > 0 ? 5 : 6, rows);
    change_rows(rows, size, height);
    put_pixels(file, packed, compress_rows(rows, size, sound ? 15 : 9 + (int)draw(7), packed));
    put_other(file);
    put_chunk(file, "IEND", NULL, 0);
}

static void assert_same(const Image *a, const Image *b) {
    assert_true(a->width == b->width && a->height == b->height);
    assert_memory_equal(a->pixels, b->pixels, (size_t)a->width * (size_t)a->height * 4);
}

/* What libpng makes of an accepted file; NULL for an incomplete code, which ISA-L reads (pixels_internal.h). */
static Image *accepted_by_libpng(const PngParts *file) {
    Error error = {0};
    Image *image = png_libpng_decode(file->data, file->size, "file", 1 << 20, &error);
    if (image != NULL) {
        assert_null(image->pixels16);
        return image;
    }
    assert_error(error, ERROR_INPUT, "IDAT: invalid");
    assert_error(error, ERROR_INPUT, " set");
    return NULL;
}

/* Whether the fast decoder accepts. */
static bool check_file(const PngParts *file) {
    Image *fast;
    if (!png_fast_decode(file->data, file->size, 1 << 20, &fast)) {
        assert_null(fast);
        return false;
    }
    OWN(Image) *wanted = accepted_by_libpng(file);
    if (wanted != NULL) assert_same(fast, wanted);
    image_destroy(fast);
    return true;
}

static PngParts good, bad;

TEST(what_it_is_for_is_accepted) {
    for (int i = 0; i < 4000; i++) {
        make_file(&good, &kinds[i % KINDS], true);
        assert_int_equal(check_file(&good), i % KINDS < SHALLOW);
    }
}

/* The second half of the picture repeats the first, 2 KiB behind it; the header claims a window of 256 bytes. */
TEST(a_window_that_is_too_small_is_left_to_libpng) {
    enum { WIDTH = 32, HEIGHT = 32, BYTES = 1 + 4 * WIDTH };
    uint8_t rows[HEIGHT][BYTES], packed[2 * sizeof rows];
    for (int y = 0; y < HEIGHT; y++)
        for (int i = 0; i < BYTES; i++)
            rows[y][i] = (uint8_t)(i == 0 ? 0 : y < HEIGHT / 2 ? draw(256) : rows[y - HEIGHT / 2][i]);
    for (int i = 0; i < 40; i++) {
        size_t size = compress_rows(rows[0], sizeof rows, 15, packed);
        int window = i % 2 == 0 ? 15 : 8;
        packed[0] = (uint8_t)((window - 8) << 4 | 8);
        packed[1] = (uint8_t)(31 - (packed[0] << 8) % 31);
        put_header(&good, WIDTH, HEIGHT, 8, 6);
        put_chunk(&good, "IDAT", packed, size);
        put_chunk(&good, "IEND", NULL, 0);
        assert_int_equal(check_file(&good), window == 15);
    }
}

/* Positions of the chunks, and the end of the last one. */
static int find_chunks(const PngParts *file, size_t at[CHUNKS]) {
    int count = 0;
    for (at[0] = 8; at[count] < file->size; count++)
        at[count + 1] = at[count] + 12 + png_number(file->data + at[count]);
    return count;
}

/* Removes chunk i, moves it to j, or copies it there. */
static void rearrange(const size_t at[CHUNKS], int count) {
    int i = (int)draw((uint32_t)count), j = (int)draw((uint32_t)count);
    bool copy = draw(2) == 0, insert = draw(2) == 0;
    bad.size = 0;
    put_bytes(&bad, good.data, 8);
    for (int k = 0; k < count; k++) {
        if (k == j && insert) put_bytes(&bad, good.data + at[i], at[i + 1] - at[i]);
        if (k != i || copy) put_bytes(&bad, good.data + at[k], at[k + 1] - at[k]);
    }
}

static void make_checksum(uint8_t *chunk) {
    uint32_t length = png_number(chunk);
    store_number(chunk + 8 + length, (uint32_t)crc32(0, chunk + 4, length + 4));
}

/* Changes bytes of a chunk, its type included, and makes its checksum right. In headers and at the ends of chunks,
   where the stream's own checksum is, more often than elsewhere. */
static void change_chunk(uint8_t *chunk) {
    uint32_t length = png_number(chunk), from = draw(16) == 0 ? 0 : 4;
    if (from == 4 && length == 0) return;
    for (uint32_t n = 1 + draw(2); n > 0; n--) {
        uint32_t place =
            from == 0 ? draw(4) : 4 + (draw(3) == 0 ? length - 1 - draw(length < 4 ? length : 4) : draw(length));
        chunk[4 + place] = (uint8_t)(draw(2) == 0 ? draw(256) : chunk[4 + place] ^ 1u << draw(8));
    }
    make_checksum(chunk);
}

/* Adds bytes to a chunk, or takes some from its end. */
static void resize_chunk(const size_t at[CHUNKS], int i) {
    uint8_t bytes[8];
    uint32_t length = png_number(good.data + at[i]), kept = draw(2) == 0 ? length : length - draw(length + 1),
             more = draw(5);
    for (size_t k = 0; k < sizeof bytes; k++) bytes[k] = (uint8_t)draw(256);
    bad.size = 0;
    put_bytes(&bad, good.data, at[i] + 8 + kept);
    put_bytes(&bad, bytes, more + 4);
    store_number(bad.data + at[i], kept + more);
    make_checksum(bad.data + at[i]);
    put_bytes(&bad, good.data + at[i + 1], good.size - at[i + 1]);
}

static void damage(void) {
    static size_t at[CHUNKS];
    int count = find_chunks(&good, at), i = (int)draw((uint32_t)count);
    bad.size = good.size;
    memcpy(bad.data, good.data, good.size);
    uint32_t how = draw(16);
    if (how == 0) bad.size = draw((uint32_t)good.size);
    if (how == 1) bad.data[draw((uint32_t)good.size)] ^= (uint8_t)(1u << draw(8));
    if (how == 2) store_number(bad.data + at[i], draw(2) == 0 ? draw(100) : draw(1 << 24) << 8);
    if (how >= 3 && how < 6) rearrange(at, count);
    if (how >= 6 && how < 9) resize_chunk(at, i);
    if (how >= 9) change_chunk(bad.data + at[how < 11 ? 0 : i]);
}

/* Rows as the bands give them, in pictures; rows that are not given stay as they are. */
typedef struct Given {
    Image *images[2];
    uint8_t *rows[2]; /* where they are placed */
    int last, equal;
} Given;

static bool begin_given(void *context, int width, int height) {
    Given *given = context;
    for (int i = 0; i < 2; i++) {
        given->images[i] = image_create(width, height, &(Error){0});
        given->rows[i] = malloc(4 * (size_t)width);
    }
    return true;
}

static uint8_t *place_given(void *context, int side, int y) {
    (void)y;
    return ((Given *)context)->rows[side];
}

static void take_given(void *context, int y, const uint8_t *a, const uint8_t *b) {
    Given *given = context;
    const size_t bytes = 4 * (size_t)given->images[0]->width;
    assert_true(y > given->last);
    assert_true(a == given->rows[0] && (b == a || b == given->rows[1]));
    given->last = y;
    given->equal += a == b;
    memcpy(given->images[0]->pixels + (size_t)y * bytes, a, bytes);
    memcpy(given->images[1]->pixels + (size_t)y * bytes, b, bytes);
}

static bool is_near_difference(const Image *a, const Image *b, int y, int around) {
    bool near = around == ROWS_ALL;
    const size_t bytes = 4 * (size_t)a->width;
    for (int i = 0; !near && i < a->height; i++)
        near = abs(i - y) <= around && memcmp(a->pixels + bytes * (size_t)i, b->pixels + bytes * (size_t)i, bytes) != 0;
    return near;
}

/* Whether both files are read, in bands of any height: then as by libpng. */
static bool check_bands(const PngParts *a, const PngParts *b, bool threads) {
    Given given = {.last = -1};
    const int around = draw(2) == 0 ? ROWS_ALL : (int)draw(5);
    const RowSink sink = {begin_given, place_given, take_given, &given, around};
    const bool ok = png_fast_scan((const uint8_t *const[]){a->data, b->data}, (const size_t[]){a->size, b->size}, 2,
                                  1 << 20, 1 + draw(1200), threads, &sink);
    Image *wanted[2] = {NULL, NULL};
    if (ok) wanted[0] = accepted_by_libpng(a), wanted[1] = accepted_by_libpng(b);
    for (int y = 0; wanted[0] != NULL && wanted[1] != NULL && y < wanted[0]->height; y++) {
        const size_t bytes = 4 * (size_t)wanted[0]->width, at = (size_t)y * bytes;
        if (!is_near_difference(wanted[0], wanted[1], y, around)) continue;
        for (int i = 0; i < 2; i++) assert_memory_equal(given.images[i]->pixels + at, wanted[i]->pixels + at, bytes);
    }
    assert_true(!ok || around < ROWS_ALL || given.last == given.images[0]->height - 1);
    for (int i = 0; i < 2; i++) {
        image_destroy(given.images[i]);
        free(given.rows[i]);
        image_destroy(wanted[i]);
    }
    return ok;
}

/* A picture, and one that differs from it in some bytes, is compressed otherwise or is of another kind. */
static void make_pair(int i) {
    const uint32_t start = seed;
    const Kind *kind = &kinds[i % SHALLOW];
    make_file(&good, kind, true);
    seed = start;
    changes.bytes = i % 7 < 3 ? 0 : i % 7 - 3, changes.otherwise = i % 7 == 2;
    make_file(&bad, i % 5 == 0 ? &kinds[i / 5 % SHALLOW] : kind, true);
    changes.bytes = 0, changes.otherwise = false;
}

TEST(bands_of_any_height_give_the_rows_of_whole_pictures) {
    for (int i = 0; i < 6000; i++) {
        make_pair(i);
        assert_true(check_bands(&good, &bad, i % 3 == 0));
    }
}

/* Damage is found though the rows before it are given, and though both files have it. */
TEST(bands_of_damaged_files_are_read_only_if_libpng_does) {
    int accepted = 0;
    for (int i = 0; i < 20000; i++) {
        if (i % 4 == 0) make_file(&good, &kinds[draw(SHALLOW)], i % 8 == 0);
        damage();
        accepted += i % 2 == 0 ? check_bands(&good, &bad, i % 16 == 0) : check_bands(&bad, &bad, i % 16 == 1);
    }
    assert_true(accepted > 500 && accepted < 10000);
}

/* Pixels behind IEND do not belong to the picture. The last bits of a small stream may give many rows. */
TEST(pixels_end_before_the_end) {
    static uint8_t rows[32 * 129], packed[ROOM / 2];
    for (int i = 0; i < 400; i++) {
        const size_t size = compress_rows(rows, sizeof rows, 15, packed), part = 2 + draw((uint32_t)size - 2);
        bad.size = 0;
        put_header(&bad, 32, 32, 8, 6);
        put_chunk(&bad, "IDAT", packed, part);
        put_chunk(&bad, "IEND", NULL, 0);
        put_chunk(&bad, "IDAT", packed + part, size - part);
        put_chunk(&bad, "IEND", NULL, 0);
        assert_false(check_file(&bad));
        assert_false(check_bands(&bad, &bad, i % 2 == 0));
        rows[129 * draw(32) + 1 + draw(128)] = (uint8_t)draw(256);
    }
}

/* The check finds what reading would, in files of every kind, interlaced ones included. */
TEST(checks_and_reading_agree) {
    for (int i = 0; i < 4000; i++) {
        Error read = {0}, check = {0};
        if (i % 4 == 0) make_file(&good, &kinds[i / 4 % KINDS], i % 8 == 0);
        if (i % 16 == 0) good.data[28] = 1, make_checksum(good.data + 8);
        damage();
        const PngParts *file = i % 4 == 0 ? &good : &bad;
        OWN(Image) *image = image_decode_png(file->data, file->size, "file", 1 << 20, &read);
        assert_int_equal(is_sound(file, 1 << 20, &check), image != NULL);
        assert_int_equal(read.kind, check.kind); /* of two damages, they may tell different ones */
    }
}

RUN_TESTS(NULL, NULL)
