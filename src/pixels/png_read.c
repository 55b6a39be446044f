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

static bool read_header(const PngChunk *chunk, Header *header) {
    /* Table 11.1 of the specification. */
    static const int depths[] = {[PNG_GREY] = 1 | 2 | 4 | 8 | 16,
                                 [PNG_RGB] = 8 | 16,
                                 [PNG_PALETTE] = 1 | 2 | 4 | 8,
                                 [PNG_GREY_ALPHA] = 8 | 16,
                                 [PNG_RGB_ALPHA] = 8 | 16};
    const uint8_t *data = chunk->data;
    if (!png_chunk_is(chunk, "IHDR") || chunk->length != 13) return false;
    *header = (Header){png_number(data), png_number(data + 4), data[8], data[9], data[12]};
    const int depth = header->depth;
    return header->width > 0 && header->width <= INT_MAX && header->height > 0 && header->height <= INT_MAX &&
           header->color <= PNG_RGB_ALPHA && depth > 0 && (depth & (depth - 1)) == 0 &&
           (depths[header->color] & depth) != 0 && data[10] == 0 && data[11] == 0 && header->interlace <= 1;
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

/* Bytes of all filtered rows. */
static double filtered_size(const Header *header) {
    /* Every dx-th pixel from x on, and every dy-th row from y on: Adam7, section 8.2; and one pass of all. */
    static const int passes[8][4] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                     {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}, {0, 0, 1, 1}};
    double size = 0;
    for (int i = header->interlace == 0 ? 7 : 0; i < (header->interlace == 0 ? 8 : 7); i++) {
        const uint64_t x = (uint64_t)passes[i][0], y = (uint64_t)passes[i][1], dx = (uint64_t)passes[i][2],
                       dy = (uint64_t)passes[i][3];
        const uint64_t width = (header->width + dx - 1 - x) / dx, height = (header->height + dy - 1 - y) / dy;
        const uint64_t row = (width * (uint64_t)(png_channels[header->color] * header->depth) + 7) / 8;
        if (width > 0) size += (double)height * (double)(row + 1);
    }
    return size;
}

static bool refuse(Error *error, const char *path, const char *what) {
    return error_input(error, path, "not a PNG file, or damaged: %s", what);
}

bool png_check(const uint8_t *data, size_t size, const char *path, int *width, int *height, Error *error) {
    Header header = {0};
    PngChunk chunk;
    bool palette = false, pixels = false, pixels_ended = false, ended = false;
    uint8_t zlib[2] = {0}; /* the first bytes of the compressed pixels */
    uint64_t compressed = 0;
    if (!png_check_start(data, size, path, error)) return false;
    for (size_t at = PNG_SIGNATURE, next = at; !ended && png_chunk_next(data, size, &next, &chunk); at = next) {
        if (!png_chunk_has_name(&chunk))
            return error_input(error, path, "not a PNG file, or damaged: no valid chunk at byte %zu", at);
        if (!png_chunk_is_sound(&chunk))
            return error_input(error, path, "not a PNG file, or damaged: wrong checksum of the chunk %.4s at byte %zu",
                               (const char *)chunk.type, at);
        if (at == PNG_SIGNATURE) {
            if (!read_header(&chunk, &header)) return refuse(error, path, "the header is invalid");
            continue;
        }
        if (png_chunk_is(&chunk, "IDAT")) {
            if (pixels_ended) return refuse(error, path, "the IDAT chunks are not consecutive");
            if (header.color == PNG_PALETTE && !palette) return refuse(error, path, "the palette is missing");
            for (size_t i = 0; i < chunk.length && compressed + i < 2; i++) zlib[compressed + i] = chunk.data[i];
            compressed += chunk.length;
            pixels = true;
            continue;
        }
        pixels_ended = pixels;
        ended = png_chunk_is(&chunk, "IEND");
        if (png_chunk_is(&chunk, "acTL") && !pixels)
            return error_input(error, path,
                               "an animated PNG (chunk acTL at byte %zu); split it into one file per frame", at);
        if (png_chunk_is(&chunk, "PLTE")) {
            palette = chunk.length > 0 && chunk.length <= 768 && chunk.length % 3 == 0;
            if (!palette) return refuse(error, path, "the palette is invalid");
        } else if (!ended && (chunk.type[0] & 0x20) == 0)
            return refuse(error, path, "an unknown critical chunk");
    }
    *width = (int)header.width;
    *height = (int)header.height;
    if (!ended) return refuse(error, path, "unexpected end of file");
    if (!pixels) return refuse(error, path, "it has no pixels (chunk IDAT)");
    /* RFC 1950. */
    if (compressed < 2 || (zlib[0] & 0x0F) != 8 || zlib[0] >> 4 > 7 || (zlib[0] << 8 | zlib[1]) % 31 != 0 ||
        (zlib[1] & 0x20) != 0)
        return refuse(error, path, "the pixels are not a zlib stream");
    return png_can_hold(compressed, filtered_size(&header)) || refuse(error, path, "too few bytes for its pixels");
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
    if (decoder->png != NULL) {
        png_set_check_for_invalid_index(decoder->png, 0); /* check_palette() has the same words for every version */
        decoder->info = png_create_info_struct(decoder->png);
    }
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

static bool is_palette(const Decoder *decoder) {
    return png_get_color_type(decoder->png, decoder->info) == PNG_COLOR_TYPE_PALETTE;
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

static void check_palette(const Decoder *decoder, const uint8_t *row) {
    png_colorp palette = NULL;
    int colors = 0;
    png_get_PLTE(decoder->png, decoder->info, &palette, &colors);
    for (png_uint_32 x = 0; x < png_get_image_width(decoder->png, decoder->info); x++)
        if (row[x] >= colors) png_error(decoder->png, "a colour that is not in the palette");
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

/* The compressed pixels again, as libpng does not look at a checksum that is split over two chunks: one sound zlib
   stream. What follows it is padding. */
static bool check_stream(const Decoder *decoder) {
    uint8_t scratch[1 << 14];
    z_stream z = {0};
    Header header = {0};
    PngChunk chunk;
    size_t at = PNG_SIGNATURE;
    (void)(png_chunk_next(decoder->data, decoder->size, &at, &chunk) && read_header(&chunk, &header)); /* it has */
    if (inflateInit(&z) != Z_OK) return error_memory(decoder->error, decoder->path);
    const double size = filtered_size(&header);
    int status = Z_OK;
    bool ok = true;
    while (ok && status != Z_STREAM_END && png_chunk_next(decoder->data, decoder->size, &at, &chunk)) {
        if (!png_chunk_is(&chunk, "IDAT")) continue;
        z.next_in = (uint8_t *)chunk.data; /* not changed */
        z.avail_in = (uInt)chunk.length;
        while (ok && status != Z_STREAM_END && z.avail_in > 0) {
            z.next_out = scratch, z.avail_out = sizeof scratch;
            status = inflate(&z, Z_NO_FLUSH);
            if (status == Z_MEM_ERROR)
                ok = error_memory(decoder->error, decoder->path);
            else if ((status != Z_STREAM_END && status != Z_OK && status != Z_BUF_ERROR) || (double)z.total_out > size)
                ok = error_input(decoder->error, decoder->path, "not a PNG file, or damaged: IDAT: %s",
                                 z.msg != NULL ? z.msg : "more pixels than the header states");
        }
    }
    if (ok && (status != Z_STREAM_END || (double)z.total_out != size))
        ok = error_input(decoder->error, decoder->path,
                         "not a PNG file, or damaged: IDAT: the compressed pixels do not end");
    inflateEnd(&z);
    return ok;
}

static bool decode_all(Decoder *decoder) {
    if (setjmp(png_jmpbuf(decoder->png)) != 0) return false;
    png_structp png = decoder->png;
    set_strict_limits(decoder);
    /* Only the chunks needed for pixels; others are not even held, and may have any size. */
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
    png_set_chunk_malloc_max(png, 0);
    png_read_info(png, decoder->info);
    if (is_palette(decoder)) /* libpng gives indices, as it would take one beyond the palette for black */
        png_set_packing(png);
    else {
        png_set_expand(png);
        png_set_gray_to_rgb(png);
        png_set_add_alpha(png, 0xffff, PNG_FILLER_AFTER);
    }
    const int passes = png_set_interlace_handling(png);
    png_read_update_info(png, decoder->info);
    png_set_benign_errors(png, 1); /* padding behind the pixels; check_stream() sees the others */
    const int width = (int)png_get_image_width(png, decoder->info),
              height = (int)png_get_image_height(png, decoder->info);
    const bool deep = png_get_bit_depth(png, decoder->info) == 16;
    const size_t samples = (size_t)width * 4;
    if (!decoder->checked && (decoder->image = image_create(width, height, decoder->error)) == NULL) return false;
    if (deep && !decoder->checked) decoder->image->pixels16 = calloc(samples * (size_t)height, sizeof(uint16_t));
    if (deep || decoder->checked) decoder->row = calloc(samples, 2);
    if ((deep && !decoder->checked && decoder->image->pixels16 == NULL) ||
        ((deep || decoder->checked) && decoder->row == NULL))
        return error_memory(decoder->error, decoder->path);
    for (int pass = 0; pass < passes; pass++)
        for (int y = 0; y < height; y++) {
            if (!decoder->checked && deep)
                read_row16(decoder, (size_t)y * samples);
            else
                png_read_row(png, decoder->checked ? decoder->row : decoder->image->pixels + (size_t)y * samples, NULL);
            if (decoder->checked && is_palette(decoder)) check_palette(decoder, decoder->row);
        }
    png_set_benign_errors(png, 0);
    png_read_end(png, NULL);
    if (is_palette(decoder) && !decoder->checked) expand_palette(decoder);
    return check_stream(decoder);
}

/* checked: the pixels are not kept, and there is no image. The chunks are judged by png_check() alone: libpng skips
   some that are damage, and reads only the first picture of an animation. */
static bool decode(const uint8_t *data, size_t size, const char *path, int64_t max_pixels, bool checked, Image **image,
                   Error *error) {
    Decoder decoder;
    int width, height;
    *image = NULL;
    if (png_size(data, size, &width, &height) && !png_check_pixels(width, height, max_pixels, path, error))
        return false;
    if (!png_check(data, size, path, &width, &height, error)) return false;
    bool ok = open_decoder(&decoder, data, size, path, error);
    decoder.checked = checked;
    ok = ok && decode_all(&decoder);
    close_decoder(&decoder);
    if (!ok) image_destroy(decoder.image);
    *image = ok ? decoder.image : NULL;
    return ok;
}

Image *png_libpng_decode(const uint8_t *data, size_t size, const char *path, int64_t max_pixels, Error *error) {
    Image *image;
    return decode(data, size, path, max_pixels, false, &image, error) ? image : NULL;
}

bool png_file_check(PngFile *file, Error *error) {
    if (file->rows != NULL && !file->damaged && png_fast_check_rows(file->rows)) return true;
    Image *none;
    return png_file_load(file, error) &&
           decode(file->data, file->size, file->path, file->max_pixels, true, &none, error);
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

static bool decode_texts(Decoder *decoder, char *value, size_t size) {
    if (setjmp(png_jmpbuf(decoder->png)) != 0) return false;
    set_strict_limits(decoder);
    png_set_chunk_malloc_max(decoder->png, MAX_TEXT_SIZE);
    png_read_info(decoder->png, decoder->info);
    if (decoder->memory_short) return error_memory(decoder->error, decoder->path);
    png_textp texts = NULL;
    if (png_get_text(decoder->png, decoder->info, &texts, NULL) > 0 && strlen(texts[0].text) < size)
        strcpy(value, texts[0].text);
    return true;
}

/* A file that has only the first text with this key before the pixels, which are an empty chunk: to libpng, any chunk
   above its limit of texts is damage, and so is a damaged text with another key. NULL if out of memory. */
static uint8_t *with_text_alone(const uint8_t *data, size_t size, const char *key, size_t *kept) {
    const size_t length = strlen(key) + 1;
    uint8_t *copy = malloc(size + sizeof png_no_pixels);
    PngChunk chunk;
    bool found = false, ended = false;
    size_t at = *kept = size < PNG_SIGNATURE ? size : PNG_SIGNATURE;
    if (copy == NULL) return NULL;
    memcpy(copy, data, *kept);
    for (size_t from = at; !ended && png_chunk_next(data, size, &at, &chunk); from = at) {
        const bool text =
            !found && chunk.length >= length && chunk.length <= MAX_TEXT_SIZE &&
            (png_chunk_is(&chunk, "tEXt") || png_chunk_is(&chunk, "zTXt") || png_chunk_is(&chunk, "iTXt")) &&
            memcmp(chunk.data, key, length) == 0;
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
    if (open_decoder(&decoder, alone, kept, "image", &failure)) (void)decode_texts(&decoder, value, value_size);
    close_decoder(&decoder);
    free(alone);
    if (failure.kind == ERROR_SYSTEM) *error = failure;
    return failure.kind != ERROR_SYSTEM;
}
