/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The format: PKWARE, APPNOTE.TXT, sections 4.3.7 to 4.3.16. */
#include "npz/zip_write.h"

#include "common/array.h"
#include "common/file.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Noon of 1980-01-01. */
enum { DOS_TIME = 12 << 11, DOS_DATE = 1 << 5 | 1 };

/* What libzip wrote: made by version 6.3 for Unix, a regular file that all may read and write. */
enum { MADE_BY = 3 << 8 | 63, NEEDS_DEFLATE = 20 };
static const uint32_t ATTRIBUTES = 0100666U << 16;

enum { LOCAL_SIZE = 30, ENTRY_SIZE = 46, END_SIZE = 22, METHOD_DEFLATE = 8 };

/* Readers accept no larger file. */
static const uint64_t MOST = UINT64_C(1) << 31;

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
static void put_common(Record *record, const ZipMember *member) {
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

static Record local_header(const ZipMember *member) {
    Record record = {.used = 0};
    put32(&record, 0x04034b50);
    put_common(&record, member);
    assert(record.used == LOCAL_SIZE);
    return record;
}

static Record directory_entry(const ZipMember *member) {
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

static bool add_size(ZipWriter *zip, uint64_t size, Error *error) {
    if (size > MOST || zip->used + size > MOST)
        return error_input(error, zip->path, "cannot write: its arrays are larger than 2 GiB together");
    zip->used += size;
    return true;
}

static bool put(ZipWriter *zip, const void *data, size_t size, Error *error) {
    return add_size(zip, size, error) && file_draft_write(zip->draft, zip->path, data, size, error);
}

void zip_writer_free(ZipWriter *zip) {
    free(zip->members);
    zip->members = NULL;
}

bool zip_begin(ZipWriter *zip, const char *name, Error *error) {
    void *members = zip->members;
    if (!array_reserve(&members, &zip->capacity, zip->count + 1, sizeof *zip->members))
        return error_memory(error, zip->path);
    zip->members = members;
    ZipMember *member = &zip->members[zip->count++];
    *member = (ZipMember){.offset = (uint32_t)zip->used};
    int length = snprintf(member->name, sizeof member->name, "%s", name);
    assert(length > 0 && length < ZIP_NAME_SIZE);
    (void)length;
    Record header = local_header(member);
    return put(zip, header.bytes, header.used, error) && put(zip, member->name, strlen(member->name), error);
}

static bool overwrite(int file, const unsigned char *data, size_t size, off_t at) {
    while (size > 0) {
        ssize_t written = pwrite(file, data, size, at);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return false;
        data += written;
        at += written;
        size -= (size_t)written;
    }
    return true;
}

bool zip_end(ZipWriter *zip, uint32_t crc, uint64_t size, uint64_t packed, Error *error) {
    ZipMember *member = &zip->members[zip->count - 1];
    if (!add_size(zip, packed, error)) return false;
    member->packed = packed;
    member->crc = crc;
    member->size = size;
    Record header = local_header(member);
    return overwrite(zip->draft, header.bytes, header.used, member->offset) ||
           error_system(error, zip->path, "cannot write: %s", strerror(errno));
}

bool zip_finish(ZipWriter *zip, Error *error) {
    uint64_t start = zip->used;
    for (size_t i = 0; i < zip->count; i++) {
        Record entry = directory_entry(&zip->members[i]);
        if (!put(zip, entry.bytes, entry.used, error) ||
            !put(zip, zip->members[i].name, strlen(zip->members[i].name), error))
            return false;
    }
    Record end = {.used = 0};
    put32(&end, 0x06054b50);
    put16(&end, 0); /* this disk */
    put16(&end, 0); /* disk of the directory */
    put16(&end, (uint32_t)zip->count);
    put16(&end, (uint32_t)zip->count);
    put32(&end, (uint32_t)(zip->used - start));
    put32(&end, (uint32_t)start);
    put16(&end, 0); /* comment */
    assert(end.used == END_SIZE);
    return put(zip, end.bytes, end.used, error);
}
