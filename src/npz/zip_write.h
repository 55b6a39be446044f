/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes a zip piece by piece into a draft. libzip takes a member's data only when it closes the archive, in one thread;
   and which bytes it writes depends on its version. The same members give the same bytes here: time stamps are fixed.
   Only npz_stream.c includes this. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

enum { ZIP_NAME_SIZE = 72 };

typedef struct ZipMember {
    char name[ZIP_NAME_SIZE];
    uint32_t crc;
    uint32_t offset;       /* in the file */
    uint64_t packed, size; /* bytes in the file, bytes of the data */
} ZipMember;

typedef struct ZipWriter {
    int draft;          /* common/file.h */
    const char *path;   /* for messages */
    uint64_t used;      /* bytes written */
    ZipMember *members; /* [count] */
    size_t count, capacity;
} ZipWriter;

void zip_writer_free(ZipWriter *zip);

/* Begins a member, which is deflated. Its bytes, as they shall be in the file, are then written to the draft. */
bool zip_begin(ZipWriter *zip, const char *name, Error *error);

/* Ends it: checksum and size of its data before compression, and number of bytes written. */
bool zip_end(ZipWriter *zip, uint32_t crc, uint64_t size, uint64_t packed, Error *error);

/* Writes the directory, after the last member. */
bool zip_finish(ZipWriter *zip, Error *error);
