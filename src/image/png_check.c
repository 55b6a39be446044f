/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/png_check.h"

#include "common/lfs_pointer.h"
#include "image/png_chunk.h"

#include <libdeflate.h>
#include <limits.h>

bool png_check_start(const uint8_t *data, size_t size, const char *path, Error *error) {
    static const uint8_t signature[PNG_SIGNATURE] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    if (size == 0) return error_input(error, path, "not a PNG file, or damaged: it is empty");
    if (!lfs_pointer_refuse(data, size, path, error)) return false;
    return (size >= PNG_SIGNATURE && memcmp(data, signature, PNG_SIGNATURE) == 0) ||
           error_input(error, path, "not a PNG file, or damaged: it does not begin as one");
}

typedef struct Header {
    uint32_t width, height;
    int depth, color, interlace;
} Header;

enum { GREY = 0, RGB = 2, PALETTE = 3, GREY_ALPHA = 4, RGB_ALPHA = 6 };

/* Table 11.1 of the specification. */
static bool depth_fits(int color, int depth) {
    static const int depths[] = {[GREY] = 1 | 2 | 4 | 8 | 16,
                                 [RGB] = 8 | 16,
                                 [PALETTE] = 1 | 2 | 4 | 8,
                                 [GREY_ALPHA] = 8 | 16,
                                 [RGB_ALPHA] = 8 | 16};
    bool power = depth > 0 && (depth & (depth - 1)) == 0;
    return color <= RGB_ALPHA && power && (depths[color] & depth) != 0;
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
    static const int channels[] = {[GREY] = 1, [RGB] = 3, [PALETTE] = 1, [GREY_ALPHA] = 2, [RGB_ALPHA] = 4};
    uint64_t width = ((uint64_t)header->width + (uint64_t)(dx - 1 - x)) / (uint64_t)dx;
    uint64_t height = ((uint64_t)header->height + (uint64_t)(dy - 1 - y)) / (uint64_t)dy;
    uint64_t row = (width * (uint64_t)(channels[header->color] * header->depth) + 7) / 8;
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

static bool refuse(const State *state, const char *what) {
    return error_input(state->error, state->path, "not a PNG file, or damaged: %s", what);
}

static bool check_pixels(State *state, const PngChunk *chunk) {
    if (state->pixels_ended) return refuse(state, "the IDAT chunks are not consecutive");
    if (state->header.color == PALETTE && !state->palette) return refuse(state, "the palette is missing");
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
        return state->palette || refuse(state, "the palette is invalid");
    }
    state->ended = png_chunk_is(chunk, "IEND");
    return state->ended || !critical || refuse(state, "an unknown critical chunk");
}

static bool check_checksum(const State *state, const PngChunk *chunk, size_t at) {
    for (int i = 0; i < 4; i++) {
        uint8_t letter = chunk->type[i] & 0xDF;
        if (letter < 'A' || letter > 'Z')
            return error_input(state->error, state->path, "not a PNG file, or damaged: no valid chunk at byte %zu", at);
    }
    uint32_t stored = png_number(chunk->data + chunk->length);
    return libdeflate_crc32(0, chunk->type, chunk->length + 4) == stored ||
           error_input(state->error, state->path,
                       "not a PNG file, or damaged: wrong checksum of the chunk %.4s at byte %zu",
                       (const char *)chunk->type, at);
}

/* RFC 1950; deflate shrinks to no less than two bits for 258 bytes (RFC 1951, 3.2.5). */
static bool check_compressed(const State *state) {
    const uint8_t *zlib = state->zlib;
    const double most = 1032, frame = 6; /* the zlib header and the checksum */
    if (!state->pixels) return refuse(state, "it has no pixels (chunk IDAT)");
    if (state->compressed < 2 || (zlib[0] & 0x0F) != 8 || zlib[0] >> 4 > 7 || (zlib[0] << 8 | zlib[1]) % 31 != 0 ||
        (zlib[1] & 0x20) != 0)
        return refuse(state, "the pixels are not a zlib stream");
    return (double)state->compressed >= frame + filtered_size(&state->header) / most ||
           refuse(state, "too few bytes for its pixels");
}

bool png_check(const uint8_t *data, size_t size, const char *path, int *width, int *height, Error *error) {
    State state = {.path = path, .error = error};
    PngChunk chunk;
    if (!png_check_start(data, size, path, error)) return false;
    size_t at = PNG_SIGNATURE, first = at, next = at;
    while (!state.ended && png_chunk_next(data, size, &next, &chunk)) {
        if (!check_checksum(&state, &chunk, at)) return false;
        bool ok = at > first ? check_chunk(&state, &chunk, at)
                             : read_header(&chunk, &state.header) || refuse(&state, "the header is invalid");
        if (!ok) return false;
        at = next;
    }
    *width = (int)state.header.width;
    *height = (int)state.header.height;
    return (state.ended || refuse(&state, "unexpected end of file")) && check_compressed(&state);
}
