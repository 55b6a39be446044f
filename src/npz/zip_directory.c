/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks a zip's directory before libzip reads it. */
#include "npz/zip_directory.h"

#include <errno.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The end record (its size, and the longest comment that may follow it), and the locator before it in a zip64. */
enum { END_SIZE = 22, COMMENT_MAX = 65535, LOCATOR_SIZE = 20, TAIL_MAX = LOCATOR_SIZE + END_SIZE + COMMENT_MAX };

/* Twice the size of 256 entries with names of 64 bytes. */
enum { DIRECTORY_MAX = 65536 };

/* Compressed data looks like an end record once in 65,000 files; more of them are an attack. */
enum { ENDS_MAX = 3 };

static uint32_t little_endian(const unsigned char *bytes) {
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static bool check_tail(const unsigned char *tail, size_t length, uint64_t size, const char *path, Error *error) {
    int ends = 0;
    for (size_t i = 0; i + END_SIZE <= length; i++) {
        if (memcmp(tail + i, "PK\5\6", 4) != 0) continue;
        uint64_t directory = little_endian(tail + i + 12), position = size - length + i;
        bool zip64 = i >= LOCATOR_SIZE && memcmp(tail + i - LOCATOR_SIZE, "PK\6\7", 4) == 0;
        /* libzip refuses a directory that begins before the file. */
        if (zip64 || (directory > DIRECTORY_MAX && directory <= position) || ++ends > ENDS_MAX)
            return error_input(error, path, "not .npz: its directory is too large");
    }
    return ends > 0 || error_input(error, path, "not .npz, or cut off");
}

bool zip_directory_check(int descriptor, uint64_t size, const char *path, Error *error) {
    size_t length = size < TAIL_MAX ? (size_t)size : TAIL_MAX, used = 0;
    unsigned char *tail = malloc(TAIL_MAX);
    if (tail == NULL) return error_memory(error, path);
    bool done = true;
    while (done && used < length) {
        ssize_t got = pread(descriptor, tail + used, length - used, (off_t)(size - length + used));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) done = error_system(error, path, "cannot read: %s", strerror(errno));
        if (got == 0) done = error_input(error, path, "not .npz, or cut off");
        if (got > 0) used += (size_t)got;
    }
    done = done && check_tail(tail, length, size, path, error);
    free(tail);
    return done;
}
