/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks PNG files, and reads them, from untrusted sources: damaged, truncated, or crafted to exhaust memory. */
#include "base/base.h"
#include "base/file.h"
#include "pixels/pixels_internal.h"
#include "pixels/png.h"

#include <libdeflate.h>
#include <limits.h>
#include <png.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

bool png_check_start(const uint8_t *data, size_t size, const char *path, Error *error) {
    if (size == 0) return error_input(error, path, "not a PNG file, or damaged: it is empty");
    if (!lfs_pointer_refuse(data, size, path, error)) return false;
    return png_has_signature(data, size) ||
           error_input(error, path, "not a PNG file, or damaged: it does not begin as one");
}

typedef struct Header {
    uint32_t width, height;
    int depth, color, interlace;
} Header;

/* Table 11.1 of the specification. */
static bool depth_fits(int color, int depth) {
    static const int depths[] = {[PNG_GREY] = 1 | 2 | 4 | 8 | 16,
                                 [PNG_RGB] = 8 | 16,
                                 [PNG_PALETTE] = 1 | 2 | 4 | 8,
                                 [PNG_GREY_ALPHA] = 8 | 16,
                                 [PNG_RGB_ALPHA] = 8 | 16};
    bool power = depth > 0 && (depth & (depth - 1)) == 0;
    return color <= PNG_RGB_ALPHA && power && (depths[color] & depth) != 0;
}

static bool read_header(const PngChunk *chunk, Header *header) {
    const uint8_t *data = chunk->data;
    if (!png_chunk_is(chunk, "IHDR") || chunk->length != 13) return false;
    *header = (Header){png_number(data), png_number(data + 4), data[8], data[9], data[12]};
    return header->width > 0 && header->width <= INT_MAX && header->height > 0 && header->height <= INT_MAX &&
           depth_fits(header->color, header->depth) && data[10] == 0 && data[11] == 0 && header->interlace <= 1;
}

bool png_size(const uint8_t *data, size_t size, int *width, int *height) {
    Header header;
    PngChunk chunk;
    size_t at = PNG_SIGNATURE;
    if (size < PNG_SIGNATURE || !png_chunk_next(data, size, &at, &chunk) || !read_header(&chunk, &header)) return false;
    *width = (int)header.width;
    *height = (int)header.height;
    return true;
}

bool png_check_pixels(int width, int height, int64_t max_pixels, const char *path, Error *error) {
    return (int64_t)width * height <= max_pixels ||
           error_input(error, path, "the picture has %d x %d pixels; at most %lld pixels can be read", width, height,
                       (long long)max_pixels);
}

/* Bytes of the filtered rows of one pass with every dx-th pixel from x on, and every dy-th row from y on. */
static double pass_size(const Header *header, int x, int y, int dx, int dy) {
    uint64_t width = ((uint64_t)header->width + (uint64_t)(dx - 1 - x)) / (uint64_t)dx;
    uint64_t height = ((uint64_t)header->height + (uint64_t)(dy - 1 - y)) / (uint64_t)dy;
    uint64_t row = (width * (uint64_t)(png_channels[header->color] * header->depth) + 7) / 8;
    return width == 0 ? 0 : (double)height * (double)(row + 1);
}

static double filtered_size(const Header *header) {
    static const int passes[7][4] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                     {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}}; /* Adam7: section 8.2 */
    if (header->interlace == 0) return pass_size(header, 0, 0, 1, 1);
    double size = 0;
    for (int i = 0; i < 7; i++) size += pass_size(header, passes[i][0], passes[i][1], passes[i][2], passes[i][3]);
    return size;
}

/* What has been seen of a file. */
typedef struct State {
    const char *path;
    Header header;
    bool palette, pixels, pixels_ended, ended;
    uint8_t zlib[2]; /* first bytes of the compressed pixels */
    uint64_t compressed;
    Error *error;
} State;

static bool png_read_refuse(const State *state, const char *what) {
    return error_input(state->error, state->path, "not a PNG file, or damaged: %s", what);
}

static bool check_pixels(State *state, const PngChunk *chunk) {
    if (state->pixels_ended) return png_read_refuse(state, "the IDAT chunks are not consecutive");
    if (state->header.color == PNG_PALETTE && !state->palette) return png_read_refuse(state, "the palette is missing");
    for (size_t i = 0; i < chunk->length && state->compressed + i < 2; i++)
        state->zlib[state->compressed + i] = chunk->data[i];
    state->compressed += chunk->length;
    state->pixels = true;
    return true;
}

static bool check_chunk(State *state, const PngChunk *chunk, size_t at) {
    bool critical = (chunk->type[0] & 0x20) == 0;
    if (state->pixels && !png_chunk_is(chunk, "IDAT")) state->pixels_ended = true;
    if (png_chunk_is(chunk, "IDAT")) return check_pixels(state, chunk);
    if (png_chunk_is(chunk, "acTL") && !state->pixels)
        return error_input(state->error, state->path,
                           "an animated PNG (chunk acTL at byte %zu); split it into one file per frame", at);
    if (png_chunk_is(chunk, "PLTE")) {
        state->palette = chunk->length > 0 && chunk->length <= 768 && chunk->length % 3 == 0;
        return state->palette || png_read_refuse(state, "the palette is invalid");
    }
    state->ended = png_chunk_is(chunk, "IEND");
    return state->ended || !critical || png_read_refuse(state, "an unknown critical chunk");
}

static bool check_checksum(const State *state, const PngChunk *chunk, size_t at) {
    if (!png_chunk_has_name(chunk))
        return error_input(state->error, state->path, "not a PNG file, or damaged: no valid chunk at byte %zu", at);
    return png_chunk_is_sound(chunk) ||
           error_input(state->error, state->path,
                       "not a PNG file, or damaged: wrong checksum of the chunk %.4s at byte %zu",
                       (const char *)chunk->type, at);
}

/* RFC 1950. */
static bool check_compressed(const State *state) {
    const uint8_t *zlib = state->zlib;
    if (!state->pixels) return png_read_refuse(state, "it has no pixels (chunk IDAT)");
    if (state->compressed < 2 || (zlib[0] & 0x0F) != 8 || zlib[0] >> 4 > 7 || (zlib[0] << 8 | zlib[1]) % 31 != 0 ||
        (zlib[1] & 0x20) != 0)
        return png_read_refuse(state, "the pixels are not a zlib stream");
    return png_can_hold(state->compressed, filtered_size(&state->header)) ||
           png_read_refuse(state, "too few bytes for its pixels");
}

bool png_check(const uint8_t *data, size_t size, const char *path, int *width, int *height, Error *error) {
    State state = {.path = path, .error = error};
    PngChunk chunk;
    if (!png_check_start(data, size, path, error)) return false;
    size_t at = PNG_SIGNATURE, first = at, next = at;
    while (!state.ended && png_chunk_next(data, size, &next, &chunk)) {
        if (!check_checksum(&state, &chunk, at)) return false;
        bool ok = at > first ? check_chunk(&state, &chunk, at)
                             : read_header(&chunk, &state.header) || png_read_refuse(&state, "the header is invalid");
        if (!ok) return false;
        at = next;
    }
    *width = (int)state.header.width;
    *height = (int)state.header.height;
    return (state.ended || png_read_refuse(&state, "unexpected end of file")) && check_compressed(&state);
}

/* Reading by libpng. */

png_voidp png_memory_take(png_structp png, png_alloc_size_t size) {
    void *block = malloc(size);
    if (block == NULL) *(bool *)png_get_mem_ptr(png) = true;
    return block;
}

void png_memory_release(png_structp png, png_voidp block) {
    (void)png;
    free(block);
}

enum { MAX_TEXT_SIZE = 1 << 16 };

/* Everything that decoding modifies is in this struct, as longjmp would clobber locals. */
typedef struct Decoder {
    png_structp png;
    png_infop info;
    const char *path;
    const uint8_t *data;
    size_t size, position;
    int64_t max_pixels;
    Image *image;
    uint8_t *row;      /* 16-bit samples; any row of pixels that are not kept */
    bool checked;      /* the pixels are not kept */
    bool memory_short; /* png_memory_take() */
    Error *error;
} Decoder;

static void read_bytes(png_structp png, png_bytep data, size_t size) {
    Decoder *decoder = png_get_io_ptr(png);
    if (size > decoder->size - decoder->position) png_error(png, "unexpected end of file");
    memcpy(data, decoder->data + decoder->position, size);
    decoder->position += size;
}

static PNG_FUNCTION(void, fail, (png_structp png, png_const_charp message), PNG_NORETURN) {
    Decoder *decoder = png_get_error_ptr(png);
    if (decoder->memory_short)
        error_memory(decoder->error, decoder->path);
    else
        error_input(decoder->error, decoder->path, "not a PNG file, or damaged: %s", message);
    png_longjmp(png, 1);
}

static void ignore_warning(png_structp png, png_const_charp message) { (void)png, (void)message; }

static bool open_decoder(Decoder *decoder, const uint8_t *data, size_t size, const char *path, Error *error) {
    *decoder = (Decoder){.path = path, .error = error, .data = data, .size = size};
    decoder->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, decoder, fail, ignore_warning,
                                            &decoder->memory_short, png_memory_take, png_memory_release);
    if (decoder->png != NULL) decoder->info = png_create_info_struct(decoder->png);
    return decoder->info != NULL || error_memory(error, path);
}

static void close_decoder(Decoder *decoder) {
    png_destroy_read_struct(&decoder->png, &decoder->info, NULL);
    free(decoder->row);
}

uint8_t *image_load_png(const char *path, size_t *size, Error *error) {
    uint8_t *data = (uint8_t *)file_read(path, PNG_MAX_FILE_SIZE, size, error);
    if (data != NULL && png_check_start(data, *size, path, error)) return data;
    free(data);
    return NULL;
}

/* Every irregularity is an error: a partly guessed frame must not count as a frame. */
static void set_strict_limits(Decoder *decoder) {
    png_set_read_fn(decoder->png, decoder, read_bytes);
    png_set_crc_action(decoder->png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_benign_errors(decoder->png, 0);
    png_set_user_limits(decoder->png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
}

static void check_size(Decoder *decoder) {
    const int width = (int)png_get_image_width(decoder->png, decoder->info),
              height = (int)png_get_image_height(decoder->png, decoder->info);
    if (!png_check_pixels(width, height, decoder->max_pixels, decoder->path, decoder->error))
        png_longjmp(decoder->png, 1);
}

/* Before memory is allocated for pixels that the file cannot hold: deflate shrinks to no less than 1 / 1032. */
static void check_amount(Decoder *decoder) {
    const double rows = (double)png_get_rowbytes(decoder->png, decoder->info) *
                        (double)png_get_image_height(decoder->png, decoder->info);
    if (rows > 1032.0 * (double)decoder->size) png_error(decoder->png, "too few bytes for its pixels");
}

/* libpng would read only the first picture of an animation and miss differences in the others. Chunk lengths are
   valid here, as libpng has checked everything up to the pixels. */
static void refuse_animation(Decoder *decoder) {
    for (size_t at = 8; at + 12 <= decoder->position;) {
        const uint8_t *chunk = decoder->data + at;
        size_t length = (size_t)chunk[0] << 24 | (size_t)chunk[1] << 16 | (size_t)chunk[2] << 8 | chunk[3];
        if (memcmp(chunk + 4, "acTL", 4) == 0) {
            error_input(decoder->error, decoder->path,
                        "an animated PNG (chunk acTL at byte %zu); split it into one file per frame", at);
            png_longjmp(decoder->png, 1);
        }
        at += length + 12;
    }
}

static bool is_palette(const Decoder *decoder) {
    return png_get_color_type(decoder->png, decoder->info) == PNG_COLOR_TYPE_PALETTE;
}

/* Of a palette, libpng gives indices, as it would take one beyond the palette for black. */
static void request_rgba(Decoder *decoder) {
    if (is_palette(decoder)) {
        png_set_packing(decoder->png);
        return;
    }
    png_set_expand(decoder->png);
    png_set_gray_to_rgb(decoder->png);
    png_set_add_alpha(decoder->png, 0xffff, PNG_FILLER_AFTER);
}

static bool allocate_pixels16(Decoder *decoder) {
    size_t width = (size_t)decoder->image->width;
    decoder->image->pixels16 = calloc(width * (size_t)decoder->image->height * 4, sizeof(uint16_t));
    decoder->row = malloc(width * 8);
    return (decoder->image->pixels16 != NULL && decoder->row != NULL) || error_memory(decoder->error, decoder->path);
}

/* A pass of an interlaced file sets only some pixels; libpng needs the others from earlier passes. */
static void read_row16(Decoder *decoder, size_t first) {
    size_t samples = (size_t)decoder->image->width * 4;
    uint16_t *pixels16 = decoder->image->pixels16 + first;
    uint8_t *pixels = decoder->image->pixels + first, *row = decoder->row;
    for (size_t i = 0; i < samples; i++)
        row[2 * i] = (uint8_t)(pixels16[i] >> 8), row[2 * i + 1] = (uint8_t)pixels16[i];
    png_read_row(decoder->png, row, NULL);
    for (size_t i = 0; i < samples; i++) {
        pixels16[i] = (uint16_t)(row[2 * i] << 8 | row[2 * i + 1]);
        pixels[i] = (uint8_t)((pixels16[i] * 255u + 32895) >> 16); /* rounded to nearest */
    }
}

static void read_rows(Decoder *decoder) {
    const Image *image = decoder->image;
    size_t samples = (size_t)image->width * 4;
    for (int y = 0; y < image->height; y++) {
        size_t first = (size_t)y * samples;
        if (image->pixels16 != NULL)
            read_row16(decoder, first);
        else
            png_read_row(decoder->png, image->pixels + first, NULL);
    }
}

static void check_palette(const Decoder *decoder, const uint8_t *row) {
    png_colorp palette = NULL;
    int colors = 0;
    png_get_PLTE(decoder->png, decoder->info, &palette, &colors);
    for (png_uint_32 x = 0; x < png_get_image_width(decoder->png, decoder->info); x++)
        if (row[x] >= colors) png_error(decoder->png, "a colour that is not in the palette");
}

static void check_rows(Decoder *decoder) {
    for (png_uint_32 y = 0; y < png_get_image_height(decoder->png, decoder->info); y++) {
        png_read_row(decoder->png, decoder->row, NULL);
        if (is_palette(decoder)) check_palette(decoder, decoder->row);
    }
}

/* In place, from the last pixel of a row: indices are where its first pixels will be. */
static void expand_palette(Decoder *decoder) {
    const Image *image = decoder->image;
    png_colorp palette = NULL;
    png_bytep alpha = NULL;
    int colors = 0, alphas = 0;
    png_get_PLTE(decoder->png, decoder->info, &palette, &colors);
    png_get_tRNS(decoder->png, decoder->info, &alpha, &alphas, NULL);
    for (int y = 0; y < image->height; y++) {
        uint8_t *row = image->pixels + (size_t)y * (size_t)image->width * 4;
        check_palette(decoder, row);
        for (int x = image->width - 1; x >= 0; x--) {
            const int index = row[x];
            row[4 * x] = palette[index].red, row[4 * x + 1] = palette[index].green;
            row[4 * x + 2] = palette[index].blue, row[4 * x + 3] = index < alphas ? alpha[index] : 255;
        }
    }
}

/* The bytes that the next chunk of pixels gives. False with error set unless they go on, or end, one sound zlib
   stream. */
static bool inflate_chunk(const Decoder *decoder, z_stream *z, double most, bool *ended) {
    uint8_t scratch[1 << 14];
    while (!*ended && z->avail_in > 0) {
        z->next_out = scratch, z->avail_out = sizeof scratch;
        const int status = inflate(z, Z_NO_FLUSH);
        *ended = status == Z_STREAM_END;
        if (status == Z_MEM_ERROR) return error_memory(decoder->error, decoder->path);
        if ((!*ended && status != Z_OK && status != Z_BUF_ERROR) || (double)z->total_out > most)
            return error_input(decoder->error, decoder->path, "not a PNG file, or damaged: IDAT: %s",
                               z->msg != NULL ? z->msg : "more pixels than the header states");
    }
    return true;
}

/* The compressed pixels again, as libpng does not look at a checksum that is split over two chunks. What follows them
   is padding. */
static bool check_stream(const Decoder *decoder) {
    z_stream z = {0};
    Header header;
    PngChunk chunk;
    size_t at = PNG_SIGNATURE;
    bool ended = false, ok = png_chunk_next(decoder->data, decoder->size, &at, &chunk) && read_header(&chunk, &header);
    const double size = ok ? filtered_size(&header) : 0;
    if (!ok || inflateInit(&z) != Z_OK) return error_memory(decoder->error, decoder->path);
    while (ok && !ended && png_chunk_next(decoder->data, decoder->size, &at, &chunk)) {
        if (!png_chunk_is(&chunk, "IDAT")) continue;
        z.next_in = (uint8_t *)chunk.data; /* not changed */
        z.avail_in = (uInt)chunk.length;
        ok = inflate_chunk(decoder, &z, size, &ended);
    }
    if (ok && (!ended || (double)z.total_out != size))
        ok = error_input(decoder->error, decoder->path,
                         "not a PNG file, or damaged: IDAT: the compressed pixels do not end");
    inflateEnd(&z);
    return ok;
}

static void end_pixels(const Decoder *decoder) {
    png_set_benign_errors(decoder->png, 0);
    png_read_end(decoder->png, NULL);
}

static bool png_read_decode(Decoder *decoder) {
    if (setjmp(png_jmpbuf(decoder->png)) != 0) return false;
    png_structp png = decoder->png;
    set_strict_limits(decoder);
    /* Only the chunks needed for pixels; others are not even held, and may have any size. */
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
    png_set_chunk_malloc_max(png, 0);
    png_read_info(png, decoder->info);
    check_size(decoder);
    refuse_animation(decoder);
    check_amount(decoder);
    request_rgba(decoder);
    int passes = png_set_interlace_handling(png);
    png_read_update_info(png, decoder->info);
    png_set_benign_errors(png, 1); /* padding behind the pixels; check_stream() sees the others */
    if (decoder->checked) {
        decoder->row = calloc(png_get_image_width(png, decoder->info), 8);
        if (decoder->row == NULL) return error_memory(decoder->error, decoder->path);
        for (int pass = 0; pass < passes; pass++) check_rows(decoder);
        end_pixels(decoder);
        return check_stream(decoder);
    }
    decoder->image = image_create((int)png_get_image_width(png, decoder->info),
                                  (int)png_get_image_height(png, decoder->info), decoder->error);
    if (decoder->image == NULL) return false;
    if (png_get_bit_depth(png, decoder->info) == 16 && !allocate_pixels16(decoder)) return false;
    for (int pass = 0; pass < passes; pass++) read_rows(decoder);
    end_pixels(decoder);
    if (is_palette(decoder)) expand_palette(decoder);
    return check_stream(decoder);
}

Image *png_libpng_decode(const uint8_t *data, size_t size, const char *path, int64_t max_pixels, Error *error) {
    Decoder decoder;
    bool ok = open_decoder(&decoder, data, size, path, error);
    decoder.max_pixels = max_pixels;
    ok = ok && png_read_decode(&decoder);
    close_decoder(&decoder);
    if (ok) return decoder.image;
    image_destroy(decoder.image);
    return NULL;
}

static bool check_by_libpng(const uint8_t *data, size_t size, const char *path, int64_t max_pixels, Error *error) {
    Decoder decoder;
    bool ok = open_decoder(&decoder, data, size, path, error);
    decoder.max_pixels = max_pixels;
    decoder.checked = true;
    ok = ok && png_read_decode(&decoder);
    close_decoder(&decoder);
    return ok;
}

bool png_file_check(PngFile *file, Error *error) {
    if (file->rows != NULL && !file->damaged && png_fast_check_rows(file->rows)) return true;
    return png_file_load(file, error) && check_by_libpng(file->data, file->size, file->path, file->max_pixels, error);
}

Image *image_decode_png(const uint8_t *data, size_t size, const char *path, int64_t max_pixels, Error *error) {
    Image *image;
    if (png_fast_decode(data, size, max_pixels, &image)) return image;
    return png_libpng_decode(data, size, path, max_pixels, error);
}

bool png_files_scan(PngFile files[2], bool threads, const RowSink *sink) {
    PngRows *const rows[] = {files[0].rows, files[1].rows};
    if (rows[0] == NULL || rows[1] == NULL) return false;
    const bool ok = png_fast_scan_rows(rows, 2, PNG_BAND, threads, sink);
    for (int i = 0; i < 2; i++) files[i].damaged = rows[i]->damaged;
    return ok;
}

bool image_decode_png_pair(const uint8_t *const data[2], const size_t sizes[2], const char *const paths[2],
                           int64_t max_pixels, Image *images[2], Error *error) {
    if (png_fast_decode_pair(data, sizes, max_pixels, images)) return true;
    for (int i = 0; i < 2; i++) {
        images[i] = image_decode_png(data[i], sizes[i], paths[i], max_pixels, error);
        if (images[i] == NULL) break;
    }
    if (images[1] != NULL) return true;
    image_destroy(images[0]);
    images[0] = NULL; /* so that image_destroy_pair() may follow */
    return false;
}

Image *image_read_png(const char *path, Error *error) {
    size_t size;
    uint8_t *data = image_load_png(path, &size, error);
    Image *image = data != NULL ? image_decode_png(data, size, path, IMAGE_MAX_PIXELS, error) : NULL;
    free(data);
    return image;
}

static bool decode_texts(Decoder *decoder) {
    if (setjmp(png_jmpbuf(decoder->png)) != 0) return false;
    set_strict_limits(decoder);
    png_set_chunk_malloc_max(decoder->png, MAX_TEXT_SIZE);
    png_read_info(decoder->png, decoder->info);
    return !decoder->memory_short || error_memory(decoder->error, decoder->path);
}

static void copy_text(const Decoder *decoder, char *value, size_t size) {
    png_textp texts = NULL;
    if (png_get_text(decoder->png, decoder->info, &texts, NULL) > 0 && strlen(texts[0].text) < size)
        strcpy(value, texts[0].text);
}

static bool has_key(const PngChunk *chunk, const char *key) {
    const size_t length = strlen(key) + 1;
    return (png_chunk_is(chunk, "tEXt") || png_chunk_is(chunk, "zTXt") || png_chunk_is(chunk, "iTXt")) &&
           chunk->length >= length && memcmp(chunk->data, key, length) == 0;
}

/* A file that has only the first text with this key before the pixels, which are an empty chunk: to libpng, any chunk
   above its limit of texts is damage, and so is a damaged text with another key. NULL if out of memory. */
static uint8_t *with_text_alone(const uint8_t *data, size_t size, const char *key, size_t *kept) {
    uint8_t *copy = malloc(size + sizeof png_no_pixels);
    PngChunk chunk;
    bool found = false, ended = false;
    size_t at = *kept = size < PNG_SIGNATURE ? size : PNG_SIGNATURE;
    if (copy == NULL) return NULL;
    memcpy(copy, data, *kept);
    for (size_t from = at; !ended && png_chunk_next(data, size, &at, &chunk); from = at) {
        const bool text = !found && chunk.length <= MAX_TEXT_SIZE && has_key(&chunk, key);
        ended = png_chunk_is(&chunk, "IDAT");
        found |= text;
        if (!text && (chunk.type[0] & 0x20) != 0) continue;
        memcpy(copy + *kept, ended ? png_no_pixels : data + from, ended ? sizeof png_no_pixels : at - from);
        *kept += ended ? sizeof png_no_pixels : at - from;
    }
    return copy;
}

bool image_find_text(const uint8_t *data, size_t size, const char *key, char *value, size_t value_size, Error *error) {
    Decoder decoder;
    Error failure = {0};
    size_t kept;
    uint8_t *alone = with_text_alone(data, size, key, &kept);
    value[0] = '\0';
    if (alone == NULL) return error_memory(error, "image");
    if (open_decoder(&decoder, alone, kept, "image", &failure) && decode_texts(&decoder))
        copy_text(&decoder, value, value_size);
    close_decoder(&decoder);
    free(alone);
    if (failure.kind == ERROR_SYSTEM) *error = failure;
    return failure.kind != ERROR_SYSTEM;
}
