/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "npz/npz_stream.h"

#include "common/array.h"
#include "common/file.h"
#include "common/utf8.h"
#include "npz/npy.h"
#include "npz/npz_pack.h"
#include "npz/zip_write.h"

#include <assert.h>
#include <errno.h>
#include <libdeflate.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct Column {
    char name[ZIP_NAME_SIZE]; /* with .npy */
    NpyHead head;             /* shape[0]: rows so far */
    uint64_t row_size;        /* bytes */
    const void *data;         /* all of it, or NULL: */
    void *kept;               /* [used] the rows, until they are large */
    size_t used, capacity;
    int spill;            /* then this file; -1: none */
    NpzPack pack;         /* into it */
    uint32_t *characters; /* of a text, in UTF-32 */
} Column;

struct NpzStream {
    char *path;
    ZipWriter zip;
    int count, most;
    Column columns[]; /* [most] */
};

static void column_free(Column *column) {
    free(column->kept);
    free(column->characters);
    npz_pack_free(&column->pack);
    if (column->spill >= 0) close(column->spill);
    column->kept = column->characters = NULL;
    column->spill = -1;
}

NpzStream *npz_stream_create(const char *path, int most, Error *error) {
    NpzStream *stream = calloc(1, sizeof *stream + (size_t)most * sizeof *stream->columns);
    if (stream == NULL || (stream->path = strdup(path)) == NULL) {
        free(stream);
        error_memory(error, path);
        return NULL;
    }
    stream->most = most;
    stream->zip.path = stream->path;
    stream->zip.draft = file_draft(path, error);
    if (stream->zip.draft >= 0) return stream;
    npz_stream_destroy(stream);
    return NULL;
}

void npz_stream_destroy(NpzStream *stream) {
    if (stream == NULL) return;
    for (int i = 0; i < stream->count; i++) column_free(&stream->columns[i]);
    if (stream->zip.draft >= 0) close(stream->zip.draft);
    zip_writer_free(&stream->zip);
    free(stream->path);
    free(stream);
}

/* NumPy has no text of length 0, so an empty text is stored as one zero. */
static bool decode_text(Column *column, const NpzArray *array, const char *path, Error *error) {
    const char *text = array->data;
    size_t length, left = strlen(text);
    column->characters = calloc(left + 1, sizeof *column->characters);
    if (column->characters == NULL) return error_memory(error, path);
    int64_t count = 0;
    for (; left > 0; text += length, left -= length) {
        length = utf8_decode(text, left, &column->characters[count++]);
        if (length == 0) return error_input(error, path, "cannot store '%s': its text is not UTF-8", array->name);
    }
    column->head.characters = count > 0 ? count : 1;
    column->data = column->characters;
    return true;
}

static bool measure(NpzStream *stream, Column *column, Error *error) {
    return npy_measure(&column->head) || error_input(error, stream->path, "cannot store '%.*s': larger than 2 GiB",
                                                     (int)strlen(column->name) - 4, column->name);
}

int npz_stream_add(NpzStream *stream, const NpzArray *array, Error *error) {
    assert(stream->count < stream->most);
    assert(array->rank <= NPZ_MAX_RANK && (array->type != NPZ_TEXT || array->rank == 0));
    Column *column = &stream->columns[stream->count++];
    *column = (Column){.head = {.type = array->type, .rank = array->rank}, .data = array->data, .spill = -1};
    int length = snprintf(column->name, sizeof column->name, "%s.npy", array->name);
    assert(length > 0 && length < ZIP_NAME_SIZE);
    (void)length;
    memcpy(column->head.shape, array->shape, sizeof array->shape);
    if (array->type == NPZ_TEXT && !decode_text(column, array, stream->path, error)) return -1;
    if (array->data == NULL && array->rank > 0) {
        column->head.shape[0] = 1;
        if (!measure(stream, column, error)) return -1;
        column->row_size = column->head.data_size;
        column->head.shape[0] = array->shape[0];
    }
    return measure(stream, column, error) ? stream->count - 1 : -1;
}

/* What was kept and all that follows goes into a file. */
static bool spill(NpzStream *stream, Column *column, Error *error) {
    column->spill = file_draft(stream->path, error);
    if (column->spill < 0 || !npz_pack_begin(&column->pack, true, column->spill, stream->path, error) ||
        !npz_pack_put(&column->pack, column->kept, column->used, error))
        return false;
    free(column->kept);
    column->kept = NULL;
    return true;
}

bool npz_stream_append(NpzStream *stream, int array, const void *rows, int64_t count, Error *error) {
    Column *column = &stream->columns[array];
    assert(array >= 0 && array < stream->count && column->data == NULL);
    size_t size = (size_t)((uint64_t)count * column->row_size);
    column->head.shape[0] += count;
    if (!measure(stream, column, error)) return false;
    if (size == 0) return true;
    if (column->spill < 0 && column->used + size >= NPZ_LARGE && !spill(stream, column, error)) return false;
    if (column->spill >= 0) return npz_pack_put(&column->pack, rows, size, error);
    if (!array_reserve(&column->kept, &column->capacity, column->used + size, 1) || column->kept == NULL)
        return error_memory(error, stream->path);
    memcpy((char *)column->kept + column->used, rows, size);
    column->used += size;
    return true;
}

/* Deflates header and data together. */
static bool write_small(NpzStream *stream, Column *column, const char *head, Error *error) {
    NpzPack *pack = &column->pack;
    const void *data = column->data != NULL ? column->data : column->kept;
    return zip_begin(&stream->zip, column->name, error) &&
           npz_pack_begin(pack, false, stream->zip.draft, stream->path, error) &&
           npz_pack_put(pack, head, column->head.head_size, error) &&
           npz_pack_put(pack, data, column->head.data_size, error) && npz_pack_end(pack, error) &&
           zip_end(&stream->zip, pack->crc, pack->size, pack->packed, error);
}

static bool copy_spilled(NpzStream *stream, const Column *column, Error *error) {
    return file_copy(stream->zip.draft, column->spill) ||
           error_system(error, stream->path, "cannot write: %s", strerror(errno));
}

/* The header is a block of its own: of rows that were appended, it is known last. */
static bool write_large(NpzStream *stream, Column *column, const char *head, Error *error) {
    NpzPack whole = {0}, *pack = &whole;
    const bool spilled = column->spill >= 0;
    const size_t head_size = column->head.head_size;
    bool done = zip_begin(&stream->zip, column->name, error) &&
                npz_pack_begin(&whole, true, stream->zip.draft, stream->path, error) &&
                npz_pack_put_stored(&whole, head, head_size, error);
    if (done && spilled) {
        pack = &column->pack;
        done = npz_pack_end(pack, error) && copy_spilled(stream, column, error);
        pack->packed += whole.packed;
    } else if (done) {
        done = npz_pack_put(pack, column->data, column->head.data_size, error) && npz_pack_end(pack, error);
    }
    if (done) {
        const uint32_t head_crc = libdeflate_crc32(0, head, head_size);
        done = zip_end(&stream->zip, (uint32_t)crc32_combine(head_crc, pack->crc, (off_t)pack->size),
                       head_size + pack->size, pack->packed, error);
    }
    npz_pack_free(&whole);
    return done;
}

static bool write_column(NpzStream *stream, Column *column, Error *error) {
    char head[NPY_HEAD_MAX];
    npy_write_head(&column->head, head);
    bool done = (column->head.data_size >= NPZ_LARGE ? write_large : write_small)(stream, column, head, error);
    column_free(column);
    return done;
}

bool npz_stream_finish(NpzStream *stream, Error *error) {
    for (int i = 0; i < stream->count; i++)
        if (!write_column(stream, &stream->columns[i], error)) return false;
    return zip_finish(&stream->zip, error) && file_draft_publish(stream->zip.draft, stream->path, error);
}

bool npz_write(const char *path, const NpzArray *arrays, size_t count, Error *error) {
    assert(count > 0);
    NpzStream *stream = npz_stream_create(path, (int)count, error);
    bool done = stream != NULL;
    for (size_t i = 0; done && i < count; i++) done = npz_stream_add(stream, &arrays[i], error) >= 0;
    done = done && npz_stream_finish(stream, error);
    npz_stream_destroy(stream);
    return done;
}
