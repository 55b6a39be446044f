/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "fuzz_archive.h"
#include "fuzz.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { ARCHIVE_MAX = 1 << 19, ARRAY_MAX = 1 << 14, ARRAYS_MAX = 64, NAME_MAX_SIZE = 255, TEXT = 11, RANK_MAX = 5 };
enum { DEFLATED = 16, OTHER = 32, FORTRAN = 64, VERSION_2 = 128 };

typedef struct Input {
    const uint8_t *at, *end;
} Input;

static unsigned take(Input *input) { return input->at < input->end ? *input->at++ : 0; }

static unsigned take_two(Input *input) {
    const unsigned low = take(input);
    return low | take(input) << 8;
}

/* As many of the bytes as there are. */
static const uint8_t *take_bytes(Input *input, size_t *length) {
    const uint8_t *bytes = input->at;
    if ((size_t)(input->end - input->at) < *length) *length = (size_t)(input->end - input->at);
    input->at += *length;
    return bytes;
}

typedef struct Member {
    unsigned kind;
    const uint8_t *name;
    size_t name_length;
    uint8_t bytes[ARRAY_MAX + 512];
    size_t size;
} Member;

/* The head of a .npy, padded to a multiple of 64 bytes. */
static void put_head(Member *member, int rank, const unsigned shape[RANK_MAX], size_t characters) {
    static const char *const types[] = {"f4", "f8", "i4", "u4", "i8", "u8", "u1", "i1", "i2", "u2", "b1", "U"};
    const unsigned type = member->kind & 15;
    const bool bytes = type == 6 || type == 7 || type == 10, version_2 = (member->kind & VERSION_2) != 0;
    const char order = bytes ? '|' : (member->kind & OTHER) != 0 && type != TEXT ? '>' : '<';
    char text[300];
    int used = snprintf(text, sizeof text, "{'descr': '%c%s", order, types[type]);
    if (type == TEXT) used += snprintf(text + used, sizeof text - (size_t)used, "%zu", characters);
    used += snprintf(text + used, sizeof text - (size_t)used, "', 'fortran_order': %s, 'shape': (",
                     (member->kind & FORTRAN) != 0 ? "True" : "False");
    for (int i = 0; i < rank; i++)
        used += snprintf(text + used, sizeof text - (size_t)used, i == 0 ? "%u" : ", %u", shape[i]);
    used += snprintf(text + used, sizeof text - (size_t)used, rank == 1 ? ",), }" : "), }");
    const size_t start = version_2 ? 12 : 10, length = (start + (size_t)used + 1 + 63) / 64 * 64 - start;
    memcpy(member->bytes, "\x93NUMPY\1\0", 8);
    memset(member->bytes + 8, ' ', start + length - 8);
    member->bytes[6] = version_2 ? 2 : 1;
    member->bytes[8] = (uint8_t)(length & 0xff), member->bytes[9] = (uint8_t)(length >> 8);
    if (version_2) member->bytes[10] = member->bytes[11] = 0;
    memcpy(member->bytes + start, text, (size_t)used);
    member->bytes[start + length - 1] = '\n';
    member->size = start + length;
}

static void put_text(Member *member, const uint8_t *data, size_t length) {
    const bool wide = (member->kind & OTHER) != 0;
    const size_t characters = wide ? length / 4 : length < ARRAY_MAX / 4 ? length : ARRAY_MAX / 4;
    put_head(member, 0, NULL, characters);
    uint8_t *out = member->bytes + member->size;
    memset(out, 0, 4 * characters);
    for (size_t i = 0; !wide && i < characters; i++) out[4 * i] = data[i];
    if (wide && characters > 0) memcpy(out, data, 4 * characters);
    member->size += 4 * characters;
}

static void put_numbers(Member *member, int rank, const unsigned shape[RANK_MAX], const uint8_t *data, size_t length) {
    static const uint8_t sizes[] = {4, 8, 4, 4, 8, 8, 1, 1, 2, 2, 1};
    size_t bytes = sizes[member->kind & 15];
    for (int i = 0; i < rank; i++) bytes = bytes > ARRAY_MAX ? bytes : bytes * shape[i];
    if (bytes > ARRAY_MAX) bytes = ARRAY_MAX;
    put_head(member, rank, shape, 0);
    uint8_t *out = member->bytes + member->size;
    for (size_t i = 0; i < bytes; i++) out[i] = length > 0 ? data[i % length] : 0;
    member->size += bytes;
}

static void take_member(Input *input, Member *member) {
    unsigned shape[RANK_MAX] = {0};
    member->kind = take(input);
    member->name_length = take(input);
    member->name = take_bytes(input, &member->name_length);
    const unsigned type = member->kind & 15;
    const int rank = type < TEXT ? (int)(take(input) % RANK_MAX) : 0;
    for (int i = 0; i < rank; i++) shape[i] = take_two(input);
    size_t length = take_two(input);
    const uint8_t *data = take_bytes(input, &length);
    if (type < TEXT) {
        put_numbers(member, rank, shape, data, length);
    } else if (type == TEXT) {
        put_text(member, data, length);
    } else {
        member->size = length < ARRAY_MAX ? length : ARRAY_MAX;
        if (length > 0) memcpy(member->bytes, data, member->size);
    }
}

typedef struct Output {
    uint8_t *bytes;
    size_t size;
} Output;

static void put(Output *out, const void *bytes, size_t size) {
    if (size > 0) memcpy(out->bytes + out->size, bytes, size);
    out->size += size;
}

static void put_number(Output *out, uint32_t value, int bytes) {
    for (int i = 0; i < bytes; i++) out->bytes[out->size++] = (uint8_t)(value >> (8 * i));
}

/* What a local header and its entry in the directory have in common. */
typedef struct Entry {
    uint32_t method, crc, packed, size, at, name_length;
    const uint8_t *name;
} Entry;

static void put_entry(Output *out, const Entry *entry, bool directory) {
    put(out, directory ? "PK\1\2\24\0\24\0" : "PK\3\4\24\0", directory ? 8 : 6);
    put_number(out, 0, 2); /* flags */
    put_number(out, entry->method, 2);
    put_number(out, 0x00210000, 4); /* 1980-01-01 */
    put_number(out, entry->crc, 4);
    put_number(out, entry->packed, 4);
    put_number(out, entry->size, 4);
    put_number(out, entry->name_length + 4, 2);
    put_number(out, 0, 2); /* no further fields */
    if (directory) put(out, "\0\0\0\0\0\0\0\0\0", 10);
    if (directory) put_number(out, entry->at, 4);
    put(out, entry->name, entry->name_length);
    put(out, ".npy", 4);
}

/* Raw deflate; 0 if it does not fit. */
static size_t deflate_member(Member *member, uint8_t *out, size_t room) {
    z_stream stream = {
        .next_in = member->bytes, .avail_in = (uInt)member->size, .next_out = out, .avail_out = (uInt)room};
    if (deflateInit2(&stream, 1, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY) != Z_OK) return 0;
    const int status = deflate(&stream, Z_FINISH);
    deflateEnd(&stream);
    return status == Z_STREAM_END ? room - stream.avail_out : 0;
}

static void put_member(Output *out, Member *member, Entry *entry) {
    static uint8_t packed[ARRAY_MAX + 4096];
    const size_t deflated = (member->kind & DEFLATED) != 0 ? deflate_member(member, packed, sizeof packed) : 0;
    *entry = (Entry){.method = deflated > 0 ? 8 : 0,
                     .crc = (uint32_t)crc32(0, member->bytes, (uInt)member->size),
                     .packed = (uint32_t)(deflated > 0 ? deflated : member->size),
                     .size = (uint32_t)member->size,
                     .at = (uint32_t)out->size,
                     .name = member->name,
                     .name_length = (uint32_t)member->name_length};
    put_entry(out, entry, false);
    put(out, deflated > 0 ? packed : member->bytes, entry->packed);
}

const char *fuzz_archive(const uint8_t *data, size_t size) {
    static Member member;
    static uint8_t out[ARCHIVE_MAX];
    Entry entries[ARRAYS_MAX];
    Input input = {data, data + size};
    Output zip = {out, 0};
    int count = 0;
    const size_t reserve = ARRAYS_MAX * (NAME_MAX_SIZE + 50) + 22 + 2 * sizeof member.bytes;
    while (input.at < input.end && count < ARRAYS_MAX && zip.size < ARCHIVE_MAX - reserve) {
        take_member(&input, &member);
        put_member(&zip, &member, &entries[count++]);
    }
    const size_t directory = zip.size;
    for (int i = 0; i < count; i++) put_entry(&zip, &entries[i], true);
    const uint32_t length = (uint32_t)(zip.size - directory);
    put(&zip, "PK\5\6\0\0\0\0", 8);
    put_number(&zip, (uint32_t)count, 2);
    put_number(&zip, (uint32_t)count, 2);
    put_number(&zip, length, 4);
    put_number(&zip, (uint32_t)directory, 4);
    put_number(&zip, 0, 2); /* no comment */
    return fuzz_file("input.npz", zip.bytes, zip.size);
}
