/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "fuzz_archive.h"
#include "fuzz.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zip.h>

enum { ARRAY_MAX = 1 << 14, ARRAYS_MAX = 64, NAME_MAX_SIZE = 255, TEXT = 11, RANK_MAX = 5 };
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

const char *fuzz_archive(const uint8_t *data, size_t size) {
    static Member members[ARRAYS_MAX]; /* libzip reads them when it closes the archive */
    const char *path = fuzz_file("input.npz", "", 0);
    Input input = {data, data + size};
    zip_t *zip = zip_open(path, ZIP_CREATE | ZIP_TRUNCATE, NULL);
    if (zip == NULL) fuzz_fail("%s: no archive", path);
    for (int i = 0; i < ARRAYS_MAX && input.at < input.end; i++) {
        Member *member = &members[i];
        char name[NAME_MAX_SIZE + sizeof ".npy"];
        take_member(&input, member);
        snprintf(name, sizeof name, "%.*s.npy", (int)member->name_length, (const char *)member->name);
        zip_source_t *source = zip_source_buffer(zip, member->bytes, member->size, 0);
        const zip_int64_t index = zip_file_add(zip, name, source, ZIP_FL_ENC_RAW);
        const zip_int32_t how = (member->kind & DEFLATED) != 0 ? ZIP_CM_DEFLATE : ZIP_CM_STORE;
        if (index < 0)
            zip_source_free(source); /* the name is there already; the target zip has such archives */
        else
            zip_set_file_compression(zip, (zip_uint64_t)index, how, 1);
    }
    if (zip_close(zip) != 0) fuzz_fail("%s: cannot write", path);
    return path;
}
