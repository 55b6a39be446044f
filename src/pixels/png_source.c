/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The bytes of a file, from its start to its end, as often as they are needed: from memory, or in pieces. Files to
   compare. */
#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "pixels/pixels_internal.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PIECE = 1 << 18 };

void png_source_of(PngSource *source, const uint8_t *data, size_t size) {
    *source = (PngSource){.file = -1, .data = data, .held = size, .size = size};
}

/* False if there is no such file, or memory is short. png_source_close() must follow. */
static bool open_source(PngSource *source, const char *path) {
    Error ignored = {0};
    *source = (PngSource){.file = -1};
    source->file = file_open(path, PNG_MAX_FILE_SIZE, &source->size, &ignored);
    source->piece = malloc(source->size < PIECE ? source->size + 1 : PIECE);
    source->parts = hash_parts_create();
    source->data = source->piece;
    source->left = source->size;
    if (source->file >= 0) trace_line("read %s, %zu bytes", path, source->size);
    return source->file >= 0 && source->piece != NULL && source->parts != NULL;
}

void png_source_close(PngSource *source) {
    if (source->file >= 0) close(source->file);
    if (source->parts != NULL) hash_parts_destroy(source->parts);
    free(source->piece);
}

bool png_source_rewind(PngSource *source) {
    source->at = 0;
    if (source->held == source->size && source->left == 0) return true; /* one piece has all */
    source->held = 0;
    source->left = source->size;
    (void)hash_parts_end(source->parts); /* of a pass that did not end */
    return lseek(source->file, 0, SEEK_SET) == 0;
}

/* The next piece. */
static bool load(PngSource *source) {
    const size_t wanted = source->left < PIECE ? source->left : PIECE;
    if (wanted == 0 || file_read_all(source->file, source->piece, wanted) != (ssize_t)wanted) return false;
    hash_parts_add(source->parts, source->piece, wanted);
    source->left -= wanted;
    source->held = wanted;
    source->at = 0;
    return true;
}

size_t png_source_peek(PngSource *source, size_t most, const uint8_t **bytes) {
    if (source->at == source->held && !load(source)) return 0;
    const size_t held = source->held - source->at;
    *bytes = source->data + source->at;
    return held < most ? held : most;
}

bool png_source_take(PngSource *source, uint8_t *to, size_t size) {
    const uint8_t *bytes;
    for (size_t count; size > 0; size -= count, source->at += count) {
        if ((count = png_source_peek(source, size, &bytes)) == 0) return false;
        if (to != NULL) memcpy(to, bytes, count), to += count;
    }
    return true;
}

bool png_source_end(PngSource *source) {
    uint8_t more;
    if (source->file < 0 || (source->hashed && source->held == source->size && source->left == 0)) return true;
    while (source->left > 0)
        if (!load(source)) return false;
    if (file_read_all(source->file, &more, 1) != 0) return false; /* it has grown */
    const uint64_t hash = hash_parts_end(source->parts);
    const bool same = !source->hashed || hash == source->hash;
    source->hash = hash;
    source->hashed = true;
    return same;
}

bool png_file_open(PngFile *file, const char *path, int64_t max_pixels, Error *error) {
    PngRows *rows = calloc(1, sizeof *rows);
    *file = (PngFile){.path = path, .max_pixels = max_pixels, .rows = rows};
    if (rows == NULL) return error_memory(error, path);
    if (!open_source(&rows->source, path) || !png_rows_open(rows, max_pixels)) return png_file_load(file, error);
    file->hash = rows->source.hash;
    file->data = rows->rest;
    file->size = rows->rest_size;
    file->bytes = rows->source.size;
    return true;
}

void png_file_close(PngFile *file) {
    if (file->rows != NULL)
        png_rows_close(file->rows);
    else
        free(file->data);
    free(file->rows);
}

bool png_file_load(PngFile *file, Error *error) {
    const bool known = file->data != NULL;
    if (known && file->rows == NULL) return true;
    png_file_close(file);
    file->rows = NULL;
    file->data = image_load_png(file->path, &file->size, error);
    if (file->data == NULL) return false;
    file->bytes = file->size;
    const uint64_t hash = hash_xxh3(file->data, file->size);
    if (known && hash != file->hash) return error_input(error, file->path, "changed while it was compared");
    file->hash = hash;
    return true;
}

bool png_files_are_same(PngFile files[2]) {
    if (files[0].hash != files[1].hash || (files[0].rows == NULL) != (files[1].rows == NULL)) return false;
    if (files[0].rows == NULL)
        return files[0].size == files[1].size && memcmp(files[0].data, files[1].data, files[0].size) == 0;
    PngSource *a = &files[0].rows->source, *b = &files[1].rows->source;
    const uint8_t *bytes, *others;
    if (a->size != b->size || !png_source_rewind(a) || !png_source_rewind(b)) return false;
    for (size_t count; (count = png_source_peek(a, a->size, &bytes)) > 0; a->at += count, b->at += count)
        if ((count = png_source_peek(b, count, &others)) == 0 || memcmp(bytes, others, count) != 0) return false;
    return png_source_end(a) && png_source_end(b);
}
