/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes .npz: the data of an array is packed, packed arrays become members of a zip, and a stream of arrays that grow
   is both. */
#include "base/base.h"
#include "base/file.h"
#include "base/npz.h"
#include "base/numbers.h"

#include <assert.h>
#include <errno.h>
#include <libdeflate.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

/* The data of one array on its way into a file: checksum and deflate. A small array is one deflate stream. A large one
   is deflated block by block, and only blocks that shrink to a quarter: deflate takes a second per 30 MB to save an
   eighth of velocities, but a tenth of that where a world rests. */

/* A block of a large array: four deflate blocks that are stored. */
enum { STORED_MAX = 65535, BLOCK_SIZE = 4 * STORED_MAX };

typedef struct Pack {
    int file;         /* a draft (base/file.h) */
    const char *path; /* for messages */
    bool begun;
    z_stream deflating;
    uint32_t crc;          /* of the data before deflate */
    uint64_t size, packed; /* bytes of the data so far, and bytes written */
    unsigned char *block;  /* [block_used] of a large array, [BLOCK_SIZE] */
    size_t block_used;
} Pack;

/* zlib's default for small arrays; level 9 made a file of positions no smaller. For large ones the fastest. */
enum { SMALL_LEVEL = 6, LARGE_LEVEL = 1 };

/* Raw deflate, as in a zip, with the largest window and memory. */
enum { RAW_WINDOW = -MAX_WBITS };

/* The start of a block, which tells whether the rest is worth deflating: if it shrinks to a quarter. */
enum { SAMPLE_SIZE = 1 << 14, SHRINKS_TO = 4 };

static bool pack_begin(Pack *pack, bool large, int file, const char *path, Error *error) {
    *pack = (Pack){.file = file, .path = path, .crc = libdeflate_crc32(0, NULL, 0)};
    if (large && (pack->block = malloc(BLOCK_SIZE)) == NULL) return error_memory(error, path);
    pack->begun = deflateInit2(&pack->deflating, large ? LARGE_LEVEL : SMALL_LEVEL, Z_DEFLATED, RAW_WINDOW,
                               MAX_MEM_LEVEL, Z_DEFAULT_STRATEGY) == Z_OK;
    return pack->begun || error_memory(error, path);
}

static bool put_bytes(Pack *pack, const void *data, size_t size, Error *error) {
    pack->packed += size;
    return file_draft_write(pack->file, pack->path, data, size, error);
}

/* Deflates as much as the output takes and returns its size. */
static size_t deflate_some(Pack *pack, int flush, unsigned char *out, size_t room) {
    pack->deflating.next_out = out;
    pack->deflating.avail_out = (unsigned)room;
    deflate(&pack->deflating, flush);
    return room - pack->deflating.avail_out;
}

static bool deflate_all(Pack *pack, const void *data, size_t size, int flush, Error *error) {
    unsigned char out[1 << 15];
    pack->deflating.next_in = (unsigned char *)data;
    pack->deflating.avail_in = (unsigned)size;
    for (size_t used = sizeof out; used == sizeof out;) {
        used = deflate_some(pack, flush, out, sizeof out);
        if (!put_bytes(pack, out, used, error)) return false;
    }
    return true;
}

/* Puts bytes that are not counted in crc and size, as a deflate block that is stored: at most STORED_MAX. */
static bool pack_put_stored(Pack *pack, const void *data, size_t size, Error *error) {
    const unsigned char head[] = {0, (unsigned char)(size & 0xff), (unsigned char)(size >> 8),
                                  (unsigned char)(~size & 0xff), (unsigned char)(~size >> 8 & 0xff)};
    return put_bytes(pack, head, sizeof head, error) && put_bytes(pack, data, size, error);
}

/* A full flush ends the sample at a whole byte, and nothing after it refers back: it may be dropped. */
static bool put_block(Pack *pack, Error *error) {
    unsigned char out[2 * SAMPLE_SIZE];
    const size_t size = pack->block_used, sample = size_min(size, SAMPLE_SIZE);
    pack->block_used = 0;
    pack->deflating.next_in = pack->block;
    pack->deflating.avail_in = (unsigned)sample;
    const size_t used = deflate_some(pack, Z_FULL_FLUSH, out, sizeof out);
    if (used <= sample / SHRINKS_TO)
        return put_bytes(pack, out, used, error) &&
               (size == sample || deflate_all(pack, pack->block + sample, size - sample, Z_FULL_FLUSH, error));
    bool done = true;
    for (size_t at = 0; done && at < size; at += STORED_MAX)
        done = pack_put_stored(pack, pack->block + at, size_min(size - at, STORED_MAX), error);
    return done;
}

static bool pack_put(Pack *pack, const void *data, size_t size, Error *error) {
    if (size == 0) return true;
    pack->crc = libdeflate_crc32(pack->crc, data, size); /* ten times as fast as zlib's */
    pack->size += size;
    if (pack->block == NULL) return deflate_all(pack, data, size, Z_NO_FLUSH, error);
    for (size_t at = 0, piece; at < size; at += piece) {
        piece = size_min(size - at, BLOCK_SIZE - pack->block_used);
        memcpy(pack->block + pack->block_used, (const char *)data + at, piece);
        pack->block_used += piece;
        if (pack->block_used == BLOCK_SIZE && !put_block(pack, error)) return false;
    }
    return true;
}

static bool pack_end(Pack *pack, Error *error) {
    static const unsigned char last[] = {3, 0}; /* an empty block that says that it is the last */
    if (pack->block == NULL) return deflate_all(pack, NULL, 0, Z_FINISH, error);
    return (pack->block_used == 0 || put_block(pack, error)) && put_bytes(pack, last, sizeof last, error);
}

/* Frees what a pack that was begun, or is all zero, holds. */
static void pack_free(Pack *pack) {
    if (pack->begun) deflateEnd(&pack->deflating);
    free(pack->block);
    pack->block = NULL;
    pack->begun = false;
}

/* Writes a zip piece by piece into a draft. libzip takes a member's data only when it closes the archive, in one
   thread; and which bytes it writes depends on its version. The same members give the same bytes here: time stamps are
   fixed. The format: PKWARE, APPNOTE.TXT, sections 4.3.7 to 4.3.16. */

enum { NAME_SIZE = 72 };

typedef struct Member {
    char name[NAME_SIZE]; /* with .npy */
    uint32_t crc;
    uint32_t offset;       /* in the file */
    uint64_t packed, size; /* bytes in the file, bytes of the data */
} Member;

typedef struct Zip {
    int draft;        /* base/file.h */
    const char *path; /* for messages */
    uint64_t used;    /* bytes written */
} Zip;

/* Noon of 1980-01-01. */
enum { DOS_TIME = 12 << 11, DOS_DATE = 1 << 5 | 1 };

/* What libzip wrote: made by version 6.3 for Unix, a regular file that all may read and write. */
enum { MADE_BY = 3 << 8 | 63, NEEDS_DEFLATE = 20 };
static const uint32_t ATTRIBUTES = 0100666U << 16;

enum { LOCAL_SIZE = 30, ENTRY_SIZE = 46, END_SIZE = 22, METHOD_DEFLATE = 8 };

typedef struct Record {
    unsigned char bytes[ENTRY_SIZE];
    size_t used;
} Record;

static void put16(Record *record, uint32_t value) {
    record->bytes[record->used++] = (unsigned char)(value & 0xff);
    record->bytes[record->used++] = (unsigned char)(value >> 8 & 0xff);
}

static void put32(Record *record, uint32_t value) {
    put16(record, value & 0xffff);
    put16(record, value >> 16);
}

/* What a member's local header and its entry in the directory share. */
static void put_common(Record *record, const Member *member) {
    put16(record, NEEDS_DEFLATE);
    put16(record, 0); /* flags */
    put16(record, METHOD_DEFLATE);
    put16(record, DOS_TIME);
    put16(record, DOS_DATE);
    put32(record, member->crc);
    put32(record, (uint32_t)member->packed);
    put32(record, (uint32_t)member->size);
    put16(record, (uint32_t)strlen(member->name));
    put16(record, 0); /* extra field */
}

static Record local_header(const Member *member) {
    Record record = {.used = 0};
    put32(&record, 0x04034b50);
    put_common(&record, member);
    assert(record.used == LOCAL_SIZE);
    return record;
}

static Record directory_entry(const Member *member) {
    Record record = {.used = 0};
    put32(&record, 0x02014b50);
    put16(&record, MADE_BY);
    put_common(&record, member);
    put16(&record, 0); /* comment */
    put16(&record, 0); /* disk */
    put16(&record, 0); /* internal attributes */
    put32(&record, ATTRIBUTES);
    put32(&record, member->offset);
    assert(record.used == ENTRY_SIZE);
    return record;
}

static bool add_size(Zip *zip, uint64_t size, Error *error) {
    if (size > NPZ_MAX_BYTES || zip->used + size > NPZ_MAX_BYTES) /* readers accept no larger file */
        return error_input(error, zip->path, "cannot write: its arrays are larger than 2 GiB together");
    zip->used += size;
    return true;
}

static bool put(Zip *zip, const void *data, size_t size, Error *error) {
    return add_size(zip, size, error) && file_draft_write(zip->draft, zip->path, data, size, error);
}

/* Begins a member, which is deflated. Its bytes, as they shall be in the file, are then written to the draft. */
static bool zip_begin(Zip *zip, Member *member, Error *error) {
    member->offset = (uint32_t)zip->used;
    Record header = local_header(member);
    return put(zip, header.bytes, header.used, error) && put(zip, member->name, strlen(member->name), error);
}

/* Ends it: checksum and size of its data before compression, and number of bytes written. */
static bool zip_end(Zip *zip, Member *member, uint32_t crc, uint64_t size, uint64_t packed, Error *error) {
    if (!add_size(zip, packed, error)) return false;
    member->packed = packed;
    member->crc = crc;
    member->size = size;
    const Record header = local_header(member);
    for (size_t done = 0; done < header.used;) {
        const ssize_t written =
            pwrite(zip->draft, header.bytes + done, header.used - done, (off_t)(member->offset + done));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return error_system(error, zip->path, "cannot write: %s", strerror(errno));
        done += (size_t)written;
    }
    return true;
}

/* After the last member: the end of the directory that began at `start`. */
static bool zip_finish(Zip *zip, int count, uint64_t start, Error *error) {
    Record end = {.used = 0};
    put32(&end, 0x06054b50);
    put16(&end, 0); /* this disk */
    put16(&end, 0); /* disk of the directory */
    put16(&end, (uint32_t)count);
    put16(&end, (uint32_t)count);
    put32(&end, (uint32_t)(zip->used - start));
    put32(&end, (uint32_t)start);
    put16(&end, 0); /* comment */
    assert(end.used == END_SIZE);
    return put(zip, end.bytes, end.used, error);
}

/* An array of the stream. */
typedef struct Column {
    Member member;
    NpyHead head;      /* shape[0]: rows so far */
    uint64_t row_size; /* bytes */
    const void *data;  /* all of it, or NULL: */
    void *kept;        /* [used] the rows, until they are large */
    size_t used, capacity;
    int spill;            /* then this file; -1: none */
    Pack pack;            /* into it */
    uint32_t *characters; /* of a text, in UTF-32 */
} Column;

struct NpzStream {
    Zip zip; /* its path is behind the columns */
    int count, most;
    Column columns[]; /* [most] */
};

static void column_free(Column *column) {
    free(column->kept);
    free(column->characters);
    pack_free(&column->pack);
    if (column->spill >= 0) close(column->spill);
    column->kept = column->characters = NULL;
    column->spill = -1;
}

NpzStream *npz_stream_create(const char *path, int most, Error *error) {
    NpzStream *stream = calloc(1, sizeof *stream + (size_t)most * sizeof *stream->columns + strlen(path) + 1);
    if (stream == NULL) return error_memory(error, path), NULL;
    stream->most = most;
    stream->zip.path = strcpy((char *)&stream->columns[most], path);
    stream->zip.draft = file_draft(path, error);
    if (stream->zip.draft >= 0) return stream;
    npz_stream_destroy(stream);
    return NULL;
}

void npz_stream_destroy(NpzStream *stream) {
    if (stream == NULL) return;
    for (int i = 0; i < stream->count; i++) column_free(&stream->columns[i]);
    if (stream->zip.draft >= 0) close(stream->zip.draft);
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
    return npy_measure(&column->head) || error_input(error, stream->zip.path, "cannot store '%.*s': larger than 2 GiB",
                                                     (int)strlen(column->member.name) - 4, column->member.name);
}

int npz_stream_add(NpzStream *stream, const NpzArray *array, Error *error) {
    assert(stream->count < stream->most);
    assert(array->rank <= NPZ_MAX_RANK && (array->type != NPZ_TEXT || array->rank == 0));
    Column *column = &stream->columns[stream->count++];
    *column = (Column){.head = {.type = array->type, .rank = array->rank}, .data = array->data, .spill = -1};
    int length = snprintf(column->member.name, sizeof column->member.name, "%s.npy", array->name);
    assert(length > 0 && length < NAME_SIZE);
    (void)length;
    memcpy(column->head.shape, array->shape, sizeof array->shape);
    if (array->type == NPZ_TEXT && !decode_text(column, array, stream->zip.path, error)) return -1;
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
    column->spill = file_draft(stream->zip.path, error);
    if (column->spill < 0 || !pack_begin(&column->pack, true, column->spill, stream->zip.path, error) ||
        !pack_put(&column->pack, column->kept, column->used, error))
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
    if (column->spill >= 0) return pack_put(&column->pack, rows, size, error);
    if (!array_reserve(&column->kept, &column->capacity, column->used + size, 1) || column->kept == NULL)
        return error_memory(error, stream->zip.path);
    memcpy((char *)column->kept + column->used, rows, size);
    column->used += size;
    return true;
}

/* Deflates header and data together. */
static bool write_small(NpzStream *stream, Column *column, const char *head, Error *error) {
    Pack *pack = &column->pack;
    const void *data = column->data != NULL ? column->data : column->kept;
    return zip_begin(&stream->zip, &column->member, error) &&
           pack_begin(pack, false, stream->zip.draft, stream->zip.path, error) &&
           pack_put(pack, head, column->head.head_size, error) && pack_put(pack, data, column->head.data_size, error) &&
           pack_end(pack, error) && zip_end(&stream->zip, &column->member, pack->crc, pack->size, pack->packed, error);
}

/* The header is a block of its own: of rows that were appended, it is known last. */
static bool write_large(NpzStream *stream, Column *column, const char *head, Error *error) {
    Pack whole = {0}, *pack = &whole;
    const bool spilled = column->spill >= 0;
    const size_t head_size = column->head.head_size;
    bool done = zip_begin(&stream->zip, &column->member, error) &&
                pack_begin(&whole, true, stream->zip.draft, stream->zip.path, error) &&
                pack_put_stored(&whole, head, head_size, error);
    if (done && spilled) {
        pack = &column->pack;
        done = pack_end(pack, error) && (file_copy(stream->zip.draft, column->spill) ||
                                         error_system(error, stream->zip.path, "cannot write: %s", strerror(errno)));
        pack->packed += whole.packed;
    } else if (done) {
        done = pack_put(pack, column->data, column->head.data_size, error) && pack_end(pack, error);
    }
    if (done) {
        const uint32_t head_crc = libdeflate_crc32(0, head, head_size);
        done = zip_end(&stream->zip, &column->member, (uint32_t)crc32_combine(head_crc, pack->crc, (off_t)pack->size),
                       head_size + pack->size, pack->packed, error);
    }
    pack_free(&whole);
    return done;
}

bool npz_stream_finish(NpzStream *stream, Error *error) {
    Zip *zip = &stream->zip;
    for (int i = 0; i < stream->count; i++) {
        Column *column = &stream->columns[i];
        char head[NPY_HEAD_MAX];
        npy_write_head(&column->head, head);
        const bool done =
            (column->head.data_size >= NPZ_LARGE ? write_large : write_small)(stream, column, head, error);
        column_free(column);
        if (!done) return false;
    }
    const uint64_t start = zip->used;
    for (int i = 0; i < stream->count; i++) { /* the entry of each in the directory */
        const Member *member = &stream->columns[i].member;
        const Record entry = directory_entry(member);
        if (!put(zip, entry.bytes, entry.used, error) || !put(zip, member->name, strlen(member->name), error))
            return false;
    }
    return zip_finish(zip, stream->count, start, error) && file_draft_publish(zip->draft, zip->path, error);
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
