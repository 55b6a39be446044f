/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/standard_io.h"

#include "common/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int copy_of_input = -1, reserved_output = -1;

/* Readers accept no larger file. */
static const uint64_t MOST = (UINT64_C(1) << 31) + 1;

bool path_is_standard(const char *path) { return strcmp(path, "-") == 0; }

static bool copy_input(int copy, Error *error) {
    char block[1 << 16];
    for (uint64_t size = 0;;) {
        ssize_t got = read(STDIN_FILENO, block, sizeof block);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return error_system(error, "-", "cannot read standard input: %s", strerror(errno));
        if (got == 0) return true;
        size += (uint64_t)got;
        if (size > MOST) return error_input(error, "-", "larger than 2 GiB");
        if (!file_draft_write(copy, "-", block, (size_t)got, error)) return false;
    }
}

int standard_input_open(Error *error) {
    if (copy_of_input < 0) {
        int copy = file_draft("-", error);
        if (copy >= 0 && !copy_input(copy, error)) {
            close(copy);
            copy = -1;
        }
        if (copy < 0) return -1;
        copy_of_input = copy;
    }
    char path[64];
    snprintf(path, sizeof path, "/proc/self/fd/%d", copy_of_input);
    const int input = open(path, O_RDONLY | O_CLOEXEC);
    if (input < 0) error_system(error, "-", "cannot read standard input again: %s", strerror(errno));
    return input;
}

bool standard_input_is_zip(void) {
    Error ignored = {0};
    char start[2];
    const int input = standard_input_open(&ignored);
    const bool is_zip = input >= 0 && read(input, start, sizeof start) == sizeof start && memcmp(start, "PK", 2) == 0;
    if (input >= 0) close(input);
    return is_zip;
}

bool standard_output_reserve(Error *error) {
    if (reserved_output >= 0) return error_input(error, "-", "only one file can be written to standard output");
    fflush(stdout);
    reserved_output = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    return (reserved_output >= 0 && dup2(STDERR_FILENO, STDOUT_FILENO) >= 0) ||
           error_system(error, "-", "cannot write to standard output: %s", strerror(errno));
}

bool standard_output_is_reserved(void) { return reserved_output >= 0; }

int standard_output(void) { return reserved_output >= 0 ? reserved_output : STDOUT_FILENO; }
